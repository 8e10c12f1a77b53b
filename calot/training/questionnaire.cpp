#include "calot/training/questionnaire.h"

namespace calot::training {

const std::array<Question, kQuestions>& questions() {
    static const std::array<Question, kQuestions> all{{
        {"anatomy", "Anatomy", "Calot's triangle looks as it does in the operating theatre."},
        {"tissue_look", "Look of tissue", "Surface, colour and wetness of fat, duct and artery are convincing."},
        {"deformation", "Deformation", "Tissue gives way and springs back under the instrument as real tissue does."},
        {"cutting", "Cutting", "Tissue parts under the hook as it does in electrosurgery."},
        {"burning", "Traces of heat", "Blanching, browning and charring appear where and when I expect them."},
        {"smoke", "Smoke", "Smoke and steam rise, hide the view and clear as they do in reality."},
        {"force", "Force", "The force that I feel, or see displayed, matches what the tissue does."},
        {"control", "Control of the instrument", "The hook goes where I mean it to go, without delay."},
        {"view", "View and depth", "I can judge depth and distance from the picture."},
        {"danger", "Danger", "What endangers duct and artery here endangers them in reality, too."},
        {"feedback", "Score and debrief", "Score and debrief told me something that I would not have noticed."},
        {"training", "Usefulness for training", "Practising with it would make me better at the real procedure."},
    }};
    return all;
}

const std::array<const char*, 5>& scale() {
    static const std::array<const char*, 5> words{"not at all", "hardly", "partly", "mostly", "fully"};
    return words;
}

}  // namespace calot::training

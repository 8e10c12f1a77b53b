#include "calot/training/events.h"

#include <algorithm>

#include <fmt/format.h>

namespace calot::training {

namespace {

std::string words(std::string structure) {
    std::replace(structure.begin(), structure.end(), '_', ' ');
    return structure;
}

}  // namespace

std::string describe(const Event& event) {
    const std::string structure = words(event.structure);
    switch (event.kind) {
        case EventKind::activation_start:
            return "pedal down";
        case EventKind::activation_end:
            return fmt::format("pedal up, {:.3g} J delivered", event.value);
        case EventKind::touch:
            return fmt::format("the hook touches the {}{}", structure, event.value > 0.0 ? ", energised" : "");
        case EventKind::organ_touch:
            return fmt::format("energised metal touches the {}", structure);
        case EventKind::exposed:
            return fmt::format("{} exposed to {:.0f} %", structure, event.value * 100.0);
        case EventKind::injured:
            return fmt::format("the {} is injured by heat", structure);
        case EventKind::burnt:
            return fmt::format("the {} is burnt open", structure);
        case EventKind::target:
            return fmt::format("target {:.0f} touched", event.value);
        case EventKind::completed:
            return "goal reached";
        case EventKind::limit:
            return fmt::format("limit broken: {}", event.structure);
    }
    return "";
}

const char* name_of(EventKind kind) {
    switch (kind) {
        case EventKind::activation_start:
            return "activation_start";
        case EventKind::activation_end:
            return "activation_end";
        case EventKind::touch:
            return "touch";
        case EventKind::organ_touch:
            return "organ_touch";
        case EventKind::exposed:
            return "exposed";
        case EventKind::injured:
            return "injured";
        case EventKind::burnt:
            return "burnt";
        case EventKind::target:
            return "target";
        case EventKind::completed:
            return "completed";
        case EventKind::limit:
            return "limit";
    }
    return "";
}

}  // namespace calot::training

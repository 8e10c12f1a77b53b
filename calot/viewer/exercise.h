#pragma once
// What the start screen offers. The list is data: whoever knows exercises fills it (free_practice() is always there).

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "calot/viewer/observer.h"

namespace calot::viewer {

/// A line of figures beside the picture. `name` and `value` are for people, already translated.
struct HudLine {
    std::string name;
    std::string value;
    enum class Mood { plain, good, bad } mood = Mood::plain;
    std::string detail{};  ///< beside the value
    double share = -1.0;   ///< of the way to a goal, 0 to 1; below 0: there is none
};

/// Something worth coming back to.
struct Mark {
    enum class Kind { harm, progress, touch } kind = Kind::touch;
    double time_s = 0.0;
    std::string text;     ///< a key of the language file, or plain text; "{0}" stands for ...
    std::string subject;  ///< ... this, the same
};

class Attempt;

/// A run that was stored: it can be looked at again, and gone on from.
struct Past {
    std::string recording;  ///< path; empty: there is none
    std::vector<Mark> marks;
    /// Finds them where they are not known yet; may be empty. Called in a thread, may take seconds.
    std::function<std::vector<Mark>()> find_marks;
    /// A run at this tick as it was, to the last bit, and the attempt that goes on from it. Called in a thread; throws
    /// InputError.
    std::function<std::pair<std::unique_ptr<simulation::Simulation>, std::shared_ptr<Attempt>>(
        std::int64_t tick, std::shared_ptr<const simulation::Setup>)>
        resume;
};

/// Statements that the trainee may agree with, from 1 to the number of words of the scale.
struct Questionnaire {
    std::vector<std::string> statements;
    std::vector<std::string> scale;
    /// An answer or none for each statement. Throws std::exception.
    std::function<void(const std::vector<std::optional<int>>& answers, const std::string& remark)> store;
};

/// What the trainee is told at the end.
struct Debrief {
    std::string title;
    HudLine outcome;  ///< what it comes to; no value: nothing was counted
    std::vector<HudLine> lines;
    std::string report;  ///< path of a page to open, may be empty
    Past past;
    Questionnaire questionnaire;  ///< no statements: none
};

/// One attempt at an exercise. after_tick runs in the physics thread, everything else in the window's.
class Attempt : public Observer {
  public:
    virtual std::vector<HudLine> hud() { return {}; }
    virtual bool done() const { return false; }  ///< the task is fulfilled or failed: the session ends itself
    virtual Debrief debrief() { return {}; }     ///< after end()
};

/// A patient to choose: a seed with what makes it easy or hard.
struct Patient {
    std::uint64_t seed = 1;
    int difficulty = 1;  ///< 1 easy, 2 medium, 3 hard
    std::string about;   ///< a key of the language file
    std::vector<std::string> assignments;
};

struct Exercise {
    std::string id;                        ///< "free", "calots_triangle", "touch", ...
    std::string name;                      ///< a key of the language file, or plain text
    std::string about;                     ///< the same; one or two sentences
    std::string scene;                     ///< file name under scenes/, empty: the scene of the command line
    std::vector<std::string> assignments;  ///< scene values that it changes
    bool patients = true;                  ///< lets the trainee choose a patient
    std::vector<Patient> own_patients;     ///< to choose from; empty: patients()
    std::vector<std::string> hints;        ///< keys of the language file, or plain text
    /// Makes the attempt; may be empty (nothing is watched).
    std::function<std::shared_ptr<Attempt>(const simulation::Setup&)> attempt;
};

Exercise free_practice();
const std::vector<Patient>& patients();
/// Those that an exercise offers: its own, or all.
const std::vector<Patient>& patients_of(const Exercise& exercise);

/// A session that was cut off, found at the start.
struct CutOff {
    std::string exercise;  ///< id
    std::string title;     ///< of the exercise, a key or plain text
    std::string started_utc;
    Past past;
    std::function<void()> close;  ///< enters what it was worth
};

}  // namespace calot::viewer

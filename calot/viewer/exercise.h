#pragma once
// What the start screen offers. The list is data: whoever knows exercises fills it (free_practice() is always there).

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "calot/viewer/observer.h"

namespace calot::viewer {

/// A line of figures beside the picture. `name` and `value` are for people, already translated.
struct HudLine {
    std::string name;
    std::string value;
    enum class Mood { plain, good, bad } mood = Mood::plain;
};

/// What the trainee is told at the end.
struct Debrief {
    std::string title;
    std::vector<HudLine> lines;
    std::string report;  ///< path of a page to open, may be empty
};

/// One attempt at an exercise. after_tick runs in the physics thread, everything else in the window's.
class Attempt : public Observer {
  public:
    virtual std::vector<HudLine> hud() { return {}; }
    virtual bool done() const { return false; }  ///< the task is fulfilled or failed: the session ends itself
    virtual Debrief debrief() { return {}; }     ///< after end()
};

struct Exercise {
    std::string id;                        ///< "free", "calots_triangle", "touch", ...
    std::string name;                      ///< a key of the language file, or plain text
    std::string about;                     ///< the same; one or two sentences
    std::string scene;                     ///< file name under scenes/, empty: the scene of the command line
    std::vector<std::string> assignments;  ///< scene values that it changes
    bool patients = true;                  ///< lets the trainee choose a patient
    /// Makes the attempt; may be empty (nothing is watched).
    std::function<std::shared_ptr<Attempt>(const simulation::Setup&)> attempt;
};

/// A patient to choose: a seed with what makes it easy or hard.
struct Patient {
    std::uint64_t seed = 1;
    int difficulty = 1;  ///< 1 easy, 2 medium, 3 hard
    std::string about;   ///< a key of the language file
    std::vector<std::string> assignments;
};

Exercise free_practice();
const std::vector<Patient>& patients();

}  // namespace calot::viewer

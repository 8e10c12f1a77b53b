#pragma once
// What is to be done, on whom: exercises on the left, the chosen one and its patients on the right.

#include <vector>

#include "calot/viewer/exercise.h"
#include "calot/viewer/language.h"
#include "calot/window/gui.h"

namespace calot::window {

/// What is selected; kept from one visit of the screen to the next.
struct StartSelection {
    int exercise = 0;
    int patient = 0;  ///< of viewer::patients_of(exercise); -1: by number
    int seed = 1;
};

struct StartChoice {
    bool start = false, settings = false, quit = false;
};
/// `patients`: offer them.
StartChoice draw_start(const Gui& gui, const viewer::Language& text, const std::vector<viewer::Exercise>& exercises,
                       bool patients, StartSelection& selection);

enum class CutOffChoice { none, look, close };
/// A session that was cut off is offered.
CutOffChoice draw_cut_off(const Gui& gui, const viewer::Language& text, const viewer::CutOff& cut_off);

}  // namespace calot::window

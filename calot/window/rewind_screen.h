#pragma once
// A run that is over, on a timeline: to be looked at again, from any side, and to be gone on from.

#include <vector>

#include "calot/viewer/exercise.h"
#include "calot/viewer/language.h"
#include "calot/viewer/replay.h"
#include "calot/window/gui.h"

namespace calot::window {

struct RewindState {
    double at_s = 0.0;  ///< the moment that is looked at
    bool playing = false;
};

struct RewindContent {
    double duration_s = 0.0;
    double shown_s = 0.0;  ///< of the picture
    const std::vector<viewer::PedalSpan>& pedal;
    const std::vector<viewer::Mark>& marks;
    bool older = false;  ///< there are no checkpoints to go back to
};

enum class RewindChoice { none, take_over, back };
/// Moves state.at_s; whoever calls it sees to the picture and to the playing.
RewindChoice draw_rewind(const Gui& gui, const viewer::Language& text, const RewindContent& content,
                         RewindState& state);

/// Pixels at the lower edge that the timeline takes.
float rewind_height(const Gui& gui);

/// What is shown while the run is being opened.
void draw_opening(const Gui& gui, const viewer::Language& text, double waited_s);

/// How long before a mark its cause lies: where a press on it leads to.
inline constexpr double kBeforeMark_s = 3.0;
/// "the cystic artery is burnt open"
std::string describe(const viewer::Language& text, const viewer::Mark& mark);

}  // namespace calot::window

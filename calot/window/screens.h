#pragma once
// Everything that is not the operation itself: start, loading, pause, settings, debrief, trouble. Each draws itself and
// says what was chosen.

#include <optional>
#include <string>
#include <vector>

#include "calot/viewer/exercise.h"
#include "calot/viewer/language.h"
#include "calot/viewer/loader.h"
#include "calot/window/gui.h"
#include "calot/window/settings.h"

namespace calot::window {

struct StartChoice {
    int exercise = -1;  ///< index, chosen
    bool settings = false, quit = false;
};
/// `patient`: index into viewer::patients(), may be changed; -1: the seed in `seed`. `patients`: offer them.
StartChoice draw_start(const Gui& gui, const viewer::Language& text, const std::vector<viewer::Exercise>& exercises,
                       int& patient, int& seed, bool patients);

void draw_loading(const Gui& gui, const viewer::Language& text, viewer::Loader::Step step, double waited_s);

enum class PauseChoice { none, resume, reset, settings, help, finish, quit };
PauseChoice draw_pause(const Gui& gui, const viewer::Language& text);

/// True when it is to be closed. `changed` tells that something was changed.
bool draw_settings(const Gui& gui, const viewer::Language& text, const std::vector<std::string>& languages,
                   const std::string& tier_now, Settings& settings, bool& changed);

enum class DebriefChoice { none, again, menu, report };
DebriefChoice draw_debrief(const Gui& gui, const viewer::Language& text, const viewer::Debrief& debrief);

/// True when it is to be closed.
bool draw_trouble(const Gui& gui, const viewer::Language& text, const std::string& message);

}  // namespace calot::window

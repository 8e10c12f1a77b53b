#pragma once
// Screens without much to them: loading, pause, settings, debrief, trouble. Each draws itself and says what was chosen.

#include <optional>
#include <string>
#include <vector>

#include "calot/viewer/exercise.h"
#include "calot/viewer/language.h"
#include "calot/viewer/loader.h"
#include "calot/window/gui.h"
#include "calot/window/settings.h"

namespace calot::window {

/// `title`: a key of the language file.
void draw_loading(const Gui& gui, const viewer::Language& text, const char* title, viewer::Loader::Step step,
                  double waited_s);

enum class PauseChoice { none, resume, rewind, reset, settings, help, finish, quit };
/// `rewind`: there will be something to rewind.
PauseChoice draw_pause(const Gui& gui, const viewer::Language& text, bool rewind);

/// True when it is to be closed. `changed` tells that something was changed.
bool draw_settings(const Gui& gui, const viewer::Language& text, const std::vector<std::string>& languages,
                   const std::string& tier_now, Settings& settings, bool& changed);

enum class DebriefChoice { none, rewind, questions, again, menu, report };
DebriefChoice draw_debrief(const Gui& gui, const viewer::Language& text, const viewer::Debrief& debrief,
                           bool report_ready);

/// True when it is to be closed.
bool draw_trouble(const Gui& gui, const viewer::Language& text, const std::string& message);

}  // namespace calot::window

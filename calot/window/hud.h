#pragma once
// The panels beside the picture while the trainee works.

#include <string>
#include <vector>

#include "calot/viewer/exercise.h"
#include "calot/viewer/language.h"
#include "calot/viewer/snapshot.h"
#include "calot/window/gui.h"
#include "calot/window/settings.h"

namespace calot::window {

/// Of the haptic device that holds the hook.
struct HapticsFigures {
    std::string device;   ///< empty: there is none
    std::string trouble;  ///< why it does not push; empty: it does
    double steps_per_s = 0.0;
    double force_N = 0.0;  ///< on the hand
};

/// What the window itself measured.
struct PictureFigures {
    double pictures_per_s = 0.0;
    double draw_ms = 0.0;
    double latency_ms = 0.0;  ///< from reading the devices to the picture that shows it
    std::string tier;
    std::string scheduling;
    HapticsFigures haptics;
};

struct HudContent {
    const viewer::Figures& snapshot;
    const PictureFigures& figures;
    const Settings& settings;
    const std::string& exercise;
    const std::vector<viewer::HudLine>& lines;
    bool left_hand = false;
    bool suction = false, irrigation = false;
    double countdown_s = 0.0;  ///< until hands move again
};

/// "1:07"
std::string clock_text(double time_s);

void draw_hud(const Gui& gui, const viewer::Language& text, const HudContent& content);
void draw_help(const Gui& gui, const viewer::Language& text);

}  // namespace calot::window

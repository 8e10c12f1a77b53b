#pragma once
// What a trial of a haptic device was: as text with a plot, as JSON, as a page, as a picture.

#include <string>

#include "haptics_trial.h"

namespace calot::app {

std::string trial_text(const HapticTrial& trial);
std::string trial_json(const HapticTrial& trial);
std::string trial_html(const HapticTrial& trial);
/// Force against depth as a picture that stands alone.
std::string trial_svg(const HapticTrial& trial);
std::string trial_csv(const HapticTrial& trial);

}  // namespace calot::app

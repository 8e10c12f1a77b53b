#pragma once
// A trial of a haptic device in figures, for text, JSON and page alike.

#include <string>
#include <vector>

#include "haptics_trial.h"

namespace calot::app {

struct TrialFigures {
    double deepest_m = 0.0, greatest_tissue_N = 0.0, greatest_device_N = 0.0;
    double at_5mm_N = 0.0, at_10mm_N = 0.0;  ///< while pressing; 0: not so deep
    std::vector<std::string> faults;         ///< "the simulation is late, twice"
};
TrialFigures figures_of(const HapticTrial& trial, const std::vector<DepthPoint>& points);

}  // namespace calot::app

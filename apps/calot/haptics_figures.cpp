#include "haptics_figures.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace calot::app {

TrialFigures figures_of(const HapticTrial& trial, const std::vector<DepthPoint>& points) {
    TrialFigures figures;
    for (const HapticRow& row : trial.rows) {
        figures.greatest_tissue_N = std::max(figures.greatest_tissue_N, glm::length(row.tissue_N));
        figures.greatest_device_N = std::max(figures.greatest_device_N, glm::length(row.device_N));
    }
    auto force_at = [&](double depth_m) {
        double sum_N = 0.0;
        int count = 0;
        for (const DepthPoint& point : points) {
            if (!point.pressing || std::abs(point.depth_m - depth_m) > 0.25e-3) continue;
            sum_N += point.force_N;
            ++count;
        }
        return count > 0 ? sum_N / count : 0.0;
    };
    for (const DepthPoint& point : points) figures.deepest_m = std::max(figures.deepest_m, point.depth_m);
    figures.at_5mm_N = force_at(5e-3);
    figures.at_10mm_N = force_at(10e-3);
    const auto& counts = trial.status.servo.faults;
    for (std::size_t k = 1; k < counts.size(); ++k) {
        // Waiting for the first hand is no fault of anybody.
        if (counts[k] == 0 || static_cast<haptics::Fault>(k) == haptics::Fault::absent) continue;
        figures.faults.push_back(fmt::format("{} ({} {})", haptics::describe(static_cast<haptics::Fault>(k)), counts[k],
                                             counts[k] == 1 ? "time" : "times"));
    }
    return figures;
}

}  // namespace calot::app

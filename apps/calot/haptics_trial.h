#pragma once
// A trial of a haptic device: it holds the hook of a running simulation, and what happens is kept.

#include <cstdint>
#include <string>
#include <vector>

#include "calot/haptics/choose.h"
#include "calot/haptics/session.h"
#include "calot/simulation/setup.h"
#include "commands.h"

namespace calot::app {

struct HapticRow {
    double time_s = 0.0;  ///< since the hand took hold
    Vec3 tip_m{0.0};
    Vec3 tissue_N{0.0};  ///< on the hook
    Vec3 device_N{0.0};  ///< on the hand, in the device's axes
    double absorbed_J = 0.0;
    haptics::Fault fault = haptics::Fault::none;
    bool pedal = false;
};

/// How a duration spread over the trial; 0 counts where there was none.
struct Timing {
    std::uint64_t count = 0;
    double mean_s = 0.0, median_s = 0.0, p99_s = 0.0, most_s = 0.0;
};

struct HapticTrial {
    std::string scene;
    haptics::SessionStatus status;  ///< at the end
    haptics::SessionOptions options;
    std::vector<HapticRow> rows;  ///< one a tick
    bool virtual_clock = false, interrupted = false;
    Timing period, latency, tick;  ///< of servo steps; from hand to force; between ticks
    std::vector<std::string> notes;

    /// The controller kept its promise: the hand never got more than the start's energy.
    bool passive() const;
};

/// Throws InputError when the device cannot be had, std::runtime_error when nobody takes hold of it in time.
HapticTrial run_trial(const HapticsOptions& options);

/// A point of the force against depth. Depth counts from the first touch, downwards (world z).
struct DepthPoint {
    double depth_m = 0.0, force_N = 0.0;
    bool pressing = true;
};
std::vector<DepthPoint> force_against_depth(const HapticTrial& trial);

}  // namespace calot::app

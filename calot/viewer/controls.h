#pragma once
// What the trainee wants at one moment: made from mouse, keys and pads by the Mapping, read by the physics thread.

#include <cstdint>

#include "calot/base/vec.h"

namespace calot::viewer {

/// Where a hand wants its instrument.
struct HandTarget {
    Vec3 tip_m{0.0};
    double roll_rad = 0.0;
    bool closed = false;  ///< jaws
};

struct Controls {
    HandTarget right;     ///< the hook
    HandTarget left;      ///< the grasper
    bool yellow = false;  ///< pedal: cut
    bool blue = false;    ///< pedal: coagulate
    double cut_W = 40.0;
    double coag_W = 30.0;
    bool blended_cut = false;
    bool suction = false;
    bool irrigation = false;
    bool wipe_tip = false;  ///< the char on the hook
    bool paused = false;
    std::int64_t sequence = 0;  ///< counts up with every sample
    double sampled_s = 0.0;     ///< steady clock, when the devices were read
};

}  // namespace calot::viewer

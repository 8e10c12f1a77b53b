#pragma once
// What the physics thread hands to the window: one picture and the figures beside it.

#include <cstdint>

#include "calot/tissue/state.h"
#include "calot/viewer/picture.h"

namespace calot::viewer {

/// How well the physics keeps up. Wall times.
struct Pace {
    double ticks_per_s = 0.0;     ///< 1000 is real time
    double lost_s = 0.0;          ///< by which simulated time fell behind the wall's since the start
    std::int64_t late_ticks = 0;  ///< begun more than a tick late
    double tick_us = 0.0;         ///< mean of the last ticks
    double longest_us = 0.0;      ///< of the last second
    double picture_us = 0.0;      ///< taken from the physics to fill the last picture
};

struct Figures {
    std::int64_t tick = 0;
    double time_s = 0.0;
    tissue::GeneratorState generator;
    tissue::Input input;
    Vec3 hook_force_N{0.0};
    Vec3 tip_m{0.0};
    float hottest_K = 310.15f;      ///< tissue at the hook
    double boiling_kg_per_s = 0.0;  ///< gas that left the tissue lately: the sizzle
    tissue::Status status;
    Pace pace;
    std::int64_t sequence = 0;  ///< of the controls that it answers
    double sampled_s = 0.0;     ///< when those were read
    double bleeding_m3_per_s = 0.0;
    double blood_lost_m3 = 0.0;
    bool paused = false;
};

struct Snapshot : Figures {
    render::View view;  ///< the window sets its camera
    Moment moment;      ///< out of which a Placer moves the view's tissue to its place
};

}  // namespace calot::viewer

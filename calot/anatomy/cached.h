#pragma once
// Distances sampled once: a shape whose every query costs the same few nanoseconds, for what is asked in every tick.

#include "calot/anatomy/shape.h"

namespace calot::anatomy {

/// `shape` on a grid of `spacing_m` over its bounds, trilinear between. Error near a surface of curvature radius r:
/// about spacing^2 / 8r. Far from the surface (more than a block of 4 cells) only every fourth point is asked for.
/// Takes 4 bytes a point; the spacing grows until at most `max_points` are needed.
ShapePtr make_cached(const ShapePtr& shape, double spacing_m, std::int64_t max_points = 4'000'000);

}  // namespace calot::anatomy

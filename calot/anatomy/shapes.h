#pragma once
// Elementary solids and their combinations. Distances in metres, negative inside.

#include <algorithm>
#include <functional>
#include <vector>

#include "calot/anatomy/shape.h"

namespace calot::anatomy {

/// Axis-aligned box; exact distance.
ShapePtr make_box(const Vec3& low_m, const Vec3& high_m);
ShapePtr make_sphere(const Vec3& centre_m, double radius_m);
/// Any function of position with a box that holds where it is negative.
ShapePtr make_shape(std::function<double(const Vec3&)> distance_m, const Box& bounds_m);

/// All solids together; `blend_m` > 0 rounds the seams between them (the width of the seam).
ShapePtr make_union(std::vector<ShapePtr> shapes, double blend_m = 0.0);

/// The part of `shape` inside a box.
ShapePtr make_clipped(ShapePtr shape, const Box& box_m);

/// The box that the solid really fills, up to 2 `resolution_m` wider: bounds_m() may be much larger. Spikes thinner than
/// the resolution may stick out.
Box tight_bounds_m(const Shape& shape, double resolution_m);

double box_distance_m(const Box& box_m, const Vec3& position_m);

/// Minimum with a rounded seam, polynomial (Quilez, "smooth minimum"): a convex mix of its arguments' slopes, so that
/// distances stay bounds.
inline double smooth_min(double a, double b, double blend) {
    const double h = std::max(blend - (a < b ? b - a : a - b), 0.0);
    return std::min(a, b) - (blend > 0.0 ? 0.25 * h * h / blend : 0.0);
}
inline double smooth_max(double a, double b, double blend) {
    return -smooth_min(-a, -b, blend);
}

}  // namespace calot::anatomy

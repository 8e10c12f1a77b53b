#pragma once
// Elementary solids and their combinations. Distances in metres, negative inside.

#include <functional>
#include <vector>

#include "calot/anatomy/shape.h"

namespace calot::anatomy {

/// Axis-aligned box; exact distance.
ShapePtr make_box(const Vec3& low_m, const Vec3& high_m);
ShapePtr make_sphere(const Vec3& centre_m, double radius_m);
/// Any function of position with a box that holds where it is negative.
ShapePtr make_shape(std::function<double(const Vec3&)> distance_m, const Box& bounds_m);

}  // namespace calot::anatomy

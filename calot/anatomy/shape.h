#pragma once
// Signed distance: the one view that sampling, collision and drawing have of any anatomy, parametric or imported.

#include <memory>

#include "calot/base/vec.h"

namespace calot::anatomy {

/// A solid. Thread-safe for reading.
class Shape {
  public:
    virtual ~Shape() = default;
    /// Signed distance [m] to the surface, negative inside. May underestimate the magnitude (a bound) away from the
    /// surface, exact in sign everywhere.
    virtual double distance_m(const Vec3& position_m) const = 0;
    /// A box that holds the solid.
    virtual Box bounds_m() const = 0;
};

using ShapePtr = std::shared_ptr<const Shape>;

/// What callers that skip space allow for: blends, noise and cached grids may exceed the true distance a little. Where
/// |distance_m(p)| > kDistanceSlack * r no surface crosses the ball of radius r about p.
inline constexpr double kDistanceSlack = 1.5;

}  // namespace calot::anatomy

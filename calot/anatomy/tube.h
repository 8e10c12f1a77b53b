#pragma once
// Swept tubes: ducts, vessels, the gallbladder. A centre line through control points, a radius at each.

#include <vector>

#include "calot/anatomy/shape.h"

namespace calot::anatomy {

/// A point of a centre line and the tube's radius there.
struct TubePoint {
    Vec3 position_m{0.0};
    double radius_m = 0.0;
};

/// Points along the Catmull-Rom curve through all control points (its ends included), `per_span` between each two.
std::vector<TubePoint> smooth_curve(const std::vector<TubePoint>& control, int per_span);

/// `count` points evenly spaced along a polyline.
std::vector<TubePoint> resample(const std::vector<TubePoint>& points, int count);

double length_m(const std::vector<TubePoint>& points);

/// The point at a share of the length, 0 = first, 1 = last.
TubePoint point_at(const std::vector<TubePoint>& points, double share);

/// A solid swept along a polyline by a ball of varying radius, ends rounded. Evaluated inline by shapes that build on
/// it.
class Tube final : public Shape {
  public:
    explicit Tube(const std::vector<TubePoint>& points);
    double distance_m(const Vec3& position_m) const override;
    Box bounds_m() const override { return bounds_; }

  private:
    struct Segment {
        Vec3 a, ab;
        double inverse_square, radius, growth;  ///< radius at a, and how much larger it is at b
        double scale;                           ///< makes the distance a bound where the radius changes
    };
    std::vector<Segment> segments_;
    Box bounds_;
};

ShapePtr make_tube(const std::vector<TubePoint>& points);

}  // namespace calot::anatomy

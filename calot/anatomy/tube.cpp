#include "calot/anatomy/tube.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace calot::anatomy {

namespace {

/// Catmull-Rom with uniform parameters: value at t in [0, 1] between b and c.
template <class T>
T catmull_rom(const T& a, const T& b, const T& c, const T& d, double t) {
    return 0.5 * ((2.0 * b) + (c - a) * t + (2.0 * a - 5.0 * b + 4.0 * c - d) * (t * t) +
                  (3.0 * b - a - 3.0 * c + d) * (t * t * t));
}

}  // namespace

std::vector<TubePoint> smooth_curve(const std::vector<TubePoint>& control, int per_span) {
    assert(control.size() >= 2 && per_span >= 1);
    const int last = static_cast<int>(control.size()) - 1;
    auto at = [&](int k) -> TubePoint {
        // Beyond the ends: mirrored, so that the curve leaves them straight.
        if (k < 0) return {2.0 * control[0].position_m - control[1].position_m, control[0].radius_m};
        if (k > last) return {2.0 * control[last].position_m - control[last - 1].position_m, control[last].radius_m};
        return control[static_cast<std::size_t>(k)];
    };
    std::vector<TubePoint> curve{control[0]};
    for (int k = 0; k < last; ++k)
        for (int i = 1; i <= per_span; ++i) {
            const double t = static_cast<double>(i) / per_span;
            const TubePoint a = at(k - 1), b = at(k), c = at(k + 1), d = at(k + 2);
            curve.push_back({catmull_rom(a.position_m, b.position_m, c.position_m, d.position_m, t),
                             std::max(0.0, catmull_rom(a.radius_m, b.radius_m, c.radius_m, d.radius_m, t))});
        }
    return curve;
}

double length_m(const std::vector<TubePoint>& points) {
    double length = 0.0;
    for (std::size_t k = 1; k < points.size(); ++k)
        length += glm::length(points[k].position_m - points[k - 1].position_m);
    return length;
}

TubePoint point_at(const std::vector<TubePoint>& points, double share) {
    double left = std::clamp(share, 0.0, 1.0) * length_m(points);
    for (std::size_t k = 1; k < points.size(); ++k) {
        const TubePoint &a = points[k - 1], &b = points[k];
        const double step = glm::length(b.position_m - a.position_m);
        if (left <= step && step > 0.0) {
            const double t = left / step;
            return {a.position_m + t * (b.position_m - a.position_m), a.radius_m + t * (b.radius_m - a.radius_m)};
        }
        left -= step;
    }
    return points.back();
}

std::vector<TubePoint> resample(const std::vector<TubePoint>& points, int count) {
    std::vector<TubePoint> even;
    for (int k = 0; k < count; ++k) even.push_back(point_at(points, static_cast<double>(k) / (count - 1)));
    return even;
}

Tube::Tube(const std::vector<TubePoint>& points) : bounds_{Vec3(1e9), Vec3(-1e9)} {
    for (std::size_t k = 1; k < points.size(); ++k) {
        const Vec3 a = points[k - 1].position_m, ab = points[k].position_m - a;
        const double square = glm::dot(ab, ab);
        if (square == 0.0) continue;
        const double growth = points[k].radius_m - points[k - 1].radius_m;
        segments_.push_back(
            {a, ab, 1.0 / square, points[k - 1].radius_m, growth, 1.0 / std::sqrt(1.0 + growth * growth / square)});
    }
    for (const TubePoint& p : points) {
        bounds_.low = glm::min(bounds_.low, p.position_m - p.radius_m);
        bounds_.high = glm::max(bounds_.high, p.position_m + p.radius_m);
    }
}

double Tube::distance_m(const Vec3& position_m) const {
    // Distance to the axis less the radius there. Its slope along the axis is that of the radius, so dividing by
    // sqrt(1 + slope^2) leaves a bound.
    double nearest = 1e9;
    for (const Segment& s : segments_) {
        const Vec3 ap = position_m - s.a;
        const double t = std::clamp(glm::dot(ap, s.ab) * s.inverse_square, 0.0, 1.0);
        const Vec3 off = ap - t * s.ab;
        nearest = std::min(nearest, s.scale * (std::sqrt(glm::dot(off, off)) - (s.radius + t * s.growth)));
    }
    return nearest;
}

ShapePtr make_tube(const std::vector<TubePoint>& points) {
    return std::make_shared<Tube>(points);
}

}  // namespace calot::anatomy

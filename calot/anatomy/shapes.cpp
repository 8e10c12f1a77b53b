#include "calot/anatomy/shapes.h"

#include <algorithm>

namespace calot::anatomy {

namespace {

class FunctionShape final : public Shape {
  public:
    FunctionShape(std::function<double(const Vec3&)> distance_m, const Box& bounds_m)
        : distance_(std::move(distance_m)), bounds_(bounds_m) {}
    double distance_m(const Vec3& position_m) const override { return distance_(position_m); }
    Box bounds_m() const override { return bounds_; }

  private:
    std::function<double(const Vec3&)> distance_;
    Box bounds_;
};

class UnionShape final : public Shape {
  public:
    UnionShape(std::vector<ShapePtr> shapes, double blend_m)
        : shapes_(std::move(shapes)), blend_(blend_m), bounds_{Vec3(1e9), Vec3(-1e9)} {
        for (const ShapePtr& shape : shapes_) {
            bounds_.low = glm::min(bounds_.low, shape->bounds_m().low - blend_m);
            bounds_.high = glm::max(bounds_.high, shape->bounds_m().high + blend_m);
        }
    }
    double distance_m(const Vec3& position_m) const override {
        double distance = 1e9;
        for (const ShapePtr& shape : shapes_) distance = smooth_min(distance, shape->distance_m(position_m), blend_);
        return distance;
    }
    Box bounds_m() const override { return bounds_; }

  private:
    std::vector<ShapePtr> shapes_;
    double blend_;
    Box bounds_;
};

/// Grows `tight` by what of the solid lies in `box`; boxes that can add nothing are not looked into.
void grow_bounds(const Shape& shape, const Box& box, double resolution_m, Box& tight) {
    if (glm::all(glm::greaterThanEqual(box.low, tight.low)) && glm::all(glm::lessThanEqual(box.high, tight.high)))
        return;
    const Vec3 extent = box.high - box.low, centre = 0.5 * (box.low + box.high);
    const double longest = std::max({extent.x, extent.y, extent.z}), distance = shape.distance_m(centre);
    if (distance > kDistanceSlack * 0.5 * glm::length(extent)) return;
    if (longest <= resolution_m) {
        if (distance < 0.0) tight = Box{glm::min(tight.low, box.low), glm::max(tight.high, box.high)};
        return;
    }
    const int axis = longest == extent.x ? 0 : longest == extent.y ? 1 : 2;
    Box half = box;
    half.high[axis] = centre[axis];
    grow_bounds(shape, half, resolution_m, tight);
    half = box;
    half.low[axis] = centre[axis];
    grow_bounds(shape, half, resolution_m, tight);
}

}  // namespace

Box tight_bounds_m(const Shape& shape, double resolution_m) {
    Box tight{Vec3(1e9), Vec3(-1e9)};
    // Coarse points first: what lies between those inside need not be looked into any more.
    constexpr int kPoints = 16;
    const Box box = shape.bounds_m();
    for (int k = 0; k < kPoints * kPoints * kPoints; ++k) {
        const Vec3 share((k % kPoints + 0.5) / kPoints, (k / kPoints % kPoints + 0.5) / kPoints,
                         (k / kPoints / kPoints + 0.5) / kPoints);
        const Vec3 p = box.low + share * (box.high - box.low);
        if (shape.distance_m(p) < 0.0) tight = Box{glm::min(tight.low, p), glm::max(tight.high, p)};
    }
    grow_bounds(shape, shape.bounds_m(), resolution_m, tight);
    return Box{tight.low - resolution_m, tight.high + resolution_m};
}

ShapePtr make_shape(std::function<double(const Vec3&)> distance_m, const Box& bounds_m) {
    return std::make_shared<FunctionShape>(std::move(distance_m), bounds_m);
}

double box_distance_m(const Box& box_m, const Vec3& position_m) {
    const Vec3 q = glm::abs(position_m - 0.5 * (box_m.low + box_m.high)) - 0.5 * (box_m.high - box_m.low);
    return glm::length(glm::max(q, Vec3(0.0))) + std::min(std::max({q.x, q.y, q.z}), 0.0);
}

ShapePtr make_box(const Vec3& low_m, const Vec3& high_m) {
    const Box box{low_m, high_m};
    return make_shape([box](const Vec3& p) { return box_distance_m(box, p); }, box);
}

ShapePtr make_sphere(const Vec3& centre_m, double radius_m) {
    return make_shape([centre_m, radius_m](const Vec3& p) { return glm::length(p - centre_m) - radius_m; },
                      Box{centre_m - Vec3(radius_m), centre_m + Vec3(radius_m)});
}

ShapePtr make_union(std::vector<ShapePtr> shapes, double blend_m) {
    return std::make_shared<UnionShape>(std::move(shapes), blend_m);
}

ShapePtr make_clipped(ShapePtr shape, const Box& box_m) {
    const Box bounds = shape->bounds_m();
    return make_shape(
        [shape, box_m](const Vec3& p) { return std::max(shape->distance_m(p), box_distance_m(box_m, p)); },
        Box{glm::max(bounds.low, box_m.low), glm::min(bounds.high, box_m.high)});
}

}  // namespace calot::anatomy

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

}  // namespace

ShapePtr make_shape(std::function<double(const Vec3&)> distance_m, const Box& bounds_m) {
    return std::make_shared<FunctionShape>(std::move(distance_m), bounds_m);
}

ShapePtr make_box(const Vec3& low_m, const Vec3& high_m) {
    const Vec3 centre = 0.5 * (low_m + high_m);
    const Vec3 half = 0.5 * (high_m - low_m);
    return make_shape(
        [centre, half](const Vec3& p) {
            const Vec3 q = glm::abs(p - centre) - half;
            return glm::length(glm::max(q, Vec3(0.0))) + std::min(std::max({q.x, q.y, q.z}), 0.0);
        },
        Box{low_m, high_m});
}

ShapePtr make_sphere(const Vec3& centre_m, double radius_m) {
    return make_shape([centre_m, radius_m](const Vec3& p) { return glm::length(p - centre_m) - radius_m; },
                      Box{centre_m - Vec3(radius_m), centre_m + Vec3(radius_m)});
}

}  // namespace calot::anatomy

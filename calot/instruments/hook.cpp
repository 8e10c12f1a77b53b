#include "calot/instruments/hook.h"

#include <cassert>
#include <cmath>

namespace calot::instruments {

namespace {

Vec3 to_world(const tissue::Pose& pose, const Vec3& local_m) {
    return pose.position_m + pose.orientation * local_m;
}

/// Unit vector across `axis` (unit) nearest to `wanted`, or to `otherwise` where `wanted` runs along the axis.
Vec3 across(const Vec3& axis, const Vec3& wanted, const Vec3& otherwise) {
    const Vec3 side = wanted - glm::dot(wanted, axis) * axis;
    if (glm::length(side) > 1e-6) return glm::normalize(side);
    return glm::normalize(otherwise - glm::dot(otherwise, axis) * axis);
}

}  // namespace

// The trocar lies at (-foot / 2, 0, -L) in the instrument's frame. With t the unit vector from trocar to tip and p the
// unit vector across it that roll turns, x = sin(alpha) t + cos(alpha) p and z = cos(alpha) t - sin(alpha) p, where
// sin(alpha) = (foot / 2) / |tip - trocar|.
tissue::Pose pose_through_trocar(const Vec3& trocar_m, const Vec3& tip_m, double roll_rad, const HookShape& shape) {
    const double distance_m = glm::length(tip_m - trocar_m);
    const double sine = 0.5 * shape.foot_length_m / distance_m;
    assert(sine < 1.0);
    const double cosine = std::sqrt(1.0 - sine * sine);
    const Vec3 t = (tip_m - trocar_m) / distance_m;
    const Vec3 down = across(t, Vec3(0.0, -1.0, 0.0), Vec3(0.0, 0.0, -1.0));
    const Vec3 p = std::cos(roll_rad) * down + std::sin(roll_rad) * glm::cross(t, down);
    const Vec3 x = sine * t + cosine * p, z = cosine * t - sine * p;
    return {tip_m, glm::normalize(glm::quat_cast(Mat3(x, glm::cross(z, x), z)))};
}

void place_hook(const HookShape& shape, const tissue::Pose& pose, const tissue::Pose& previous, double dt_s,
                std::vector<tissue::Capsule>& capsules) {
    capsules.clear();
    auto add = [&](const Vec3& a, const Vec3& b, double diameter_m, bool bare) {
        if (a == b) return;
        tissue::Capsule capsule;
        capsule.a_m = to_world(pose, a);
        capsule.b_m = to_world(pose, b);
        capsule.radius_m = 0.5 * diameter_m;
        capsule.bare = bare;
        capsule.velocity_a_m_per_s = (capsule.a_m - to_world(previous, a)) / dt_s;
        capsule.velocity_b_m_per_s = (capsule.b_m - to_world(previous, b)) / dt_s;
        capsules.push_back(capsule);
    };
    const double half_foot = 0.5 * shape.foot_length_m;
    const double bare_heel = std::fmax(0.0, shape.heel_length_m - shape.insulated_heel_m);
    const Vec3 bend(-half_foot, 0.0, 0.0), tip(half_foot, 0.0, 0.0);
    auto up = [&](double length_m) { return bend - Vec3(0.0, 0.0, length_m); };
    add(bend, tip, shape.wire_diameter_m, true);
    add(bend, up(bare_heel), shape.wire_diameter_m, true);
    add(up(bare_heel), up(shape.heel_length_m), shape.wire_diameter_m, false);
    // The shaft's rounded end stays above the heel.
    const double shaft_start = shape.heel_length_m + 0.5 * shape.shaft_diameter_m;
    add(up(shaft_start), up(shaft_start + shape.shaft_length_m), shape.shaft_diameter_m, false);
}

}  // namespace calot::instruments

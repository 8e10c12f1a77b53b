#include "calot/instruments/grasper.h"

#include <cmath>

#include "calot/instruments/hook.h"

namespace calot::instruments {

namespace {

/// Ends of a capsule's axis in the world.
struct Axis {
    Vec3 a_m, b_m;
};

Vec3 to_world(const tissue::Pose& pose, const Vec3& local_m) {
    return pose.position_m + pose.orientation * local_m;
}

/// One of the jaws: side = 1 opens along +x, -1 along -x.
Axis jaw_axis(const GrasperShape& shape, const tissue::GrasperInput& input, double side) {
    const double angle = 0.5 * shape.opening_rad * input.jaw;
    const Vec3 hinge(side * 0.5 * shape.jaw_diameter_m, 0.0, -shape.jaw_length_m);
    const Vec3 along(side * std::sin(angle), 0.0, std::cos(angle));
    return {to_world(input.pose, hinge), to_world(input.pose, hinge + shape.jaw_length_m * along)};
}

Axis shaft_axis(const GrasperShape& shape, const tissue::GrasperInput& input) {
    const double start = shape.jaw_length_m + 0.5 * shape.shaft_diameter_m;  // its rounded end stays above the hinge
    return {to_world(input.pose, Vec3(0.0, 0.0, -start)),
            to_world(input.pose, Vec3(0.0, 0.0, -start - shape.shaft_length_m))};
}

}  // namespace

tissue::Pose grasper_pose_through_trocar(const Vec3& trocar_m, const Vec3& tip_m, double roll_rad) {
    HookShape straight;  // the reference point lies on the shaft's axis
    straight.foot_length_m = 0.0;
    return pose_through_trocar(trocar_m, tip_m, roll_rad, straight);
}

void place_grasper(const GrasperShape& shape, const tissue::GrasperInput& now, const tissue::GrasperInput& previous,
                   bool holds, double dt_s, std::vector<tissue::Capsule>& capsules) {
    if (!now.present) return;
    const tissue::GrasperInput& before = previous.present ? previous : now;
    auto add = [&](const Axis& axis, const Axis& last, double diameter_m, bool solid) {
        tissue::Capsule capsule;
        capsule.a_m = axis.a_m;
        capsule.b_m = axis.b_m;
        capsule.radius_m = 0.5 * diameter_m;
        capsule.velocity_a_m_per_s = (axis.a_m - last.a_m) / dt_s;
        capsule.velocity_b_m_per_s = (axis.b_m - last.b_m) / dt_s;
        capsule.instrument = tissue::Instrument::grasper;
        capsule.solid = solid;
        capsules.push_back(capsule);
    };
    for (const double side : {1.0, -1.0})
        add(jaw_axis(shape, now, side), jaw_axis(shape, before, side), shape.jaw_diameter_m, !holds);
    add(shaft_axis(shape, now), shaft_axis(shape, before), shape.shaft_diameter_m, true);
}

}  // namespace calot::instruments

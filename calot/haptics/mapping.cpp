#include "calot/haptics/mapping.h"

#include <algorithm>
#include <cmath>

namespace calot::haptics {

Mat3 device_to_world(const Vec3& eye_m, const Vec3& target_m, const Vec3& up) {
    const Vec3 back = glm::normalize(eye_m - target_m);
    const Vec3 right = glm::normalize(glm::cross(up, back));
    return Mat3(right, glm::cross(back, right), back);
}

double roll_of(const Vec3& trocar_m, const tissue::Pose& pose, const instruments::HookShape& hook) {
    const tissue::Pose unrolled = instruments::pose_through_trocar(trocar_m, pose.position_m, 0.0, hook);
    const Quat turn = pose.orientation * glm::conjugate(unrolled.orientation);
    const Vec3 axis = glm::normalize(pose.position_m - trocar_m);
    return 2.0 * std::atan2(glm::dot(Vec3(turn.x, turn.y, turn.z), axis), turn.w);
}

void Mapping::anchor(const DeviceSample& device, const Vec3& tip_m, double roll_rad) {
    const MappingParameters& p = parameters_;
    device_anchor_m_ = device.position_m;
    last_orientation_ = device.orientation;
    roll_rad_ = roll_rad;
    tip_m_ = held_anchor_m_ = tip_m;
    if (p.lever == Lever::handle) {
        const Vec3 along = glm::normalize(tip_m - p.trocar_m);
        const double outside_m = std::max(p.least_handle_m, p.instrument_length_m - glm::distance(tip_m, p.trocar_m));
        held_anchor_m_ = p.trocar_m - outside_m * along;
    }
    follow(device);
}

void Mapping::follow(const DeviceSample& device) {
    const MappingParameters& p = parameters_;
    const Vec3 held_m = held_anchor_m_ + p.scale * (p.device_to_world * (device.position_m - device_anchor_m_));
    const double most_depth_m = p.instrument_length_m - p.least_handle_m;
    Vec3 along;
    double depth_m;
    derivative_ = p.scale * p.device_to_world;
    if (p.lever == Lever::handle) {
        // A handle at the trocar itself has no direction: it keeps the last one.
        const Vec3 out = p.trocar_m - held_m;
        const double outside_m = glm::length(out);
        along = outside_m > 1e-3 ? out / outside_m : glm::normalize(tip_m_ - p.trocar_m);
        depth_m = p.instrument_length_m - outside_m;
    } else {
        along = held_m - p.trocar_m;
        depth_m = glm::length(along);
        along = depth_m > 1e-3 ? along / depth_m : glm::normalize(tip_m_ - p.trocar_m);
    }
    asked_m_ = p.trocar_m + depth_m * along;
    depth_m = std::clamp(depth_m, p.least_depth_m, most_depth_m);
    tip_m_ = p.trocar_m + depth_m * along;
    if (p.lever == Lever::handle) {
        const double ratio = depth_m / (p.instrument_length_m - depth_m);
        const Mat3 axial = glm::outerProduct(along, along);
        derivative_ = (axial - ratio * (Mat3(1.0) - axial)) * derivative_;
    }
    // The stylus' turn about its own axis since the last sample.
    const Quat turn = glm::conjugate(last_orientation_) * device.orientation;
    const double sign = turn.w < 0.0 ? -1.0 : 1.0;
    roll_rad_ += 2.0 * std::atan2(sign * turn.z, sign * turn.w);
    last_orientation_ = device.orientation;
}

}  // namespace calot::haptics

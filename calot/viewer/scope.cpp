#include "calot/viewer/scope.h"

#include <algorithm>
#include <cmath>

namespace calot::viewer {

namespace {

constexpr double kShallowest_m = 0.09, kDeepest_m = 0.205;
constexpr double kMostTurn_rad = 0.55;

Vec3 across(const Vec3& wanted, const Vec3& axis) {
    Vec3 side = wanted - glm::dot(wanted, axis) * axis;
    if (glm::length(side) < 1e-6)
        side = Vec3(axis.y, axis.z, axis.x) - glm::dot(Vec3(axis.y, axis.z, axis.x), axis) * axis;
    return glm::normalize(side);
}

Vec3 turned(const Vec3& v, double angle_rad, const Vec3& axis) {
    return glm::angleAxis(angle_rad, axis) * v;
}

}  // namespace

Scope::Scope(const simulation::CameraSetup& camera)
    : look_at_m_(camera.target_m), field_of_view_deg_(camera.field_of_view_deg) {
    const Vec3 view = glm::normalize(camera.target_m - camera.eye_m);
    // The lens looks down from a rod that rises towards the picture's top: the view bent up by 30 degrees.
    const Vec3 above = across(Vec3(0.0, 1.0, 0.0), view);
    rod_ = glm::normalize(std::cos(kLensAngle_rad) * view + std::sin(kLensAngle_rad) * above);
    port_m_ = camera.eye_m - kDepth_m * rod_;
}

Scope::Frame Scope::frame() const {
    const Vec3 above0 = across(Vec3(0.0, 1.0, 0.0), rod_);
    const Vec3 side0 = glm::cross(rod_, above0);
    Frame f;
    f.rod = turned(turned(rod_, pitch_rad_, side0), -yaw_rad_, above0);
    f.above = turned(turned(above0, pitch_rad_, side0), -yaw_rad_, above0);
    f.side = glm::cross(f.rod, f.above);
    f.above = turned(f.above, roll_rad_, f.rod);
    f.side = turned(f.side, roll_rad_, f.rod);
    return f;
}

Vec3 Scope::tip_m() const {
    return port_m_ + depth_m_ * frame().rod;
}

render::Camera Scope::camera() const {
    const Frame f = frame();
    // lens_rad_ = 0 looks down in the unrolled picture; the lens turns with its own post, not with the camera head.
    const Vec3 down = turned(-f.above, lens_rad_ - roll_rad_, f.rod);
    const Vec3 view = std::cos(kLensAngle_rad) * f.rod + std::sin(kLensAngle_rad) * down;
    render::Camera camera;
    camera.eye_m = port_m_ + depth_m_ * f.rod;
    const double distance_m = std::clamp(glm::dot(look_at_m_ - camera.eye_m, view), 0.02, 0.14);
    camera.target_m = camera.eye_m + distance_m * view;
    camera.up = across(f.above, view);
    camera.field_of_view_deg = field_of_view_deg_;
    return camera;
}

void Scope::turn(double right_rad, double up_rad) {
    // With a rolled head, right in the picture is no longer right of the rod.
    const double c = std::cos(roll_rad_), s = std::sin(roll_rad_);
    yaw_rad_ = std::clamp(yaw_rad_ + c * right_rad - s * up_rad, -kMostTurn_rad, kMostTurn_rad);
    pitch_rad_ = std::clamp(pitch_rad_ + s * right_rad + c * up_rad, -kMostTurn_rad, kMostTurn_rad);
}

void Scope::advance(double deeper_m) {
    depth_m_ = std::clamp(depth_m_ + deeper_m, kShallowest_m, kDeepest_m);
}

void Scope::rotate_lens(double angle_rad) {
    lens_rad_ = std::remainder(lens_rad_ + angle_rad, 2.0 * 3.14159265358979323846);
}

void Scope::roll(double angle_rad) {
    roll_rad_ = std::remainder(roll_rad_ + angle_rad, 2.0 * 3.14159265358979323846);
}

void Scope::go(Preset preset) {
    yaw_rad_ = pitch_rad_ = lens_rad_ = roll_rad_ = 0.0;
    depth_m_ = kDepth_m;
    // Aims at the same place from elsewhere: the angles undo what depth and lens change.
    auto aim = [&] {
        // Turning by an angle carries the lens sideways too, which counts about three times as much: small steps.
        for (int k = 0; k < 40; ++k) {
            const render::Camera now = camera();
            const Vec3 view = glm::normalize(now.target_m - now.eye_m);
            const Vec3 wanted = glm::normalize(look_at_m_ - now.eye_m);
            const Vec3 side = glm::normalize(glm::cross(view, now.up)), above = glm::cross(side, view);
            turn(0.2 * glm::dot(wanted - view, side), 0.2 * glm::dot(wanted - view, above));
        }
    };
    switch (preset) {
        case Preset::start:
            return;
        case Preset::overview:
            depth_m_ = kDepth_m - 0.030;
            break;
        case Preset::close:
            depth_m_ = kDepth_m + 0.018;
            break;
        case Preset::from_side:
            lens_rad_ = 0.9;
            break;
    }
    aim();
}

}  // namespace calot::viewer

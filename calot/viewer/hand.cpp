#include "calot/viewer/hand.h"

#include <algorithm>
#include <cmath>

#include "calot/render/frame.h"

namespace calot::viewer {

namespace {

// The hand: stiff enough to follow within some 30 ms, weak enough that an organ stops it. A relaxed grip has 300 to
// 800 N/m; mass and damping are chosen so that the pair is critically damped.
constexpr double kGrip_N_per_m = 500.0;
constexpr double kMass_kg = 0.06;
constexpr double kMostForce_N = 20.0;      ///< that tissue is believed to push back with
constexpr double kFastest_m_per_s = 0.35;  ///< of a tip; faster movements are followed at this speed
constexpr double kRollTime_s = 0.03;

}  // namespace

Vec3 within_reach(const Vec3& tip_m, const Reach& reach) {
    Vec3 tip = tip_m;
    const Vec3 off = tip - reach.centre_m;
    const double distance = glm::length(off);
    if (distance > reach.radius_m) tip = reach.centre_m + off * (reach.radius_m / distance);
    const Vec3 shaft = tip - reach.port_m;
    const double depth = glm::length(shaft);
    if (depth < reach.least_depth_m) {
        const Vec3 inwards = glm::normalize(depth > 1e-9 ? shaft : reach.centre_m - reach.port_m);
        tip = reach.port_m + reach.least_depth_m * inwards;
    }
    return tip;
}

Vec3 moved_in_view(const Vec3& tip_m, const render::Camera& camera, const Reach& reach, double right, double up,
                   double deeper_m) {
    const Vec3 axis = glm::normalize(camera.target_m - camera.eye_m);
    const Vec3 side = glm::normalize(glm::cross(axis, camera.up)), above = glm::cross(side, axis);
    const double depth_m = std::max(0.005, glm::dot(tip_m - camera.eye_m, axis));
    // The field of view is measured across the round image, which is kRoundOverHeight pictures high.
    const double height_m =
        2.0 * depth_m * std::tan(0.5 * glm::radians(camera.field_of_view_deg)) / render::kRoundOverHeight;
    Vec3 tip = tip_m + height_m * (right * side + up * above);
    tip += deeper_m * glm::normalize(tip - reach.port_m);
    return within_reach(tip, reach);
}

void HeldInstrument::advance(const HandTarget& target, const Vec3& force_N, double dt_s) {
    const double force = glm::length(force_N);
    const Vec3 push = force > kMostForce_N ? force_N * (kMostForce_N / force) : force_N;
    // m a = k (target - x) - c v + push, implicit in x and v: stable for any tick.
    const double damping = 2.0 * std::sqrt(kGrip_N_per_m * kMass_kg);
    const Vec3 drive = kGrip_N_per_m * (target.tip_m - tip_m_) + push;
    velocity_m_per_s_ =
        (kMass_kg * velocity_m_per_s_ + dt_s * drive) / (kMass_kg + dt_s * damping + dt_s * dt_s * kGrip_N_per_m);
    const double speed = glm::length(velocity_m_per_s_);
    if (speed > kFastest_m_per_s) velocity_m_per_s_ *= kFastest_m_per_s / speed;
    tip_m_ += dt_s * velocity_m_per_s_;
    roll_rad_ += (target.roll_rad - roll_rad_) * (1.0 - std::exp(-dt_s / kRollTime_s));
}

}  // namespace calot::viewer

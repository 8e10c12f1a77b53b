#include "calot/haptics/coupling.h"

#include <cmath>

namespace calot::haptics {

void Coupling::place(const tissue::Pose& pose) {
    tip_m_ = pose.position_m;
    velocity_m_per_s_ = Vec3(0.0);
    roll_rad_ = roll_of(mapping_.parameters().trocar_m, pose, hook_);
    anchored_ = false;
}

tissue::Pose Coupling::advance(const HandMessage& hand, bool clutch, const Vec3& tissue_force_N, double dt_s) {
    if (!anchored_ || clutch) {
        mapping_.anchor(hand.sample, tip_m_, roll_rad_);
        velocity_m_per_s_ = Vec3(0.0);
        anchored_ = true;
    }
    clutch_ = clutch;
    mapping_.follow(hand.sample);
    if (!clutch) {
        const double k = parameters_.stiffness_N_per_m, b = parameters_.damping_N_s_per_m, m = parameters_.mass_kg;
        const Vec3 target_velocity = mapping_.derivative() * hand.sample.velocity_m_per_s;
        const Vec3 force_N = k * (mapping_.tip_m() - tip_m_) + b * target_velocity + tissue_force_N;
        velocity_m_per_s_ = (m * velocity_m_per_s_ + dt_s * force_N) / (m + dt_s * b + dt_s * dt_s * k);
        const double speed = glm::length(velocity_m_per_s_);
        if (speed > parameters_.most_speed_m_per_s) velocity_m_per_s_ *= parameters_.most_speed_m_per_s / speed;
        tip_m_ += dt_s * velocity_m_per_s_;
        roll_rad_ = mapping_.roll_rad();
    }
    return instruments::pose_through_trocar(mapping_.parameters().trocar_m, tip_m_, roll_rad_, hook_);
}

ToolMessage Coupling::message(const HandMessage& hand) const {
    ToolMessage message;
    message.hand_time_s = hand.time_s;
    message.engaged = anchored_ && !clutch_;
    if (!message.engaged) return message;
    const Mat3 back = glm::inverse(mapping_.derivative());
    message.position_m = hand.sample.position_m + back * (tip_m_ - mapping_.asked_m());
    message.velocity_m_per_s = back * velocity_m_per_s_;
    const Mat3 turn = mapping_.force_to_device() * mapping_.derivative();
    message.stiffness_N_per_m = parameters_.stiffness_N_per_m * turn;
    message.damping_N_s_per_m = parameters_.damping_N_s_per_m * turn;
    return message;
}

}  // namespace calot::haptics

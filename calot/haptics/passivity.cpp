#include "calot/haptics/passivity.h"

#include <algorithm>
#include <cmath>

namespace calot::haptics {

void PassivityControl::observe(const Vec3& moved_m) {
    double given_J = 0.0;
    held_sum_N_ += force_N_;
    held_steps_ += 1.0;
    for (int axis = 0; axis < 3; ++axis) {
        if (moved_m[axis] == 0.0) continue;
        given_J += held_sum_N_[axis] / held_steps_[axis] * moved_m[axis];
        held_sum_N_[axis] = held_steps_[axis] = 0.0;
    }
    tank_J_ = std::min(parameters_.capacity_J, tank_J_ - given_J);
    absorbed_J_ -= given_J;
    least_absorbed_J_ = std::min(least_absorbed_J_, absorbed_J_);
    withheld_J_ += std::max(0.0, glm::dot(wanted_N_ - force_N_, moved_m));
}

Vec3 PassivityControl::limit(const Vec3& wanted_N, const Vec3& velocity_m_per_s, double dt_s, double mass_kg) {
    const double strength_N = glm::length(wanted_N);
    if (!(strength_N > 1e-9)) {  // nothing to feel; and its square must stay a number to divide by
        release();
        return force_N_;
    }
    wanted_N_ = force_N_ = wanted_N;
    const double along_J = glm::dot(wanted_N, velocity_m_per_s) * dt_s;
    double share = 1.0;
    if (along_J > 0.0) share = std::clamp(tank_J_ / (parameters_.safety * along_J), 0.0, 1.0);
    // a s^2 + b s <= tank + start
    const double a = 0.5 * strength_N * strength_N * dt_s * dt_s / mass_kg;
    const double b = along_J + 0.5 * parameters_.hand_acceleration_m_per_s2 * dt_s * dt_s * strength_N;
    const double purse_J = std::max(0.0, tank_J_ + parameters_.start_J);
    if (a + b > purse_J)
        share = std::min(share, std::max(0.0, (-b + std::sqrt(b * b + 4.0 * a * purse_J)) / (2.0 * a)));
    if (share == 1.0) return force_N_;
    ++limited_;
    force_N_ = share * wanted_N;
    return force_N_;
}

}  // namespace calot::haptics

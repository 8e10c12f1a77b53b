#include "calot/haptics/servo.h"

#include <algorithm>
#include <cmath>

namespace calot::haptics {

namespace {

constexpr double kNominalStep_s = 1e-3;

bool finite(const Vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}
bool finite(const DeviceSample& sample) {
    const Quat& q = sample.orientation;
    const double norm = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
    return finite(sample.position_m) && norm > 0.25 && norm < 4.0 &&
           (!sample.has_velocity || finite(sample.velocity_m_per_s));
}

}  // namespace

void Servo::step(double now_s) noexcept {
    DeviceSample sample;
    double dt_s = kNominalStep_s;
    Fault fault = look(now_s, sample, dt_s);
    const bool hand_there = fault == Fault::none;
    Vec3 true_force_N(0.0);
    const Fault late = answer(now_s, sample, true_force_N);
    if (fault == Fault::none) fault = late;
    if (fault != Fault::none) true_force_N = Vec3(0.0);
    note(fault, now_s);

    if (now_s < quiet_until_s_ || !state_.engaged) ramp_ = 0.0;
    Vec3 force_N(0.0);
    if (ramp_ > 0.0) force_N = shape(true_force_N, dt_s, sample);
    if (force_N == Vec3(0.0)) passivity_.release();
    if (now_s >= quiet_until_s_ && state_.engaged) ramp_ = std::min(1.0, ramp_ + dt_s / parameters_.ramp_s);
    write_fault_ = device_.write(force_N);

    hands_.put({sample, now_s, hand_there});
    state_.time_s = now_s;
    state_.hand_m = sample.position_m;
    state_.true_force_N = true_force_N;
    state_.device_force_N = force_N;
    state_.tank_J = passivity_.tank_J();
    state_.absorbed_J = passivity_.absorbed_J();
    state_.least_absorbed_J = passivity_.least_absorbed_J();
    state_.withheld_J = passivity_.withheld_J();
    state_.limited = passivity_.limited();
    ++state_.steps;
    states_.put(state_);
    traces_.put(state_);
}

/// Reads and checks the device; books the work of the last force.
Fault Servo::look(double now_s, DeviceSample& sample, double& dt_s) noexcept {
    if (has_time_) {
        dt_s = now_s - last_s_;
        period_.add(dt_s);
    }
    has_time_ = true;
    last_s_ = now_s;
    dt_s = std::clamp(dt_s, 1e-5, 10.0 * kNominalStep_s);

    Fault fault = device_.read(now_s, sample);
    if (fault == Fault::none) fault = write_fault_;
    if (fault == Fault::none && !finite(sample)) fault = Fault::not_finite;
    const Vec3 moved_m = sample.position_m - last_.position_m;
    const bool jumped = fault == Fault::none && has_last_ && glm::length(moved_m) > parameters_.jump_m;
    if (fault != Fault::none || jumped) {
        has_last_ = jumped;  // after a jump, go on from there
        last_ = jumped ? sample : DeviceSample{};
        passivity_.release();
        sample = last_;
        return jumped ? Fault::device_error : fault;
    }
    sample.orientation = glm::normalize(sample.orientation);
    if (has_last_) passivity_.observe(moved_m);
    estimate_velocity(sample, has_last_ ? moved_m : Vec3(0.0), dt_s);
    has_last_ = true;
    last_ = sample;
    return Fault::none;
}

void Servo::estimate_velocity(DeviceSample& sample, const Vec3& moved_m, double dt_s) const noexcept {
    if (sample.has_velocity) return;
    const double share = dt_s / (parameters_.velocity_filter_s + dt_s);
    const Vec3 before = has_last_ ? last_.velocity_m_per_s : Vec3(0.0);
    sample.velocity_m_per_s = before + share * (moved_m / dt_s - before);
}

/// The coupling's force on the hand, from the simulation's latest word.
Fault Servo::answer(double now_s, const DeviceSample& sample, Vec3& true_force_N) noexcept {
    if (tools_.take(tool_)) {
        answered_s_ = now_s;
        if (tool_.engaged) latency_.add(now_s - tool_.hand_time_s);
    }
    state_.engaged = tool_.engaged;
    if (!tool_.finite) return Fault::not_finite;
    if (!tool_.engaged) return Fault::none;
    const double age_s = now_s - tool_.hand_time_s;
    if (now_s - answered_s_ > parameters_.late_s || age_s > 2.0 * parameters_.late_s) return Fault::simulation_late;
    const double carried_s = std::clamp(age_s, 0.0, parameters_.most_carried_s);
    const Vec3 tool_m = tool_.position_m + carried_s * tool_.velocity_m_per_s;
    true_force_N = tool_.stiffness_N_per_m * (tool_m - sample.position_m) +
                   tool_.damping_N_s_per_m * (tool_.velocity_m_per_s - sample.velocity_m_per_s);
    if (finite(true_force_N)) return Fault::none;
    true_force_N = Vec3(0.0);
    return Fault::not_finite;
}

Vec3 Servo::shape(const Vec3& true_force_N, double dt_s, const DeviceSample& sample) noexcept {
    Vec3 force_N = parameters_.gain * ramp_ * true_force_N;
    const double most_N = std::min(parameters_.max_force_N, device_.info().max_force_N);
    const double strength_N = glm::length(force_N);
    if (strength_N > most_N) {
        force_N *= most_N / strength_N;
        ++state_.clamped;
    }
    return passivity_.limit(force_N, sample.velocity_m_per_s, dt_s, device_.info().mass_kg);
}

void Servo::note(Fault fault, double now_s) noexcept {
    if (fault != Fault::none) {
        quiet_until_s_ = now_s + parameters_.hold_s;
        if (fault != state_.fault) ++state_.faults[static_cast<std::size_t>(fault)];
        if (fault == Fault::disconnected) lost_.store(true, std::memory_order_release);
    }
    state_.fault = fault;
}

void Servo::restart() noexcept {
    lost_.store(false, std::memory_order_release);
    has_last_ = has_time_ = false;
    last_ = {};
    write_fault_ = Fault::none;
    ramp_ = 0.0;
    passivity_.release();
    hands_.put({});
}

}  // namespace calot::haptics

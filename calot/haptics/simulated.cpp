#include "calot/haptics/simulated.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace calot::haptics {

namespace {

/// Steps of the hand's own motion: well below 2 m / b and sqrt(m / k).
constexpr double kStep_s = 1e-4;
/// Longer gaps between reads (a paused program) are not made up for.
constexpr double kLongest_s = 0.2;

double rounded(double value, double resolution) {
    return resolution > 0.0 ? resolution * std::round(value / resolution) : value;
}

}  // namespace

SimulatedDevice::SimulatedDevice(std::vector<HandKey> script, const HandParameters& hand)
    : hand_(hand), script_(std::move(script)), position_m_(script_.front().position_m) {
    assert(std::is_sorted(script_.begin(), script_.end(),
                          [](const HandKey& a, const HandKey& b) { return a.time_s < b.time_s; }));
    info_.name = "simulated";
    info_.model = "a spring-damper hand";
    info_.mass_kg = hand.mass_kg;
}

std::string SimulatedDevice::open() {
    return plugged_.load() ? "" : "the simulated device is unplugged";
}

HandKey SimulatedDevice::wanted(double time_s) const noexcept {
    std::size_t next = 0;
    while (next < script_.size() && script_[next].time_s <= time_s) ++next;
    if (next == 0) return script_.front();
    HandKey key = script_[next - 1];
    if (next == script_.size()) return key;
    const HandKey& to = script_[next];
    const double share = (time_s - key.time_s) / (to.time_s - key.time_s);
    const double smooth = share * share * share * (10.0 + share * (6.0 * share - 15.0));  // rests at both ends
    key.position_m = glm::mix(key.position_m, to.position_m, smooth);
    key.roll_rad = glm::mix(key.roll_rad, to.roll_rad, smooth);
    return key;
}

void SimulatedDevice::advance(double until_s) noexcept {
    if (until_s - time_s_ > kLongest_s) start_s_ += until_s - time_s_ - kLongest_s, until_s = time_s_ + kLongest_s;
    while (until_s - time_s_ > 1e-9) {
        const double dt = std::min(kStep_s, until_s - time_s_);
        const Vec3 target_m = wanted(time_s_ + dt).position_m;
        const Vec3 target_velocity = (target_m - wanted(time_s_).position_m) / dt;
        // Implicit in the hand's own spring and damper.
        const double k = hand_.stiffness_N_per_m, b = hand_.damping_N_s_per_m, m = hand_.mass_kg;
        const Vec3 push_N = k * (target_m - position_m_) + b * target_velocity + force_N_;
        velocity_m_per_s_ = (m * velocity_m_per_s_ + dt * push_N) / (m + dt * b + dt * dt * k);
        position_m_ += dt * velocity_m_per_s_;
        time_s_ += dt;
    }
}

Fault SimulatedDevice::read(double now_s, DeviceSample& sample) noexcept {
    if (!plugged_.load()) {
        force_N_ = Vec3(0.0);
        return Fault::disconnected;
    }
    if (!started_) start_s_ = now_s;
    started_ = true;
    advance(now_s - start_s_);
    const HandKey key = wanted(time_s_);
    for (int axis = 0; axis < 3; ++axis) sample.position_m[axis] = rounded(position_m_[axis], hand_.resolution_m);
    sample.orientation = glm::angleAxis(key.roll_rad, Vec3(0.0, 0.0, 1.0));
    sample.buttons = key.buttons;
    return Fault::none;
}

Fault SimulatedDevice::write(const Vec3& force_N) noexcept {
    if (!plugged_.load()) return Fault::disconnected;
    force_N_ = force_N;
    return Fault::none;
}

std::vector<HandKey> press_and_release(double depth_m, double seconds, bool cut) {
    const Vec3 down(0.0, -depth_m, 0.0);
    return {{0.0, Vec3(0.0), 0},
            {0.05 * seconds, Vec3(0.0), 0},
            {0.45 * seconds, down, cut ? 1u : 0u},
            {0.55 * seconds, down, 0},
            {0.95 * seconds, Vec3(0.0), 0}};
}

}  // namespace calot::haptics

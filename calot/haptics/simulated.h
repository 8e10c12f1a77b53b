#pragma once
// A device that is not there: a mass at the end of a hand that is a spring and a damper and follows a script. For
// tests, demonstrations, and to try the servo loop without hardware.
//
//     script --[ k, b ]-- device (mass) <-- force

#include <atomic>
#include <vector>

#include "calot/haptics/device.h"

namespace calot::haptics {

/// Where the hand wants to be at a moment, in the device's frame, and which buttons it holds from then on.
struct HandKey {
    double time_s = 0.0;  ///< from the first read
    Vec3 position_m{0.0};
    std::uint32_t buttons = 0;
    double roll_rad = 0.0;  ///< of the stylus about its axis
};

struct HandParameters {
    double mass_kg = 0.08;             ///< device and fingers
    double stiffness_N_per_m = 400.0;  ///< of a hand that holds a stylus firmly
    double damping_N_s_per_m = 8.0;
    double resolution_m = 0.055e-3;  ///< of the encoders, as the Touch's; 0: exact
};

class SimulatedDevice : public HapticDevice {
  public:
    /// Requires at least one key, in order of time. Between keys the hand moves smoothly and rests at each.
    explicit SimulatedDevice(std::vector<HandKey> script, const HandParameters& hand = {});

    const DeviceInfo& info() const override { return info_; }
    std::string open() override;
    void close() noexcept override {}
    Fault read(double now_s, DeviceSample& sample) noexcept override;
    Fault write(const Vec3& force_N) noexcept override;

    /// The cable: reads and open() fail while it is out. From any thread.
    void plug(bool in) { plugged_.store(in); }

    /// Where the hand is, as finely as no encoder shows it. From the servo's thread.
    const Vec3& position_m() const { return position_m_; }

  private:
    HandKey wanted(double time_s) const noexcept;
    void advance(double until_s) noexcept;

    DeviceInfo info_;
    HandParameters hand_;
    std::vector<HandKey> script_;
    Vec3 position_m_, velocity_m_per_s_{0.0}, force_N_{0.0};
    double start_s_ = 0.0, time_s_ = 0.0;  ///< time_s_ counts from start_s_
    bool started_ = false;
    std::atomic<bool> plugged_{true};
};

/// The hand of the demonstration: it waits, goes down by `depth_m`, holds, and comes up again, within `seconds`; with
/// the pedal down while it holds when `cut`.
std::vector<HandKey> press_and_release(double depth_m, double seconds, bool cut = false);

}  // namespace calot::haptics

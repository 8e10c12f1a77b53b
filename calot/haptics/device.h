#pragma once
// What a haptic device is to Calot: a pose and buttons come in, a force goes out, a thousand times a second.
//
// The device's frame: metres, x to the right, y up, z towards the person, origin anywhere. The stylus' own frame is
// that of an instrument: its z axis runs from the hand to the tip (tissue/input.h).

#include <cstdint>
#include <string>

#include "calot/base/vec.h"

namespace calot::haptics {

/// Why the force is zero.
enum class Fault : std::uint8_t {
    none,
    absent,           ///< nobody at the other end yet; the device itself waits for them
    disconnected,     ///< gone: it must be closed and opened again
    device_error,     ///< it reported an error, or its pose jumped
    motors_warm,      ///< it protects its motors
    not_calibrated,   ///< it does not know where it is yet
    not_finite,       ///< a pose or a force is not a number
    simulation_late,  ///< no new tick of the simulation for too long
};
inline constexpr int kFaults = 8;

/// A few words for people.
const char* describe(Fault fault);

struct DeviceInfo {
    std::string name;                                                      ///< "openhaptics", "simulated", "network"
    std::string model;                                                     ///< what the device calls itself
    Box workspace_m{Vec3(-0.08, -0.06, -0.035), Vec3(0.08, 0.06, 0.035)};  ///< reachable, in its frame
    double max_force_N = 3.3;                                              ///< at any moment; the Touch's
    double max_continuous_force_N = 0.88;                                  ///< without getting warm
    double mass_kg = 0.045;  ///< apparent at the tip; the Touch's. The passivity controller relies on no less
};

/// What the hand does at one moment.
struct DeviceSample {
    Vec3 position_m{0.0};
    Quat orientation{1.0, 0.0, 0.0, 0.0};
    Vec3 velocity_m_per_s{0.0};
    bool has_velocity = false;  ///< otherwise it is estimated from positions
    std::uint32_t buttons = 0;  ///< bit 0: the first
};

class HapticDevice {
  public:
    virtual ~HapticDevice() = default;

    /// Valid after open() succeeded; what the device can do, as far as it tells.
    virtual const DeviceInfo& info() const = 0;

    /// Connects. Returns an empty text, or why it could not. May take seconds. Not while the clock runs.
    virtual std::string open() = 0;
    /// Disconnects; the device's force is zero afterwards. Harmless when not open.
    virtual void close() noexcept = 0;

    /// The servo loop calls read() once and write() once a step, in this order, from one thread. Neither blocks,
    /// allocates or throws. `now_s` is the servo's clock and never runs backwards.
    virtual Fault read(double now_s, DeviceSample& sample) noexcept = 0;
    /// Sets the force that acts on the hand until the next write.
    virtual Fault write(const Vec3& force_N) noexcept = 0;

    /// A device with a clock of its own calls tick(user) at its rate, from its thread, until stop_clock(), and returns
    /// true. Others return false: the session then runs a thread for it.
    using Tick = void (*)(void* user);
    virtual bool start_clock(Tick, void*) { return false; }
    virtual void stop_clock() noexcept {}
};

}  // namespace calot::haptics

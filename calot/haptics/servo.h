#pragma once
// One step of the servo loop: hand in, force out. It has no clock and no thread of its own: whoever calls step() says
// what time it is, so that tests drive it by a virtual clock.
//
//     device.read -> observe energy -> coupling force -> gain, ramp, clamp -> passivity -> device.write
//                         |                 ^
//                    HandMessage       ToolMessage           (triple buffers to and from the simulation's thread)
//
// Any fault sets the force to zero in the same step. Once the fault has gone for `hold_s`, the force comes back over
// `ramp_s`.

#include <array>
#include <atomic>
#include <cstdint>

#include "calot/base/triple_buffer.h"
#include "calot/haptics/coupling.h"
#include "calot/haptics/device.h"
#include "calot/haptics/passivity.h"
#include "calot/haptics/spread.h"

namespace calot::haptics {

struct ServoParameters {
    double gain = 1.0;         ///< of the force on the hand over the true one: 5 kPa fat gives but 0.3 N
    double max_force_N = 3.3;  ///< never more than this, nor than the device stands
    double late_s = 0.02;      ///< the simulation's answer may be this old
    double hold_s = 0.2;
    double ramp_s = 0.1;
    double velocity_filter_s = 8e-3;  ///< time constant, where the device tells no velocity
    double most_carried_s = 4e-3;     ///< the instrument is carried on by its velocity for so long at most
    double jump_m = 0.03;             ///< between two samples: no hand does that
    PassivityParameters passivity;
};

/// What the servo loop last did, for screens and reports.
struct ServoState {
    double time_s = 0.0;
    Fault fault = Fault::absent;
    bool engaged = false;      ///< the hand holds the instrument
    Vec3 hand_m{0.0};          ///< in the device's frame
    Vec3 true_force_N{0.0};    ///< of the coupling, before gain, ramp, clamp and passivity; device's axes
    Vec3 device_force_N{0.0};  ///< as written
    double tank_J = 0.0, absorbed_J = 0.0, least_absorbed_J = 0.0, withheld_J = 0.0;
    std::int64_t steps = 0, clamped = 0, limited = 0;
    std::array<std::int64_t, kFaults> faults{};  ///< how often each came, by index
};

class Servo {
  public:
    Servo(HapticDevice& device, const ServoParameters& parameters) : device_(device), parameters_(parameters) {}

    /// From the servo thread. Does not throw, allocate, lock or log.
    void step(double now_s) noexcept;
    /// The device is gone or new, while no step runs: the hand lets go, the next step starts afresh.
    void restart() noexcept;
    /// A step met Fault::disconnected. Any thread.
    bool lost() const { return lost_.load(std::memory_order_acquire); }

    // The simulation's thread.
    bool take_hand(HandMessage& hand) { return hands_.take(hand); }
    void put_tool(const ToolMessage& tool) { tools_.put(tool); }
    bool take_trace(ServoState& state) { return traces_.take(state); }

    // One other thread.
    bool take_state(ServoState& state) { return states_.take(state); }

    const Spread& period() const { return period_; }    ///< between steps
    const Spread& latency() const { return latency_; }  ///< from the hand's sample to the force that answers it

  private:
    Fault look(double now_s, DeviceSample& sample, double& dt_s) noexcept;
    Fault answer(double now_s, const DeviceSample& sample, Vec3& true_force_N) noexcept;
    void estimate_velocity(DeviceSample& sample, const Vec3& moved_m, double dt_s) const noexcept;
    Vec3 shape(const Vec3& true_force_N, double dt_s, const DeviceSample& sample) noexcept;
    void note(Fault fault, double now_s) noexcept;

    HapticDevice& device_;
    ServoParameters parameters_;
    PassivityControl passivity_;
    TripleBuffer<HandMessage> hands_;
    TripleBuffer<ToolMessage> tools_;
    TripleBuffer<ServoState> states_, traces_;
    Spread period_, latency_;

    ToolMessage tool_;
    DeviceSample last_;
    ServoState state_;
    double last_s_ = 0.0, answered_s_ = 0.0, quiet_until_s_ = 0.0, ramp_ = 0.0;
    bool has_last_ = false, has_time_ = false;
    Fault write_fault_ = Fault::none;
    std::atomic<bool> lost_{false};
};

}  // namespace calot::haptics

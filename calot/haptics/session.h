#pragma once
// What a program holds to let a hand feel a running simulation.
//
//     haptics::Session session(haptics::make_device({}), options);
//     session.start();
//     // on the simulation's thread, a thousand times a second:
//     session.drive(input);          // the hand moves input.hook; its buttons are pedal and clutch
//     simulation.tick(input);
//     session.feel(simulation.state());
//     // anywhere else:
//     session.status();
//
// Threads: the servo loop runs in a thread of its own (or in the device's); a keeper opens the device, and opens it
// again after it was unplugged. drive(), feel() and rest() never wait, lock or allocate.

#include <atomic>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "calot/haptics/coupling.h"
#include "calot/haptics/device.h"
#include "calot/haptics/periodic.h"
#include "calot/haptics/servo.h"
#include "calot/tissue/input.h"
#include "calot/tissue/state.h"

namespace calot::haptics {

struct SessionOptions {
    MappingParameters mapping;
    CouplingParameters coupling;
    ServoParameters servo;
    instruments::HookShape hook;
    int pedal_button = 0;   ///< index; -1: none
    int clutch_button = 1;  ///< while held, the hand moves without the instrument; -1: none
    double tick_s = 1e-3;   ///< of the simulation
    double servo_period_s = 1e-3;
    int priority = 70;     ///< real-time, 0: do not ask for it
    double retry_s = 0.5;  ///< between attempts to open the device
    bool threads = true;   ///< false: nothing runs by itself; tests call keep() and servo_step()
};

struct SessionStatus {
    DeviceInfo device;
    bool open = false;
    std::string note;     ///< why it is not open; what the real-time policy says
    int connections = 0;  ///< how often the device was opened
    ServoState servo;
};

class Session {
  public:
    Session(std::unique_ptr<HapticDevice> device, const SessionOptions& options);
    ~Session();
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    void start();
    /// The force is zero and the device closed when this returns.
    void stop();

    // On the simulation's thread.

    /// Before a tick: moves input.hook with the hand and presses the pedal with its button. Returns false, with input
    /// as it was, while no hand is on the device: something else may move the hook then, and the hand will find it
    /// there.
    bool drive(tissue::Input& input);
    /// After a tick: what the tissue answered.
    void feel(const tissue::State& state);
    /// Instead of both while the simulation pauses: the force fades out, and nothing is late.
    void rest();

    /// What the servo loop last did.
    void servo_state(ServoState& state) { servo_.take_trace(state); }

    /// From one thread, not the simulation's.
    SessionStatus status();
    const Spread& period() const { return servo_.period(); }
    const Spread& latency() const { return servo_.latency(); }

    // Without threads (SessionOptions::threads == false): what the threads would do.

    /// Opens the device if it is not open and closes it if it was lost.
    void keep();
    void servo_step(double now_s) { servo_.step(now_s); }

  private:
    void keep_going();
    void start_servo();
    void stop_servo();

    std::unique_ptr<HapticDevice> device_;
    SessionOptions options_;
    Servo servo_;

    // The simulation's thread
    Coupling coupling_;
    HandMessage hand_;
    Vec3 tissue_force_N_{0.0};
    bool finite_ = true;

    // The keeper
    std::thread keeper_;
    PeriodicThread servo_thread_;
    bool open_ = false, device_clock_ = false;
    std::mutex mutex_;  ///< of what follows: the keeper's and status()'s; never taken by servo or simulation
    std::condition_variable wake_;
    bool stop_ = false;
    SessionStatus shared_;
    std::string open_note_, policy_note_;
};

}  // namespace calot::haptics

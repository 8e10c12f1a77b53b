// A session with all its threads: servo, keeper, simulation, and somebody who looks. Nothing here looks at a clock but
// to give up.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <thread>

#include "rig.h"

namespace calot::haptics {

namespace {

/// Ticks of a tissue that is a spring above z = 0, in a thread of its own.
class SpringWorld {
  public:
    explicit SpringWorld(Session& session) : session_(session), thread_([this] { work(); }) {}
    ~SpringWorld() {
        stop_ = true;
        thread_.join();
    }
    bool held() const { return held_; }
    double force_N() const { return force_N_; }
    void pause(bool paused) { paused_ = paused; }

  private:
    void work() {
        tissue::Input input;
        input.hook = instruments::pose_through_trocar(kTrocar_m, Vec3(0.0, 0.0, 1e-3), 0.0);
        tissue::State state;
        while (!stop_) {
            if (paused_) {
                session_.rest();
            } else {
                held_ = session_.drive(input);
                state.hook_force_N.z = -100.0 * std::min(0.0, input.hook.position_m.z);
                force_N_ = state.hook_force_N.z;
                session_.feel(state);
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
    }
    Session& session_;
    std::atomic<bool> stop_{false}, held_{false}, paused_{false};
    std::atomic<double> force_N_{0.0};
    std::thread thread_;
};

template <class Done>
bool wait_until(Done done) {
    for (int k = 0; k < 20000; ++k) {
        if (done()) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
}

}  // namespace

TEST(Threads, RunUnplugPauseAndStop) {
    SessionOptions options = rig_options();
    options.threads = true;
    options.retry_s = 0.01;
    options.servo.late_s = 10.0;  // a busy machine is no fault here
    // Up and down for as long as it takes.
    std::vector<HandKey> script;
    for (int k = 0; k < 600; ++k) script.push_back({0.1 * k, Vec3(0.0, k % 2 == 0 ? 0.0 : -8e-3, 0.0)});
    auto device = std::make_unique<SimulatedDevice>(script);
    SimulatedDevice& cable = *device;
    Session session(std::move(device), options);
    session.start();
    {
        SpringWorld world(session);
        auto feels = [&] { return session.status().servo.device_force_N.y > 0.1; };
        EXPECT_TRUE(wait_until([&] { return world.held() && feels(); }));
        EXPECT_GT(session.period().count(), 0u);
        EXPECT_GT(session.latency().count(), 0u);
        cable.plug(false);
        EXPECT_TRUE(wait_until([&] { return !world.held() && !session.status().open; }));
        EXPECT_EQ(session.status().note, "the simulated device is unplugged");
        cable.plug(true);
        EXPECT_TRUE(wait_until([&] { return world.held() && feels(); }));
        EXPECT_EQ(session.status().connections, 2);
        world.pause(true);
        EXPECT_TRUE(wait_until([&] { return !session.status().servo.engaged; }));
        EXPECT_EQ(session.status().servo.fault, Fault::none);
        world.pause(false);
        EXPECT_TRUE(wait_until(feels));
        session.stop();
        EXPECT_FALSE(session.status().open);
        session.start();
        EXPECT_TRUE(wait_until([&] { return session.status().open && feels(); }));
    }
}

// It ends when it is told to, its clock never runs backwards.
TEST(Threads, APeriodicThreadStopsAndStartsAgain) {
    PeriodicThread thread;
    std::atomic<int> calls{0};
    for (int round = 0; round < 3; ++round) {
        const int before = calls;
        double last_s = 0.0;
        bool forwards = true;
        thread.start(1e-4, 0, [&](double now_s) {
            forwards = forwards && now_s >= last_s;
            last_s = now_s;
            ++calls;
        });
        EXPECT_TRUE(wait_until([&] { return calls > before + 20; }));
        thread.stop();
        EXPECT_TRUE(forwards);
        EXPECT_FALSE(thread.running());
    }
}

}  // namespace calot::haptics

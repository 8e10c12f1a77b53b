// Whatever goes wrong, the force is zero in the same step; when all is well again, it comes back.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "rig.h"
#include "support/allocations.h"

namespace calot::haptics {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// A device of which a test decides every sample.
class PuppetDevice : public HapticDevice {
  public:
    const DeviceInfo& info() const override { return info_; }
    std::string open() override { return ""; }
    void close() noexcept override {}
    Fault read(double, DeviceSample& sample) noexcept override {
        sample = next;
        return fault;
    }
    Fault write(const Vec3& force_N) noexcept override {
        force = force_N;
        return write_fault;
    }
    DeviceSample next;
    Fault fault = Fault::none, write_fault = Fault::none;
    Vec3 force{0.0};

  private:
    DeviceInfo info_;
};

/// A servo whose hand moves down at 50 mm/s against a spring of 300 N/m that stays 10 mm above it.
struct Bench {
    PuppetDevice device;
    Servo servo;
    ToolMessage tool;
    double time_s = 50.0;

    explicit Bench(const ServoParameters& parameters = {}) : servo(device, parameters) {
        tool.engaged = true;
        tool.stiffness_N_per_m = Mat3(300.0);
    }
    ServoState step(bool simulate = true) {
        time_s += 1e-3;
        device.next.position_m.y -= 5e-5;
        if (simulate) {
            tool.hand_time_s = time_s - 1e-3;
            tool.position_m = device.next.position_m + Vec3(0.0, 0.01, 0.0);
            servo.put_tool(tool);
        }
        servo.step(time_s);
        ServoState state;
        servo.take_state(state);
        return state;
    }
    void run(int steps, bool simulate = true) {
        for (int k = 0; k < steps; ++k) step(simulate);
    }
};

constexpr double kFull_N = 3.0, kTolerance_N = 0.05;

}  // namespace

TEST(Faults, AHandOnASpringFeelsIt) {
    Bench bench;
    bench.run(300);
    EXPECT_NEAR(bench.device.force.y, kFull_N, kTolerance_N);
    EXPECT_EQ(bench.step().fault, Fault::none);
}

TEST(Faults, ALateSimulationMeansZeroForce) {
    Bench bench;
    bench.run(300);
    bench.run(19, false);
    EXPECT_GT(bench.device.force.y, 1.0) << "a few milliseconds are bridged";
    bench.run(5, false);
    EXPECT_EQ(bench.device.force, Vec3(0.0));
    EXPECT_EQ(bench.step(false).fault, Fault::simulation_late);
    // It comes back, after a while and not at once.
    bench.run(150);
    EXPECT_EQ(bench.device.force, Vec3(0.0));
    bench.run(100);
    EXPECT_LT(bench.device.force.y, 0.9 * kFull_N);
    EXPECT_GT(bench.device.force.y, 0.0);
    bench.run(150);
    EXPECT_NEAR(bench.device.force.y, kFull_N, kTolerance_N);
    EXPECT_EQ(bench.step().faults[static_cast<std::size_t>(Fault::simulation_late)], 1);
}

// An answer that keeps coming but belongs to an old hand is late, too.
TEST(Faults, AnAnswerToAnOldHandIsLate) {
    Bench bench;
    bench.run(300);
    for (int k = 0; k < 60; ++k) {
        bench.time_s += 1e-3;
        bench.servo.put_tool(bench.tool);
        bench.servo.step(bench.time_s);
    }
    EXPECT_EQ(bench.device.force, Vec3(0.0));
}

TEST(Faults, NoNumberMeansZeroForce) {
    for (int what = 0; what < 5; ++what) {
        Bench bench;
        bench.run(300);
        ASSERT_GT(bench.device.force.y, 1.0);
        const DeviceSample good = bench.device.next;
        const ToolMessage good_tool = bench.tool;
        if (what == 0) bench.device.next.position_m.x = kNaN;
        if (what == 1) bench.device.next.orientation = Quat(0.0, 0.0, 0.0, 0.0);
        if (what == 2) bench.device.next.has_velocity = true, bench.device.next.velocity_m_per_s.z = INFINITY;
        if (what == 3) bench.tool.velocity_m_per_s.y = kNaN, bench.tool.damping_N_s_per_m = Mat3(1.0);
        if (what == 4) bench.tool.finite = false;
        EXPECT_EQ(bench.step().fault, Fault::not_finite) << what;
        EXPECT_EQ(bench.device.force, Vec3(0.0)) << what;
        HandMessage hand;
        bench.servo.take_hand(hand);
        EXPECT_EQ(hand.present, what > 2) << "the simulation never sees such a pose";
        bench.device.next = good;
        bench.tool = good_tool;
        bench.run(500);
        EXPECT_NEAR(bench.device.force.y, kFull_N, kTolerance_N) << what;
    }
}

TEST(Faults, AJumpOfThePoseMeansZeroForce) {
    Bench bench;
    bench.run(300);
    bench.device.next.position_m.x += 0.05;
    EXPECT_EQ(bench.step().fault, Fault::device_error);
    EXPECT_EQ(bench.device.force, Vec3(0.0));
    bench.run(500);
    EXPECT_NEAR(bench.device.force.y, kFull_N, kTolerance_N) << "it goes on from the new place";
}

TEST(Faults, AnErrorOfTheDeviceMeansZeroForce) {
    for (const Fault fault : {Fault::device_error, Fault::motors_warm, Fault::not_calibrated, Fault::absent}) {
        Bench bench;
        bench.run(300);
        bench.device.fault = fault;
        EXPECT_EQ(bench.step().fault, fault);
        EXPECT_EQ(bench.device.force, Vec3(0.0));
        EXPECT_FALSE(bench.servo.lost());
    }
    Bench bench;
    bench.run(300);
    bench.device.write_fault = Fault::disconnected;
    bench.run(2);
    EXPECT_EQ(bench.device.force, Vec3(0.0));
    EXPECT_TRUE(bench.servo.lost());
}

TEST(Limits, TheForceIsClampedByParametersAndDevice) {
    ServoParameters strong;
    strong.gain = 5.0;
    strong.max_force_N = 10.0;
    Bench bench(strong);
    bench.run(300);
    EXPECT_NEAR(glm::length(bench.device.force), 3.3, 1e-9) << "the device stands no more";
    EXPECT_GT(bench.step().clamped, 100);
    ServoParameters weak;
    weak.max_force_N = 0.5;
    Bench gentle(weak);
    gentle.run(300);
    EXPECT_NEAR(glm::length(gentle.device.force), 0.5, 1e-9);
}

TEST(Limits, TheGainMultipliesWhatIsFelt) {
    ServoParameters parameters;
    parameters.gain = 0.25;
    Bench bench(parameters);
    bench.run(300);
    EXPECT_NEAR(bench.device.force.y, 0.25 * kFull_N, kTolerance_N);
    EXPECT_NEAR(bench.step().true_force_N.y, kFull_N, kTolerance_N) << "reports stay true";
}

TEST(Limits, AStepDoesNotAllocate) {
    Bench bench;
    bench.run(10);
    const long before = test::allocations();
    bench.run(300);
    EXPECT_EQ(test::allocations(), before);
}

// The simulation hangs in mid-press with everything attached, then goes on.
TEST(Session, SurvivesASimulationThatHangs) {
    Rig rig(small_setup(), press_and_release(9e-3, 2.0), Vec3(0.0, 0.0, 3e-3));
    for (int k = 0; k < 800; ++k) rig.tick();
    EXPECT_GT(rig.tick().servo.device_force_N.y, 0.05);
    for (int k = 0; k < 60; ++k) rig.tick(false);
    EXPECT_EQ(rig.tick(false).servo.fault, Fault::simulation_late);
    EXPECT_EQ(rig.tick(false).servo.device_force_N, Vec3(0.0));
    for (int k = 0; k < 400; ++k) rig.tick();
    EXPECT_EQ(rig.tick().servo.fault, Fault::none);
}

// A pause is no fault.
TEST(Session, RestsWithoutFault) {
    Rig rig(small_setup(), press_and_release(9e-3, 2.0), Vec3(0.0, 0.0, 3e-3));
    for (int k = 0; k < 800; ++k) rig.tick();
    rig.session().rest();
    for (int k = 0; k < 100; ++k) {
        const Moment& m = rig.tick(false);
        EXPECT_EQ(m.servo.fault, Fault::none);
        EXPECT_EQ(m.servo.device_force_N, Vec3(0.0));
    }
    const Vec3 tip_m = rig.input().hook.position_m;
    EXPECT_TRUE(rig.tick().driven);
    EXPECT_NEAR(glm::distance(rig.input().hook.position_m, tip_m), 0.0, 1e-3) << "it goes on where it was";
}

// The cable comes out in mid-press: zero force, the hook stays where it is; back in, the hand finds it there.
TEST(Session, SurvivesTheCableInMidRun) {
    Rig rig(small_setup(), press_and_release(9e-3, 2.0), Vec3(0.0, 0.0, 3e-3));
    for (int k = 0; k < 800; ++k) rig.tick();
    ASSERT_GT(rig.tick().servo.device_force_N.y, 0.05);
    rig.device().plug(false);
    const Moment pulled = rig.tick();
    EXPECT_EQ(pulled.servo.fault, Fault::disconnected);
    EXPECT_EQ(pulled.servo.device_force_N, Vec3(0.0));
    const Vec3 left_m = rig.input().hook.position_m;
    for (int k = 0; k < 50; ++k) {
        rig.session().keep();
        EXPECT_FALSE(rig.tick().driven);
    }
    EXPECT_FALSE(rig.session().status().open);
    EXPECT_EQ(rig.session().status().note, "the simulated device is unplugged");
    EXPECT_EQ(rig.input().hook.position_m, left_m);
    rig.device().plug(true);
    rig.session().keep();
    EXPECT_EQ(rig.session().status().connections, 2);
    Vec3 before_m = left_m;
    for (int k = 0; k < 600; ++k) {
        const Moment& m = rig.tick();
        EXPECT_LT(glm::distance(m.tip_m, before_m), 5.1e-4) << "no jump";
        before_m = m.tip_m;
    }
    EXPECT_TRUE(rig.tick().driven);
    EXPECT_EQ(rig.tick().servo.fault, Fault::none);
}

}  // namespace calot::haptics

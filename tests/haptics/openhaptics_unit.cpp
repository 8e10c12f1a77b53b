// The OpenHaptics adapter against a stand-in for its library: what it is told, errors, unplugging.
#include <gtest/gtest.h>

#include <dlfcn.h>

#include <atomic>
#include <cmath>
#include <thread>

#include "calot/haptics/choose.h"
#include "calot/haptics/hd_api.h"
#include "calot/haptics/openhaptics.h"
#include "rig.h"
#include "stand_in_hd.h"
#include "support/paths.h"

namespace calot::haptics {

namespace {

/// The stand-in's controls, from the library that the adapter loads.
class StandIn {
  public:
    StandIn() {
        void* library = dlopen(CALOT_STAND_IN_HD, RTLD_NOW | RTLD_LOCAL);
        if (library == nullptr) throw std::runtime_error(dlerror());
        auto find = [&](const char* name, auto& function) {
            function = reinterpret_cast<std::decay_t<decltype(function)>>(dlsym(library, name));
            if (function == nullptr) throw std::runtime_error(name);
        };
        find("stand_in_reset", reset);
        find("stand_in_record", record_);
        find("stand_in_set_stylus", set_stylus);
        find("stand_in_plug", plug);
        find("stand_in_fail_once", fail_once);
        find("stand_in_set_calibration", set_calibration);
        find("stand_in_use_thread", use_thread);
        find("stand_in_run", run);
        reset();
    }
    ~StandIn() { reset(); }

    StandInRecord record() const {
        StandInRecord record;
        record_(&record);
        return record;
    }
    void move(const Vec3& position_mm, int buttons = 0) const {
        const double axes[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
        set_stylus(&position_mm.x, axes, buttons);
    }

    decltype(&stand_in_reset) reset;
    decltype(&stand_in_set_stylus) set_stylus;
    decltype(&stand_in_plug) plug;
    decltype(&stand_in_fail_once) fail_once;
    decltype(&stand_in_set_calibration) set_calibration;
    decltype(&stand_in_use_thread) use_thread;
    decltype(&stand_in_run) run;

  private:
    decltype(&stand_in_record) record_;
};

/// Reads and writes a force in every frame.
struct Frames {
    OpenHapticsDevice& device;
    Vec3 force_N{0.0};
    DeviceSample sample{};
    Fault read = Fault::none, written = Fault::none;
    static void tick(void* self) {
        auto& frames = *static_cast<Frames*>(self);
        frames.read = frames.device.read(0.0, frames.sample);
        frames.written = frames.device.write(frames.force_N);
    }
};

OpenHapticsDevice make(const std::string& configuration = "") {
    return OpenHapticsDevice(configuration, CALOT_STAND_IN_HD);
}

}  // namespace

TEST(OpenHaptics, TellsWhatTheDeviceIs) {
    const StandIn stand_in;
    OpenHapticsDevice device = make("Left Device");
    ASSERT_EQ(device.open(), "");
    EXPECT_STREQ(stand_in.record().configuration, "Left Device");
    EXPECT_EQ(stand_in.record().forces_enabled, 1);
    EXPECT_EQ(device.info().model, "Stand-in (0001)");
    EXPECT_EQ(device.info().max_force_N, 3.3);
    EXPECT_EQ(device.info().max_continuous_force_N, 0.88);
    EXPECT_NEAR(device.info().workspace_m.high.y, 0.205, 1e-12);
    device.close();
    EXPECT_EQ(stand_in.record().disabled, 1);
    EXPECT_EQ(stand_in.record().misuse, 0);
}

TEST(OpenHaptics, ExchangesPoseAndForceOnceAFrame) {
    const StandIn stand_in;
    OpenHapticsDevice device = make();
    ASSERT_EQ(device.open(), "");
    EXPECT_STREQ(stand_in.record().configuration, "(default)");
    // The stylus points down: its z axis, from tip to hand, is up (y).
    const double position_mm[3] = {10, -20, 30}, axes[9] = {1, 0, 0, 0, 0, -1, 0, 1, 0};
    stand_in.set_stylus(position_mm, axes, 2);
    Frames frames{device, Vec3(0.1, -0.2, 0.3)};
    ASSERT_TRUE(device.start_clock(Frames::tick, &frames));
    EXPECT_EQ(stand_in.run(5), 5);
    EXPECT_EQ(frames.read, Fault::none);
    EXPECT_NEAR(glm::distance(frames.sample.position_m, Vec3(0.01, -0.02, 0.03)), 0.0, 1e-12);
    EXPECT_NEAR(glm::distance(frames.sample.orientation * Vec3(0, 0, 1), Vec3(0, -1, 0)), 0.0, 1e-12);
    EXPECT_EQ(frames.sample.buttons, 2u);
    StandInRecord record = stand_in.record();
    EXPECT_EQ(record.frames, 5);
    EXPECT_EQ(record.force_N[1], -0.2);
    EXPECT_EQ(record.scheduler_running, 1);
    device.close();
    record = stand_in.record();
    EXPECT_EQ(record.scheduler_running, 0);
    EXPECT_EQ(record.callbacks, 0);
    EXPECT_EQ(record.force_N[1], 0.0);
    EXPECT_EQ(record.device_open, 0);
    EXPECT_EQ(record.misuse, 0);
}

TEST(OpenHaptics, NamesWhyItCannotOpen) {
    const StandIn stand_in;
    stand_in.plug(0);
    OpenHapticsDevice device = make();
    const std::string why = device.open();
    EXPECT_NE(why.find("Device fault"), std::string::npos) << why;
    EXPECT_NE(why.find("0x0300"), std::string::npos) << why;
    stand_in.plug(1);
    EXPECT_EQ(device.open(), "");
}

TEST(OpenHaptics, TurnsErrorsIntoFaults) {
    const StandIn stand_in;
    OpenHapticsDevice device = make();
    ASSERT_EQ(device.open(), "");
    Frames frames{device};
    device.start_clock(Frames::tick, &frames);
    stand_in.run(1);
    ASSERT_EQ(frames.written, Fault::none);
    for (const auto& [code, fault] : {std::pair<unsigned, Fault>{0x0200, Fault::motors_warm},
                                      {0x0201, Fault::device_error},
                                      {0x0203, Fault::device_error},
                                      {0x0402, Fault::device_error}}) {
        stand_in.fail_once(code);
        stand_in.run(1);
        EXPECT_EQ(frames.written, fault) << code;
        stand_in.run(2);
        EXPECT_EQ(frames.written, Fault::none) << "and on it goes";
        EXPECT_EQ(frames.read, Fault::none);
    }
    for (const unsigned code : {0x0300u, 0x0302u, 0x0304u}) {
        stand_in.fail_once(code);
        stand_in.run(1);
        EXPECT_EQ(frames.written, Fault::disconnected) << code;
        stand_in.run(3);
        EXPECT_EQ(frames.read, Fault::disconnected) << "until it is opened again";
        ASSERT_EQ(device.open(), "");
        device.start_clock(Frames::tick, &frames);
        stand_in.run(1);
        EXPECT_EQ(frames.written, Fault::none);
    }
    EXPECT_EQ(stand_in.record().misuse, 0);
}

TEST(OpenHaptics, CalibratesAndHasNoForceBefore) {
    const StandIn stand_in;
    stand_in.set_calibration(0x5002);  // put the stylus into the inkwell
    OpenHapticsDevice device = make();
    ASSERT_EQ(device.open(), "");
    Frames frames{device};
    device.start_clock(Frames::tick, &frames);
    stand_in.run(250);
    EXPECT_EQ(frames.read, Fault::not_calibrated);
    EXPECT_EQ(stand_in.record().calibration_style, 0u) << "nothing to be done but by hand";
    stand_in.set_calibration(0x5001);
    stand_in.run(250);
    EXPECT_EQ(frames.read, Fault::none);
    EXPECT_EQ(stand_in.record().calibration_style, 2u);
}

TEST(OpenHaptics, SaysWhatIsMissing) {
    std::string why;
    // The stand-in is loaded already: a program holds one library.
    const StandIn stand_in;
    ASSERT_NE(hd::load(CALOT_STAND_IN_HD, why), nullptr);
    EXPECT_EQ(hd::load("/nowhere/libHD.so", why), nullptr);
    EXPECT_NE(why.find("is loaded already"), std::string::npos) << why;
    const auto devices = list_devices(CALOT_STAND_IN_HD);
    ASSERT_FALSE(devices.empty());
    EXPECT_EQ(devices[0].kind, "openhaptics");
    EXPECT_TRUE(devices[0].available);
    EXPECT_EQ(stand_in.record().device_open, 0) << "a look leaves nothing open";
}

// The whole way with real threads: the library's scheduler runs the servo, a keeper opens, the cable is pulled in
// mid-run and put back. Nothing here looks at a clock but to give up.
TEST(OpenHaptics, SurvivesTheCableInMidRun) {
    const StandIn stand_in;
    stand_in.use_thread(1);
    SessionOptions options = rig_options();
    options.threads = true;
    options.retry_s = 0.01;
    Session session(std::make_unique<OpenHapticsDevice>("", CALOT_STAND_IN_HD), options);
    session.start();
    tissue::Input input;
    input.hook = instruments::pose_through_trocar(kTrocar_m, Vec3(0.0), 0.0);
    tissue::State state;
    state.hook_force_N = Vec3(0.0, 0.0, 0.2);  // something always pushes up
    double down_mm = 0.0;
    auto run_until = [&](auto done) {
        for (int k = 0; k < 10000; ++k) {
            // The hand goes down: it has to give energy before it can get a force.
            down_mm = std::fmod(down_mm + 0.02, 40.0);
            stand_in.move(Vec3(0.0, 20.0 - down_mm, 0.0));
            const bool held = session.drive(input);
            session.feel(state);
            if (done(held)) return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        return false;
    };
    for (int round = 1; round <= 2; ++round) {
        ASSERT_TRUE(run_until([&](bool held) { return held && stand_in.record().force_N[1] > 0.05; })) << round;
        EXPECT_EQ(session.status().connections, round);
        stand_in.plug(0);
        ASSERT_TRUE(run_until([&](bool held) { return !held && !session.status().open; })) << round;
        EXPECT_EQ(stand_in.record().force_N[1], 0.0);
        stand_in.plug(1);
    }
    session.stop();
    const StandInRecord record = stand_in.record();
    EXPECT_EQ(record.misuse, 0);
    EXPECT_EQ(record.device_open, 0);
    EXPECT_EQ(record.callbacks, 0);
    EXPECT_LE(record.most_force_N, 3.3);
    EXPECT_GE(session.status().servo.faults[static_cast<std::size_t>(Fault::disconnected)], 2);
}

}  // namespace calot::haptics

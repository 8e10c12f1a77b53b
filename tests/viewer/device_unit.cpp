// A haptic device in a session's right hand.

#include <gtest/gtest.h>

#include "calot/haptics/simulated.h"
#include "calot/viewer/session_core.h"
#include "viewer/small_scene.h"

namespace calot::viewer {
namespace {

TEST(Device, HasTheHookWhileItIsThereAndLeavesItWhereItIs) {
    SessionCore core(test::small_run(), {});
    haptics::SessionOptions options;
    options.threads = false;
    options.mapping.trocar_m = core.theatre().right.port_m;
    options.hook = core.run().setup().hook;
    auto simulated = std::make_unique<haptics::SimulatedDevice>(
        std::vector<haptics::HandKey>{{0.0, Vec3(0.0)}, {0.1, Vec3(2e-3, 0.0, 0.0), 1u}, {9.0, Vec3(2e-3, 0.0, 0.0)}});
    haptics::SimulatedDevice& cable = *simulated;
    const auto device = std::make_shared<haptics::Session>(std::move(simulated), options);
    core.hold(device);
    device->keep();

    Controls controls;
    controls.right = core.theatre().right_start;
    controls.left = core.theatre().left_start;
    double now_s = 1.0;
    Snapshot snapshot;
    auto tick = [&](int times) {
        for (int k = 0; k < times; ++k) {
            device->servo_step(now_s += 1e-3);
            ASSERT_TRUE(core.tick(controls));
        }
        core.fill(snapshot);
    };
    tick(300);
    const Vec3 start_m = core.theatre().right_start.tip_m;
    EXPECT_NEAR(snapshot.tip_m.x, start_m.x + 2e-3, 1e-4) << "the hand moved by 2 mm to the right";
    EXPECT_EQ(snapshot.input.hook.position_m, snapshot.tip_m);
    EXPECT_TRUE(snapshot.input.pedal) << "its first button is a yellow pedal";
    EXPECT_EQ(snapshot.input.mode, tissue::GeneratorMode::cut);
    EXPECT_EQ(snapshot.input.power_setting_W, controls.cut_W);

    // Unplugged: the controls have it again, and go there from where the device left it.
    cable.plug(false);
    tick(1);
    EXPECT_NEAR(snapshot.tip_m.x, start_m.x + 2e-3, 2e-4);
    EXPECT_FALSE(snapshot.input.pedal);
    tick(500);
    EXPECT_NEAR(snapshot.tip_m.x, start_m.x, 1e-4);
}

}  // namespace
}  // namespace calot::viewer

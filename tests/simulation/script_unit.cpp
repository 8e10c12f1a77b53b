#include "calot/simulation/script.h"

#include <gtest/gtest.h>

namespace calot::simulation {

namespace {
Script example() {
    return Script(Vec3(0.03, -0.05, 0.15),
                  {{0.0, Vec3(0.0, 0.0, 0.02), 0.0},
                   {1.0, Vec3(0.0, 0.0, 0.0), 0.5},
                   {2.0, Vec3(0.0, 0.0, 0.0), 0.5},
                   {4.0, Vec3(0.01, 0.0, 0.01), 0.0}},
                  {{1.2, 1.5, 35.0, tissue::GeneratorMode::cut}, {0.4, 0.5, 20.0, tissue::GeneratorMode::coag}});
}
}  // namespace

TEST(Script, PassesThroughKeyframesAndStaysBetweenThem) {
    const Script script = example();
    for (const Keyframe& key : script.keyframes())
        EXPECT_LT(glm::length(script.at(key.time_s).hook.position_m - key.tip_m), 1e-12);
    for (double t = 0.0; t < 1.0; t += 0.01) {
        const double z = script.at(t).hook.position_m.z;
        EXPECT_LE(z, 0.02 + 1e-12);
        EXPECT_GE(z, -1e-12);
    }
    // Two equal keyframes: the hand holds still.
    for (double t = 1.0; t < 2.0; t += 0.01) EXPECT_LT(glm::length(script.at(t).hook.position_m), 1e-12);
    // Before and after the script it stays.
    EXPECT_EQ(script.at(-1.0).hook.position_m, script.at(0.0).hook.position_m);
    EXPECT_EQ(script.at(9.0).hook.position_m, script.at(4.0).hook.position_m);
}

TEST(Script, VelocityIsContinuous) {
    const Script script = example();
    const double h = 1e-5;
    for (double t : {1.0, 2.0}) {
        const Vec3 before = (script.at(t).hook.position_m - script.at(t - h).hook.position_m) / h;
        const Vec3 after = (script.at(t + h).hook.position_m - script.at(t).hook.position_m) / h;
        EXPECT_LT(glm::length(before - after), 1e-5);
    }
}

TEST(Script, PedalFollowsBursts) {
    const Script script = example();
    EXPECT_FALSE(script.at(1.1).pedal);
    EXPECT_TRUE(script.at(1.2).pedal);
    EXPECT_EQ(script.at(1.3).power_setting_W, 35.0);
    EXPECT_FALSE(script.at(1.5).pedal);
    EXPECT_EQ(script.at(0.45).mode, tissue::GeneratorMode::coag);
}

}  // namespace calot::simulation

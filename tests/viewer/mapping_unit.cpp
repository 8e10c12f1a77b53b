// Devices to what the hands want.

#include "calot/viewer/mapping.h"

#include <gtest/gtest.h>

#include "calot/viewer/lens.h"
#include "viewer/small_scene.h"

namespace calot::viewer {
namespace {

class Hands : public ::testing::Test {
  protected:
    Hands() : run(test::small_run()), theatre(theatre_of(run->setup())), mapping(theatre), scope(run->setup().camera) {}
    void apply(const Devices& devices, double dt_s = 1.0 / 60.0) { mapping.apply(devices, dt_s, scope); }

    std::unique_ptr<simulation::Simulation> run;
    Theatre theatre;
    Mapping mapping;
    Scope scope;
};

TEST_F(Hands, nothing_touched_nothing_moves) {
    apply({});
    EXPECT_EQ(mapping.controls().right.tip_m, theatre.right_start.tip_m);
    EXPECT_EQ(mapping.controls().left.tip_m, theatre.left_start.tip_m);
    EXPECT_FALSE(mapping.controls().yellow || mapping.controls().blue);
}

TEST_F(Hands, shift_gives_the_mouse_to_the_left_hand) {
    Devices devices;
    devices.mouse_right = 0.1;
    devices.hold(Action::left_hand, true);
    apply(devices);
    EXPECT_EQ(mapping.controls().right.tip_m, theatre.right_start.tip_m);
    EXPECT_GT(mapping.controls().left.tip_m.x, theatre.left_start.tip_m.x);
    EXPECT_TRUE(mapping.left_active());
}

TEST_F(Hands, sticks_have_a_dead_zone_and_a_speed) {
    Devices devices;
    devices.pad.hook_right = 0.1;  // a stick that does not come back to its middle
    apply(devices);
    EXPECT_EQ(mapping.controls().right.tip_m, theatre.right_start.tip_m);
    devices.pad.hook_right = 1.0;
    apply(devices, 0.1);
    const double once = glm::distance(mapping.controls().right.tip_m, theatre.right_start.tip_m);
    for (int k = 0; k < 10; ++k) apply(devices, 0.01);
    const double twice = glm::distance(mapping.controls().right.tip_m, theatre.right_start.tip_m);
    EXPECT_GT(once, 1e-4);
    EXPECT_NEAR(twice, 2.0 * once, 0.1 * once);  // the time counts, not the number of samples
}

TEST_F(Hands, shoulder_turns_a_stick_into_depth_and_roll) {
    Devices devices;
    devices.pad.hook_depth = true;
    devices.pad.hook_up = 1.0;
    devices.pad.hook_right = 1.0;
    apply(devices, 0.1);
    const HandTarget& right = mapping.controls().right;
    EXPECT_GT(glm::distance(right.tip_m, theatre.right.port_m),
              glm::distance(theatre.right_start.tip_m, theatre.right.port_m) + 1e-3);
    EXPECT_GT(right.roll_rad, theatre.right_start.roll_rad + 0.1);
}

TEST_F(Hands, wheel_can_be_turned_round) {
    Devices devices;
    devices.wheel = 1.0;
    auto depth = [&] { return glm::distance(mapping.controls().right.tip_m, theatre.right.port_m); };
    const double before = depth();
    apply(devices);
    EXPECT_GT(depth(), before);
    mapping.sensitivity().invert_wheel = true;
    apply(devices);
    apply(devices);
    EXPECT_LT(depth(), before);
}

TEST_F(Hands, jaws_close_and_open_again) {
    Devices devices;
    devices.grasp_toggled = true;
    apply(devices);
    EXPECT_TRUE(mapping.controls().left.closed);
    apply({});
    EXPECT_TRUE(mapping.controls().left.closed);
    apply(devices);
    EXPECT_FALSE(mapping.controls().left.closed);
}

TEST(Lens, fogs_where_it_boils_smears_close_by_and_is_wiped) {
    Figures figures;
    figures.tip_m = Vec3(0.0);
    figures.boiling_kg_per_s = 2e-5;
    LensState far, near;
    for (int k = 0; k < 1200; ++k) {
        far.advance(figures, Vec3(0.0, 0.0, 0.06), 1.0 / 60.0);
        near.advance(figures, Vec3(0.0, 0.0, 0.015), 1.0 / 60.0);
    }
    EXPECT_GT(near.look().fog, far.look().fog);
    EXPECT_GT(near.look().smear, far.look().smear);
    EXPECT_GT(near.look().smear, 0.05f);
    EXPECT_LE(near.look().fog, 0.9f);
    near.wipe();
    figures.boiling_kg_per_s = 0.0;
    for (int k = 0; k < 30; ++k) near.advance(figures, Vec3(0.0, 0.0, 0.015), 1.0 / 60.0);
    EXPECT_LT(near.look().fog, 0.05f);
    EXPECT_LT(near.look().smear, 0.05f);
}

}  // namespace
}  // namespace calot::viewer

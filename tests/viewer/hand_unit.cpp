// The instrument in the hand: through its port always, where the hand wants it, behind the hand under load.

#include "calot/viewer/hand.h"

#include <gtest/gtest.h>

#include <cmath>

namespace calot::viewer {
namespace {

const Reach kReach{Vec3(0.08, 0.04, 0.13), Vec3(0.0)};

double distance_to_line(const Vec3& point, const Vec3& at, const Vec3& direction) {
    const Vec3 d = glm::normalize(direction);
    return glm::length((point - at) - glm::dot(point - at, d) * d);
}

TEST(Hand, shaft_passes_through_the_port_wherever_the_tip_goes) {
    const instruments::HookShape shape;
    HeldInstrument held(HandTarget{Vec3(0.0, 0.0, 0.02), 0.0, false});
    HandTarget target{Vec3(-0.03, 0.02, 0.01), 1.1, false};
    for (int tick = 0; tick < 400; ++tick) {
        held.advance(target, Vec3(0.0), 1e-3);
        const tissue::Pose pose = held.pose(kReach.port_m, shape);
        const Vec3 shaft = pose.orientation * Vec3(0.0, 0.0, -1.0);
        const Vec3 bend = pose.position_m + pose.orientation * Vec3(-0.5 * shape.foot_length_m, 0.0, 0.0);
        EXPECT_LT(distance_to_line(kReach.port_m, bend, shaft), 1e-9);
    }
    EXPECT_LT(glm::distance(held.tip_m(), target.tip_m), 1e-4);
    EXPECT_NEAR(held.roll_rad(), target.roll_rad, 1e-3);
}

TEST(Hand, moves_smoothly_and_not_faster_than_a_hand) {
    HeldInstrument held(HandTarget{Vec3(0.0), 0.0, false});
    const HandTarget target{Vec3(0.05, 0.0, 0.0), 0.0, false};  // a jump of 5 cm from one sample to the next
    Vec3 before = held.tip_m();
    double fastest = 0.0, overshoot = 0.0;
    for (int tick = 0; tick < 600; ++tick) {
        held.advance(target, Vec3(0.0), 1e-3);
        fastest = std::fmax(fastest, glm::length(held.tip_m() - before) / 1e-3);
        overshoot = std::fmax(overshoot, held.tip_m().x - 0.05);
        before = held.tip_m();
    }
    EXPECT_LE(fastest, 0.3501);
    EXPECT_LT(overshoot, 1e-3);
    EXPECT_NEAR(held.tip_m().x, 0.05, 1e-4);
}

TEST(Hand, stays_behind_where_something_pushes_back) {
    // A wall of 3 N/mm at x = 0; the hand wants to be 20 mm inside.
    HeldInstrument held(HandTarget{Vec3(-0.01, 0.0, 0.0), 0.0, false});
    const HandTarget target{Vec3(0.02, 0.0, 0.0), 0.0, false};
    Vec3 force(0.0);
    for (int tick = 0; tick < 1000; ++tick) {
        held.advance(target, force, 1e-3);
        force = Vec3(-3000.0 * std::fmax(0.0, held.tip_m().x), 0.0, 0.0);
    }
    EXPECT_GT(held.tip_m().x, 0.0);
    EXPECT_LT(held.tip_m().x, 0.004);  // 500 / 3500 of the way
}

TEST(Hand, reach_is_kept) {
    EXPECT_LE(glm::length(within_reach(Vec3(1.0, 0.0, 0.0), kReach) - kReach.centre_m), kReach.radius_m + 1e-12);
    const Reach tight{Vec3(0.0, 0.0, 0.05), Vec3(0.0)};
    const Vec3 tip = within_reach(Vec3(0.0, 0.0, 0.045), tight);
    EXPECT_GE(glm::distance(tip, tight.port_m), tight.least_depth_m - 1e-12);
    EXPECT_LT(tip.z, 0.05);  // into the patient, not out through the port
    const Vec3 inside(0.01, 0.02, 0.03);
    EXPECT_EQ(within_reach(inside, kReach), inside);
}

TEST(Hand, tip_moves_in_the_plane_of_the_view) {
    render::Camera camera;
    camera.eye_m = Vec3(0.0, -0.05, 0.07);
    camera.target_m = Vec3(0.0);
    const Vec3 axis = glm::normalize(camera.target_m - camera.eye_m);
    const Vec3 start(0.0, 0.0, 0.01);
    const Vec3 right = moved_in_view(start, camera, kReach, 0.1, 0.0, 0.0) - start;
    const Vec3 up = moved_in_view(start, camera, kReach, 0.0, 0.1, 0.0) - start;
    EXPECT_NEAR(glm::dot(right, axis), 0.0, 1e-12);
    EXPECT_NEAR(glm::dot(up, axis), 0.0, 1e-12);
    EXPECT_GT(right.x, 0.003);
    EXPECT_NEAR(right.y, 0.0, 1e-12);
    EXPECT_GT(up.y, 0.0);
    EXPECT_NEAR(glm::length(right), glm::length(up), 1e-12);
    const Vec3 deeper = moved_in_view(start, camera, kReach, 0.0, 0.0, 0.002) - start;
    EXPECT_NEAR(glm::length(deeper), 0.002, 1e-12);
    EXPECT_NEAR(glm::dot(deeper, glm::normalize(start - kReach.port_m)), 0.002, 1e-12);
}

}  // namespace
}  // namespace calot::viewer

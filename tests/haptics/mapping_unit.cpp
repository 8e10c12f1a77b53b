// From the device's workspace to the instrument and back: directions, lever, clutch, roll, reach.
#include <gtest/gtest.h>

#include <cmath>

#include "calot/haptics/coupling.h"
#include "calot/haptics/mapping.h"

namespace calot::haptics {

namespace {

const Vec3 kTrocar_m(0.01, -0.08, 0.14);

MappingParameters parameters(Lever lever, double scale = 1.0) {
    MappingParameters p;
    p.lever = lever;
    p.scale = scale;
    p.trocar_m = kTrocar_m;
    p.device_to_world = device_to_world(Vec3(0.02, -0.05, 0.1), Vec3(0.0), Vec3(0.0, 1.0, 0.2));
    return p;
}

DeviceSample at(const Vec3& position_m) {
    DeviceSample sample;
    sample.position_m = position_m;
    return sample;
}

}  // namespace

TEST(Mapping, RightUpAndTowardsMeAreThoseOfThePicture) {
    const Mat3 turn = device_to_world(Vec3(0.0, -0.1, 0.0), Vec3(0.0), Vec3(0.0, 0.0, 1.0));
    EXPECT_NEAR(glm::distance(turn * Vec3(1, 0, 0), Vec3(1, 0, 0)), 0.0, 1e-12);
    EXPECT_NEAR(glm::distance(turn * Vec3(0, 1, 0), Vec3(0, 0, 1)), 0.0, 1e-12);
    EXPECT_NEAR(glm::distance(turn * Vec3(0, 0, 1), Vec3(0, -1, 0)), 0.0, 1e-12);
}

// The derivative is that of the map: finite differences, for both levers and several places.
TEST(Mapping, DerivativeIsThatOfTheMap) {
    for (const Lever lever : {Lever::tip, Lever::handle})
        for (const double scale : {0.5, 1.0, 2.0}) {
            Mapping mapping(parameters(lever, scale));
            mapping.anchor(at(Vec3(0.01, 0.02, 0.0)), Vec3(0.005, -0.002, 0.003), 0.0);
            const Vec3 place(0.02, 0.015, -0.01);
            mapping.follow(at(place));
            const Mat3 derivative = mapping.derivative();
            for (int axis = 0; axis < 3; ++axis) {
                constexpr double kStep_m = 1e-6;
                Vec3 step(0.0);
                step[axis] = kStep_m;
                mapping.follow(at(place + step));
                const Vec3 plus = mapping.tip_m();
                mapping.follow(at(place - step));
                const Vec3 difference = (plus - mapping.tip_m()) / (2.0 * kStep_m);
                EXPECT_NEAR(glm::distance(difference, derivative[axis]), 0.0, 1e-6);
            }
        }
}

// As through a real abdominal wall: the handle to the right brings the tip to the left, pushed in the tip goes in.
TEST(Mapping, TheHandleMovesMirroredAboutTheTrocar) {
    MappingParameters p = parameters(Lever::handle);
    p.device_to_world = Mat3(1.0);
    Mapping mapping(p);
    const Vec3 tip_m(0.0);
    mapping.anchor(at(Vec3(0.0)), tip_m, 0.0);
    EXPECT_NEAR(glm::distance(mapping.tip_m(), tip_m), 0.0, 1e-12);
    mapping.follow(at(Vec3(0.01, 0.0, 0.0)));
    const double inside_m = glm::distance(tip_m, kTrocar_m);
    EXPECT_NEAR(mapping.tip_m().x, -0.01 * inside_m / (p.instrument_length_m - inside_m), 5e-4);
    const Vec3 in = glm::normalize(tip_m - kTrocar_m);
    mapping.follow(at(0.01 * in));
    EXPECT_NEAR(glm::distance(mapping.tip_m(), tip_m + 0.01 * in), 0.0, 1e-9);
}

// Virtual work: a force at the tip does the same work at the hand, but for the scale of movement.
TEST(Mapping, ForcesComeBackByTheSameLever) {
    for (const Lever lever : {Lever::tip, Lever::handle}) {
        Mapping mapping(parameters(lever, 0.5));
        mapping.anchor(at(Vec3(0.0)), Vec3(0.0, 0.004, 0.0), 0.0);
        mapping.follow(at(Vec3(0.01, -0.005, 0.003)));
        const Vec3 force_N(0.1, -0.2, 0.3), moved_m(1e-3, 2e-3, -1e-3);
        const double at_tip_J = glm::dot(force_N, mapping.derivative() * moved_m);
        EXPECT_NEAR(0.5 * glm::dot(mapping.force_to_device() * force_N, moved_m), at_tip_J, 1e-12);
        if (lever == Lever::tip) {
            EXPECT_NEAR(glm::length(mapping.force_to_device() * force_N), glm::length(force_N), 1e-12)
                << "true newtons";
        }
    }
}

TEST(Mapping, StaysWithinReach) {
    for (const Lever lever : {Lever::tip, Lever::handle}) {
        const MappingParameters p = parameters(lever);
        Mapping mapping(p);
        mapping.anchor(at(Vec3(0.0)), Vec3(0.0), 0.0);
        for (double x = -0.5; x <= 0.5; x += 0.02)
            for (double y = -0.5; y <= 0.5; y += 0.02) {
                mapping.follow(at(Vec3(x, y, 0.3 * x)));
                const double depth_m = glm::distance(mapping.tip_m(), p.trocar_m);
                ASSERT_GE(depth_m, p.least_depth_m - 1e-9);
                ASSERT_LE(depth_m, p.instrument_length_m - p.least_handle_m + 1e-9);
            }
    }
}

TEST(Mapping, RollFollowsTheStylusAboutItsOwnAxis) {
    Mapping mapping(parameters(Lever::tip));
    DeviceSample sample;
    const Quat tilt = glm::angleAxis(0.6, glm::normalize(Vec3(1.0, 0.3, 0.0)));
    sample.orientation = tilt;
    mapping.anchor(sample, Vec3(0.0), 0.2);
    for (int k = 1; k <= 100; ++k) {
        sample.orientation = tilt * glm::angleAxis(0.05 * k, Vec3(0.0, 0.0, 1.0));
        if (k % 2 == 0) sample.orientation = -sample.orientation;  // the same turn
        mapping.follow(sample);
    }
    EXPECT_NEAR(mapping.roll_rad(), 0.2 + 5.0, 1e-9);
}

TEST(Mapping, RollOfAPoseGivesThePoseAgain) {
    const instruments::HookShape hook;
    for (double roll = -3.0; roll < 3.1; roll += 0.5) {
        const Vec3 tip_m(0.01, 0.02, -0.004);
        const tissue::Pose pose = instruments::pose_through_trocar(kTrocar_m, tip_m, roll, hook);
        const tissue::Pose again =
            instruments::pose_through_trocar(kTrocar_m, tip_m, roll_of(kTrocar_m, pose, hook), hook);
        EXPECT_NEAR(std::abs(glm::dot(pose.orientation, again.orientation)), 1.0, 1e-12);
    }
}

// While the clutch is held, the hand goes home and the instrument stays; there is no force, and no jump afterwards.
TEST(Coupling, TheClutchLetsTheHandMoveAlone) {
    const instruments::HookShape hook;
    Coupling coupling({}, parameters(Lever::tip), hook);
    coupling.place(instruments::pose_through_trocar(kTrocar_m, Vec3(0.0), 0.5, hook));
    HandMessage hand;
    hand.present = true;
    auto tick = [&](bool clutch) { return coupling.advance(hand, clutch, Vec3(0.0), 1e-3).position_m; };
    tick(false);
    for (int k = 0; k < 200; ++k) hand.sample.position_m.x += 1e-4, tick(false);
    for (int k = 0; k < 100; ++k) tick(false);
    const Vec3 before_m = tick(false);
    EXPECT_NEAR(glm::length(before_m), 0.02, 1e-5);
    EXPECT_TRUE(coupling.message(hand).engaged);
    for (int k = 0; k < 300; ++k) {
        hand.sample.position_m.x -= 1e-4;
        EXPECT_EQ(tick(true), before_m);
        EXPECT_FALSE(coupling.message(hand).engaged);
    }
    EXPECT_NEAR(glm::distance(tick(false), before_m), 0.0, 1e-9);
    EXPECT_NEAR(glm::distance(coupling.message(hand).position_m, hand.sample.position_m), 0.0, 1e-9);
}

// In free movement at constant speed nothing drags.
TEST(Coupling, FreeMovementIsFree) {
    const instruments::HookShape hook;
    Coupling coupling({}, parameters(Lever::tip), hook);
    coupling.place(instruments::pose_through_trocar(kTrocar_m, Vec3(0.0), 0.0, hook));
    HandMessage hand;
    hand.present = true;
    hand.sample.velocity_m_per_s = Vec3(0.1, 0.0, 0.0);
    for (int k = 0; k < 300; ++k) {
        hand.sample.position_m.x += 1e-4;
        coupling.advance(hand, false, Vec3(0.0), 1e-3);
    }
    const ToolMessage tool = coupling.message(hand);
    const Vec3 force_N = tool.stiffness_N_per_m * (tool.position_m - hand.sample.position_m) +
                         tool.damping_N_s_per_m * (tool.velocity_m_per_s - hand.sample.velocity_m_per_s);
    EXPECT_LT(glm::length(force_N), 1e-3);
}

}  // namespace calot::haptics

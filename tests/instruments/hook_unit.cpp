#include "calot/instruments/hook.h"

#include <gtest/gtest.h>

#include <cmath>

#include "calot/base/random.h"

namespace calot::instruments {

namespace {

constexpr double kRounding_m = 1e-12;  // double precision over a third of a metre

Vec3 random_vec(Random& random, double size) {
    return Vec3(random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size));
}

double distance_to_line(const Vec3& p, const Vec3& a, const Vec3& b) {
    return glm::length(glm::cross(p - a, glm::normalize(b - a)));
}

}  // namespace

TEST(Hook, ShaftPassesThroughTheTrocarWhateverTheRoll) {
    Random random(1);
    const HookShape shape;
    std::vector<tissue::Capsule> capsules;
    for (int k = 0; k < 200; ++k) {
        const Vec3 trocar_m(0.0, -0.08, 0.14), tip_m = random_vec(random, 0.03);
        const tissue::Pose pose = pose_through_trocar(trocar_m, tip_m, random.uniform(-7, 7));
        place_hook(shape, pose, pose, 1e-3, capsules);
        ASSERT_EQ(capsules.size(), 4u);
        const tissue::Capsule& shaft = capsules.back();
        EXPECT_LT(distance_to_line(trocar_m, shaft.a_m, shaft.b_m), kRounding_m);
        EXPECT_GT(glm::dot(trocar_m - shaft.a_m, shaft.b_m - shaft.a_m), 0.0) << "the shaft runs towards the trocar";
        EXPECT_LT(glm::length(0.5 * (capsules[0].a_m + capsules[0].b_m) - tip_m), kRounding_m) << "middle of the foot";
    }
}

TEST(Hook, RollTurnsTheFoot) {
    const Vec3 trocar_m(0.0, 0.0, 0.15), tip_m(0.0);
    const HookShape shape;
    const double sine = 0.5 * shape.foot_length_m / 0.15;
    auto foot = [&](double roll) { return pose_through_trocar(trocar_m, tip_m, roll).orientation * Vec3(1, 0, 0); };
    // At roll 0 down, but for the tilt that brings the shaft's axis back to the trocar; a quarter turn about -z later
    // to -x.
    EXPECT_LT(glm::length(foot(0.0) - Vec3(0.0, -std::sqrt(1 - sine * sine), -sine)), 1e-12);
    EXPECT_LT(glm::length(foot(1.5707963267948966) - Vec3(-std::sqrt(1 - sine * sine), 0.0, -sine)), 1e-12);
}

TEST(Hook, IsAnLOfTheGivenDimensions) {
    const HookShape shape;
    tissue::Pose pose;  // the instrument's own frame
    std::vector<tissue::Capsule> c;
    place_hook(shape, pose, pose, 1e-3, c);
    ASSERT_EQ(c.size(), 4u);
    EXPECT_EQ(c[0].a_m, Vec3(-2.5e-3, 0, 0));
    EXPECT_EQ(c[0].b_m, Vec3(2.5e-3, 0, 0));
    EXPECT_EQ(c[1].a_m, c[0].a_m);
    EXPECT_EQ(c[2].a_m, c[1].b_m);
    EXPECT_NEAR(glm::length(c[1].b_m - c[1].a_m) + glm::length(c[2].b_m - c[2].a_m), shape.heel_length_m, kRounding_m);
    EXPECT_TRUE(c[0].bare && c[1].bare && !c[2].bare && !c[3].bare);
    EXPECT_NEAR(c[3].a_m.z + c[3].radius_m, -shape.heel_length_m, kRounding_m)
        << "rounded end flush with the heel's top";
    EXPECT_EQ(c[3].radius_m, 2.5e-3);
}

TEST(Hook, VelocitiesAreTheChangeOfPose) {
    Random random(2);
    const HookShape shape;
    const Vec3 trocar_m(0, -0.08, 0.14);
    const double dt_s = 1e-3;
    std::vector<tissue::Capsule> before, after;
    for (int k = 0; k < 20; ++k) {
        const tissue::Pose p = pose_through_trocar(trocar_m, random_vec(random, 0.02), random.uniform(-1, 1));
        const tissue::Pose q = pose_through_trocar(trocar_m, random_vec(random, 0.02), random.uniform(-1, 1));
        place_hook(shape, p, p, dt_s, before);
        for (const tissue::Capsule& c : before) EXPECT_EQ(c.velocity_a_m_per_s, Vec3(0.0));
        place_hook(shape, q, p, dt_s, after);
        for (std::size_t n = 0; n < after.size(); ++n) {
            EXPECT_LT(glm::length(before[n].a_m + dt_s * after[n].velocity_a_m_per_s - after[n].a_m), kRounding_m);
            EXPECT_LT(glm::length(before[n].b_m + dt_s * after[n].velocity_b_m_per_s - after[n].b_m), kRounding_m);
        }
    }
}

TEST(Hook, DoesNotAllocateOnceReserved) {
    std::vector<tissue::Capsule> capsules;
    capsules.reserve(8);
    const auto* data = capsules.data();
    for (int k = 0; k < 3; ++k) place_hook({}, {}, {}, 1e-3, capsules);
    EXPECT_EQ(capsules.data(), data);
}

}  // namespace calot::instruments

// The grasper's shape and place.
#include "calot/instruments/grasper.h"

#include <gtest/gtest.h>

#include <cmath>

#include "calot/instruments/hook.h"

namespace calot::instruments {

namespace {

constexpr double kRounding_m = 1e-12;

tissue::GrasperInput at(const Vec3& tip_m, double jaw) {
    return {true, grasper_pose_through_trocar(Vec3(-0.08, 0.02, 0.12), tip_m, 0.7), jaw};
}

}  // namespace

TEST(Grasper, JawsOpenSymmetricallyAboutTheLineFromTheTrocar) {
    const GrasperShape shape;
    const Vec3 tip_m(0.003, -0.002, 0.001), along = glm::normalize(tip_m - Vec3(-0.08, 0.02, 0.12));
    for (const double jaw : {0.0, 0.5, 1.0}) {
        std::vector<tissue::Capsule> capsules;
        place_grasper(shape, at(tip_m, jaw), at(tip_m, jaw), false, 1e-3, capsules);
        ASSERT_EQ(capsules.size(), 3u);
        const Vec3 apart = capsules[0].b_m - capsules[1].b_m, middle = 0.5 * (capsules[0].b_m + capsules[1].b_m);
        const double angle = 0.5 * shape.opening_rad * jaw;
        EXPECT_NEAR(glm::length(apart), shape.jaw_diameter_m + 2.0 * shape.jaw_length_m * std::sin(angle), kRounding_m);
        EXPECT_NEAR(glm::dot(apart, along), 0.0, kRounding_m);
        EXPECT_LT(glm::length(middle - tip_m + shape.jaw_length_m * (1.0 - std::cos(angle)) * along), kRounding_m);
        EXPECT_LT(glm::length(glm::cross(capsules[2].b_m - capsules[2].a_m, along)), kRounding_m);
        for (const tissue::Capsule& capsule : capsules) {
            EXPECT_EQ(capsule.instrument, tissue::Instrument::grasper);
            EXPECT_FALSE(capsule.bare);
            EXPECT_TRUE(capsule.solid);
            EXPECT_EQ(capsule.velocity_a_m_per_s, Vec3(0.0));
        }
    }
}

TEST(Grasper, ComesBesideTheHookAndMovesWithItsHand) {
    std::vector<tissue::Capsule> capsules;
    capsules.reserve(8);
    const auto* data = capsules.data();
    place_hook({}, {}, {}, 1e-3, capsules);
    const std::size_t hook = capsules.size();
    const tissue::GrasperInput before = at(Vec3(0.0), 0.2);
    tissue::GrasperInput now = before;
    now.pose.position_m += Vec3(1e-4, 0.0, 0.0);
    place_grasper({}, now, before, true, 1e-3, capsules);
    ASSERT_EQ(capsules.size(), hook + 3);
    EXPECT_EQ(capsules.data(), data);
    EXPECT_FALSE(capsules[hook].solid) << "jaws that hold do not collide";
    EXPECT_TRUE(capsules[hook + 2].solid);
    for (std::size_t k = hook; k < capsules.size(); ++k)
        EXPECT_LT(glm::length(capsules[k].velocity_a_m_per_s - Vec3(0.1, 0.0, 0.0)), 1e-9);

    now.present = false;
    capsules.clear();
    place_grasper({}, now, before, false, 1e-3, capsules);
    EXPECT_TRUE(capsules.empty());
    // One that comes into the field does not come flying from where it was never seen.
    now.present = true;
    tissue::GrasperInput absent;
    place_grasper({}, now, absent, false, 1e-3, capsules);
    for (const tissue::Capsule& capsule : capsules) EXPECT_EQ(capsule.velocity_b_m_per_s, Vec3(0.0));
}

}  // namespace calot::instruments

// Contacts from geometry alone: gaps, normals, sides, wedges, organs.
#include "calot/instruments/contact.h"

#include <gtest/gtest.h>

#include <cmath>

#include "calot/anatomy/block.h"
#include "calot/anatomy/shapes.h"
#include "calot/tissue/sampling.h"

namespace calot::instruments {

namespace {

constexpr double kPoint_m = 3e-4, kWire_m = 5e-4, kDt_s = 1e-3;
const Vec3 kLeft(-1e-3, 0, 0), kRight(1e-3, 0, 0);

tissue::Capsule wire(const Vec3& a, const Vec3& b, const Vec3& velocity = Vec3(0.0)) {
    return {.a_m = a,
            .b_m = b,
            .radius_m = kWire_m,
            .bare = true,
            .velocity_a_m_per_s = velocity,
            .velocity_b_m_per_s = velocity};
}

tissue::NearHexel hexel_at(const Vec3& p, const Vec3& outward) {
    tissue::NearHexel hexel;
    hexel.world_m = Vec3f(p);
    hexel.outward = Vec3f(outward);
    return hexel;
}

struct Scene {
    tissue::Model model = tissue::sample(anatomy::make_block({.size_m = Vec3(0.0048)}), {});
    tissue::State state = tissue::State::make(model);
    tissue::Exchange exchange;
    Scene() { tissue::reserve_exchange(model, exchange); }
    void add(const Vec3& p, const Vec3& outward) {
        tissue::NearHexel hexel = hexel_at(p, outward);
        hexel.distance_m = 0.0f;
        exchange.near.push_back(hexel);
    }
};

}  // namespace

TEST(Touch, GapAndNormalOfAPointOutside) {
    const Touch side = touch({wire(kLeft, kRight), kDt_s}, hexel_at(Vec3(0, 0, -1e-3), Vec3(0, 0, 1)), kPoint_m);
    EXPECT_LT(glm::length(side.normal - Vec3f(0, 0, -1)), 1e-6f);
    EXPECT_NEAR(side.gap_m, 1e-3 - kWire_m - kPoint_m, 1e-9);
    const Touch end = touch({wire(kLeft, kRight), kDt_s}, hexel_at(Vec3(3e-3, 0, 0), Vec3(-1, 0, 0)), kPoint_m);
    EXPECT_LT(glm::length(end.normal - Vec3f(1, 0, 0)), 1e-6f);
    EXPECT_NEAR(end.gap_m, 2e-3 - kWire_m - kPoint_m, 1e-9);
}

// Pushed down through a surface: however far the hexel has come over the axis, it is pushed back down, ever harder.
TEST(Touch, AHexelThatCameOverTheAxisIsPushedBack) {
    float last_gap = 1.0f;
    for (double z = -1.2e-3; z < 0.45e-3; z += 1e-5) {
        const Touch t = touch({wire(kLeft, kRight), kDt_s}, hexel_at(Vec3(0, 0, z), Vec3(0, 0, 1)), kPoint_m);
        ASSERT_LT(glm::length(t.normal - Vec3f(0, 0, -1)), 1e-6f) << z;
        ASSERT_LT(t.gap_m, last_gap) << z;
        last_gap = t.gap_m;
    }
    EXPECT_LT(last_gap, -1.2e-3f);
}

// A hook lifting tissue from below touches its underside: up is out of the wire, and away from the tissue's free side.
TEST(Touch, TheUndersideIsLifted) {
    const Touch t = touch({wire(kLeft, kRight), kDt_s}, hexel_at(Vec3(0, 0, 0.4e-3), Vec3(0, 0, -1)), kPoint_m);
    EXPECT_LT(glm::length(t.normal - Vec3f(0, 0, 1)), 1e-6f);
}

// The capsules stand at the end of the tick; the gap is that at its start, and closes at the tool's velocity.
TEST(Touch, GapIsThatAtTheStartOfTheTick) {
    const Vec3 velocity(0, 0, -0.5);  // half a millimetre in the tick
    const Touch t = touch({wire(kLeft, kRight, velocity), kDt_s}, hexel_at(Vec3(0, 0, -1e-3), Vec3(0, 0, 1)), kPoint_m);
    EXPECT_NEAR(t.gap_m, 1.5e-3 - kWire_m - kPoint_m, 1e-9);
    EXPECT_LT(glm::length(t.tool_velocity_m_per_s - Vec3f(velocity)), 1e-6f);
}

// A wire that passes a hexel altogether within a tick still has it in front of its half-space.
TEST(Touch, AFastWireCannotJumpOverAHexel) {
    const Vec3 velocity(0, 0, -4.0), down(0, 0, -3e-3);  // 4 mm in the tick: far beyond surgery
    const Touch t =
        touch({wire(kLeft + down, kRight + down, velocity), kDt_s}, hexel_at(Vec3(0.0), Vec3(0, 0, 1)), kPoint_m);
    EXPECT_LT(glm::length(t.normal - Vec3f(0, 0, -1)), 1e-6f);
    const double at_end_m =
        static_cast<double>(t.gap_m) - glm::dot(Vec3(t.tool_velocity_m_per_s), Vec3(t.normal)) * kDt_s;
    EXPECT_LT(at_end_m, -3e-3);
}

TEST(FindContacts, OneForEachHexelTwoWhereWedged) {
    Scene scene;
    scene.exchange.capsules = {wire(Vec3(0), Vec3(5e-3, 0, 0)), wire(Vec3(0), Vec3(0, 0, 5e-3))};  // a right angle
    scene.add(Vec3(3e-3, 0, -7e-4), Vec3(0, 0, 1));                                                // below the foot
    scene.add(Vec3(6e-4, 0, 6e-4), Vec3(1, 0, 1) * 0.7071);                                        // in the corner
    scene.add(Vec3(3e-3, 0, 3e-3), Vec3(0, 0, 1));  // out of reach of both
    find_contacts(scene.model, scene.state, scene.exchange);
    ASSERT_EQ(scene.exchange.contacts.size(), 3u);
    EXPECT_EQ(scene.exchange.contacts[0].near, 0);
    EXPECT_NEAR(scene.exchange.contacts[0].gap_m, -1e-4, 1e-8);
    EXPECT_EQ(scene.exchange.contacts[1].near, 1);
    EXPECT_EQ(scene.exchange.contacts[2].near, 1);
    EXPECT_LT(std::fabs(glm::dot(scene.exchange.contacts[1].normal, scene.exchange.contacts[2].normal)), 1e-6f);
}

TEST(FindContacts, IsEmptyAwayFromTissue) {
    Scene scene;
    scene.exchange.capsules = {wire(Vec3(0, 0, 0.05), Vec3(5e-3, 0, 0.05))};
    find_contacts(scene.model, scene.state, scene.exchange);
    EXPECT_TRUE(scene.exchange.contacts.empty());
    EXPECT_EQ(scene.exchange.organ_force_N, Vec3(0.0));
}

// A sphere pushes radially with its stiffness times the depth; nothing outside; continuous in between.
TEST(OrganForce, IsStiffnessTimesDepthAlongTheNormal) {
    Scene scene;
    scene.model.organs.assign(1, {"sphere", 1, false, anatomy::make_sphere(Vec3(0, 0, -0.02), 0.02)});
    double last = 0.0;
    for (double z = 7e-4; z > -1e-3; z -= 5e-5) {
        scene.exchange.capsules = {wire(Vec3(0, 0, z), Vec3(0, 0, z + 0.01))};
        find_contacts(scene.model, scene.state, scene.exchange);
        const double depth_m = std::max(0.0, kWire_m - z);
        EXPECT_LT(glm::length(scene.exchange.organ_force_N - Vec3(0, 0, kOrganStiffness_N_per_m * depth_m)), 1e-6);
        EXPECT_LE(std::fabs(scene.exchange.organ_force_N.z - last), kOrganStiffness_N_per_m * 5.001e-5);
        last = scene.exchange.organ_force_N.z;
    }
}

// A shaft lying across an organ with both ends outside is stopped too.
TEST(OrganForce, IsFoundAlongTheShaft) {
    Scene scene;
    scene.model.organs.assign(1, {"sphere", 1, false, anatomy::make_sphere(Vec3(0.0), 0.01)});
    scene.exchange.capsules = {{.a_m = Vec3(-0.1, 0, 0.011), .b_m = Vec3(0.2, 0, 0.011), .radius_m = 2.5e-3}};
    find_contacts(scene.model, scene.state, scene.exchange);
    // The deepest of the points sampled: within half a distance between them (1.4 mm) of the deepest of all.
    EXPECT_NEAR(scene.exchange.organ_force_N.z, 1.5, 0.1);
}

}  // namespace calot::instruments

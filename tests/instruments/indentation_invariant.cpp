// The hook against tissue that gives way: pressing, holding, dragging, lifting.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "calot/anatomy/block.h"
#include "calot/anatomy/shapes.h"
#include "calot/deformation/embedding.h"
#include "calot/deformation/integrate.h"
#include "calot/deformation/topology.h"
#include "calot/instruments/contact.h"
#include "calot/instruments/hook.h"
#include "calot/tissue/sampling.h"

namespace calot::instruments {

namespace {

constexpr double kSpacing_m = 2.4e-3;

/// The part of a tick that concerns the hook and the tissue.
struct Scene {
    tissue::Model model;
    tissue::State state;
    deformation::Work work;
    tissue::Exchange exchange;
    HookShape shape;

    explicit Scene(const anatomy::Anatomy& anatomy)
        : model(tissue::sample(anatomy, {})), state(tissue::State::make(model)) {
        deformation::sever_initial_links(model, state);
        work = deformation::make_work(model, state);
        tissue::reserve_exchange(model, exchange);
    }
    void tick(const tissue::Pose& pose) {
        place_hook(shape, pose, state.tick == 0 ? pose : state.hook, model.tick_s, exchange.capsules);
        deformation::find_near(model, state, exchange, work, 2e-3);
        find_contacts(model, state, exchange);
        deformation::integrate(model, state, exchange, work);
        state.hook = pose;
        ++state.tick;
    }
    double force_N() const { return glm::length(exchange.contact_force_N); }
    double deepest_m() const {
        double deepest = 0.0;
        for (const tissue::Contact& contact : exchange.contacts)
            deepest = std::max(deepest, -static_cast<double>(contact.gap_m));
        return deepest;
    }
    double energy_J() const {
        return deformation::elastic_energy_J(model, state, work) + deformation::kinetic_energy_J(model, state, work);
    }
};

anatomy::Anatomy fat_block() {
    return anatomy::make_block({.size_m = kSpacing_m * Vec3(15, 15, 8)});
}

/// How the hook comes: from where, turned how, how fast, a little off the lattice.
struct Approach {
    Vec3 trocar_m;
    double roll_rad;
    double speed_m_per_s;
    double x_m;
};

class Pressing : public ::testing::TestWithParam<Approach> {};

}  // namespace

// 5 kPa fat gives 0.06 to 0.3 N at 5 to 10 mm of indentation (docs/physics.md section 8), for the foot flat as for its
// tip; the force grows, the wire neither sinks in between the hexels nor comes out behind them, and held still it
// stays where it is.
TEST_P(Pressing, GivesTheForceOfFatAndNeverSlipsThrough) {
    const Approach& how = GetParam();
    Scene scene(fat_block());
    constexpr double kDepth_m = 10e-3;
    constexpr double kMostPenetration_m = 0.8e-3;  // half the hexel and half the wire; 0.65 mm seen, at one hexel
    constexpr double kMostDip = 0.2;               // of the force so far, when a hexel changes over; 0.13 seen
    double z = 3e-3, touched_z = 1.0, at_5mm_N = 0.0, at_10mm_N = 0.0, most_N = 0.0;
    auto pose = [&] { return pose_through_trocar(how.trocar_m, Vec3(how.x_m, 0.0, z), how.roll_rad); };
    for (; touched_z - z < kDepth_m || touched_z == 1.0; z -= how.speed_m_per_s * scene.model.tick_s) {
        scene.tick(pose());
        ASSERT_TRUE(scene.state.status.ok) << "at z = " << z;
        const double force_N = scene.force_N();
        if (touched_z == 1.0 && force_N > 1e-4) touched_z = z;
        if (touched_z - z <= 5e-3) at_5mm_N = force_N;
        at_10mm_N = force_N;
        most_N = std::max(most_N, force_N);
        ASSERT_LT(scene.deepest_m(), kMostPenetration_m) << "at z = " << z;
        if (most_N > 0.03) {
            ASSERT_GT(force_N, (1.0 - kMostDip) * most_N) << "at z = " << z;
        }
    }
    EXPECT_GT(at_5mm_N, 0.06);
    EXPECT_LT(at_5mm_N, 0.3);
    EXPECT_GT(at_10mm_N, 0.2);
    EXPECT_LT(at_10mm_N, 0.45);

    for (int k = 0; k < 200; ++k) scene.tick(pose());
    const double held_N = scene.force_N();
    EXPECT_GT(held_N, 0.8 * at_10mm_N);
    for (int k = 0; k < 50; ++k) {
        scene.tick(pose());
        EXPECT_NEAR(scene.force_N(), held_N, 0.05 * held_N) << "trembles";
    }
}

INSTANTIATE_TEST_SUITE_P(FromHereAndThere, Pressing,
                         ::testing::Values(Approach{Vec3(0, -0.08, 0.14), 0.0, 0.02, 0.0},
                                           Approach{Vec3(0, -0.08, 0.14), 0.0, 0.1, 1.3e-3},
                                           Approach{Vec3(0, -0.08, 0.14), 3.14159, 0.1, 0.0},
                                           Approach{Vec3(0, -0.08, 0.14), 1.57, 0.05, 0.0},
                                           Approach{Vec3(0, -0.08, 0.14), 2.5, 0.05, 0.5e-3},
                                           Approach{Vec3(0, 0.001, 0.16), 0.0, 0.02, 0.0},
                                           Approach{Vec3(0, 0.001, 0.16), 1.0, 0.1, 1.1e-3}));

// Pressed 4 mm deep, dragged 15 mm sideways at 100 mm/s, lifted off: the tissue drags along, pulls against the motion,
// lets go, and comes back to rest.
TEST(Dragging, OpposesTheMotionAndLetsGo) {
    Scene scene(fat_block());
    Vec3 tip_m(-7e-3, 0.0, 2e-3);
    const Vec3 trocar_m(0.0, 0.001, 0.16);
    auto move = [&](const Vec3& to, double speed_m_per_s) {
        const double length_m = glm::length(to - tip_m);
        const int ticks = static_cast<int>(std::ceil(length_m / (speed_m_per_s * scene.model.tick_s)));
        const Vec3 from = tip_m;
        for (int k = 1; k <= ticks; ++k) {
            tip_m = glm::mix(from, to, static_cast<double>(k) / ticks);
            scene.tick(pose_through_trocar(trocar_m, tip_m, 0.0));
            ASSERT_TRUE(scene.state.status.ok);
        }
    };
    move(Vec3(-7e-3, 0.0, -3.5e-3), 0.05);
    const double pressed_J = scene.energy_J();
    move(Vec3(8e-3, 0.0, -3.5e-3), 0.1);
    EXPECT_LT(scene.exchange.contact_force_N.x, -0.01) << "friction and the heap in front push back";
    move(Vec3(8e-3, 0.0, 5e-3), 0.1);
    EXPECT_EQ(scene.force_N(), 0.0);
    for (int k = 0; k < 400; ++k) scene.tick(pose_through_trocar(trocar_m, tip_m, 0.0));
    EXPECT_LT(scene.energy_J(), 1e-4 * pressed_J);
}

// A bridge of fat held at both ends, the foot beneath it: lifting the hook lifts the bridge, which pulls down.
TEST(Tenting, TheFootLiftsTissueFromBelow) {
    const double length_m = 8 * kSpacing_m, half_m = kSpacing_m;
    anatomy::Anatomy bridge;
    const Vec3 low(-0.5 * length_m, -half_m, -half_m);
    bridge.tissues.push_back({"bridge", "fat", anatomy::make_box(low, -low)});
    bridge.organs.push_back(
        {"left", "liver", true, anatomy::make_box(Vec3(low.x - 0.01, -0.02, -0.02), Vec3(low.x, 0.02, 0.02))});
    bridge.organs.push_back(
        {"right", "liver", true, anatomy::make_box(Vec3(-low.x, -0.02, -0.02), Vec3(0.01 - low.x, 0.02, 0.02))});
    bridge.field = Box{low, -low};
    Scene scene(bridge);
    scene.shape.foot_length_m = 8e-3;  // reaches across the bridge
    const Vec3 trocar_m(0.0, -4e-3, 0.16);
    const double start_z = -half_m - 1.0e-3;
    auto pose = [&](double z) {
        return pose_through_trocar(trocar_m, Vec3(0.0, 0.0, z), 3.14159265358979, scene.shape);
    };
    constexpr double kLift_m = 6e-3;
    for (int k = 0; k <= 300; ++k) {
        scene.tick(pose(start_z + kLift_m * k / 300.0));
        ASSERT_TRUE(scene.state.status.ok);
        ASSERT_LT(scene.deepest_m(), 0.5e-3);
    }
    for (int k = 0; k < 100; ++k) scene.tick(pose(start_z + kLift_m));
    // The hook's top is now 5.8 mm above where the bridge's underside was at rest, but for the tilt that the trocar
    // gives.
    const std::vector<Vec3f> rest{Vec3f(0.0f, 0.0f, static_cast<float>(-half_m + 3e-4))};
    const std::vector<std::int64_t> owner{scene.model.hexels.index(scene.model.hexels.cell_at(Vec3(rest[0])))};
    std::vector<Vec3f> world(1);
    deformation::embed_points(scene.model, scene.state, scene.work, rest, owner, world);
    EXPECT_GT(world[0].z - rest[0].z, 4.5e-3f);
    EXPECT_LT(scene.exchange.contact_force_N.z, -0.02);
}

// The hook's reaction is the tissue's change of momentum: a free block, pushed.
TEST(Reaction, BalancesTheMomentumOfAFreeBody) {
    Scene scene(anatomy::make_block({.size_m = kSpacing_m * Vec3(6, 6, 4), .held_below = false}));
    scene.model.deformation.damping_per_s = 0.0;
    Vec3 impulse_Ns(0.0);
    for (int k = 0; k < 60; ++k) {
        scene.tick(pose_through_trocar(Vec3(0.0, 0.001, 0.16), Vec3(0.0, 0.0, 1.2e-3 - 5e-5 * k), 0.3));
        impulse_Ns -= scene.exchange.contact_force_N * scene.model.tick_s;
    }
    Vec3 momentum_Ns(0.0);
    for (std::int64_t p = scene.model.phyxels.first; p < scene.model.phyxels.last; ++p) {
        const auto i = static_cast<std::size_t>(p);
        if (scene.work.inverse_mass_per_kg[i] == 0.0f) continue;
        momentum_Ns += Vec3(scene.state.velocity_m_per_s[0][i], scene.state.velocity_m_per_s[1][i],
                            scene.state.velocity_m_per_s[2][i]) /
                       static_cast<double>(scene.work.inverse_mass_per_kg[i]);
    }
    ASSERT_GT(glm::length(impulse_Ns), 1e-5);
    constexpr double kRounding = 1e-3;  // of sums over some 100 phyxels and 180 substeps in single precision
    EXPECT_LT(glm::length(momentum_Ns - impulse_Ns), kRounding * glm::length(impulse_Ns));
}

}  // namespace calot::instruments

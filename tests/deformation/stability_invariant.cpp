// The explicit step is stable on whatever shape is left: leapfrog needs omega dt < 2 for the highest frequency omega.

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "calot/deformation/kernel.h"
#include "calot/validation/elastic_rig.h"

namespace calot::deformation::rig {

namespace {

/// Highest frequency of small motions about rest, times the substep, by power iteration (from below, to some 1 %).
double highest_omega_dt(const Body& body) {
    constexpr double kSize_m = 1e-9;  // small enough for forces to be linear, far above the rounding of doubles
    Reference<double> reference(body.model, body.state, body.work);
    auto mass = [&](std::size_t i) { return 1.0 / std::max(1e-300, reference.inverse_mass_per_kg[i]); };
    std::vector<Vec3>& u = reference.displacement_m;
    Random random(1);
    body.for_each_phyxel([&](std::int64_t p) {
        u[static_cast<std::size_t>(p)] = Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    });
    double omega2 = 0.0;
    for (int iteration = 0; iteration < 100; ++iteration) {
        double norm2 = 0.0;
        body.for_each_phyxel([&](std::int64_t p) {
            const auto i = static_cast<std::size_t>(p);
            norm2 += mass(i) * glm::dot(u[i], u[i]);
        });
        body.for_each_phyxel([&](std::int64_t p) { u[static_cast<std::size_t>(p)] *= kSize_m / std::sqrt(norm2); });
        reference.update_gradients();
        reference.update_forces();
        omega2 = 0.0;
        body.for_each_phyxel([&](std::int64_t p) {
            const auto i = static_cast<std::size_t>(p);
            omega2 -= glm::dot(reference.force_N[i], u[i]) / (kSize_m * kSize_m);
            u[i] = -reference.inverse_mass_per_kg[i] * reference.force_N[i];
        });
    }
    return std::sqrt(omega2) * static_cast<double>(body.work.substep_s);
}

constexpr double kLimit = 2.0;

/// Takes from each phyxel a share of its hexels of its own, from none to all.
void thin_out(Body& body, std::uint64_t seed) {
    Random random(seed);
    const int m = body.model.hexels_per_edge;
    body.for_each_phyxel([&](std::int64_t p) {
        const double share = random.uniform();
        const Int3 low = body.model.phyxels.coordinates(p) * m;
        for (int bit = 0; bit < m * m * m; ++bit)
            if (random.uniform() < share)
                body.state.hexel_present.clear(
                    body.model.hexels.index(low + Int3(bit % m, bit / m % m, bit / (m * m))));
    });
    body.refresh();
}

}  // namespace

TEST(Stability, OfWholeAndSlenderBodies) {
    for (const bool held : {false, true})
        for (const Int3& size : {Int3(2, 2, 2), Int3(2, 2, 6), Int3(2, 6, 6), Int3(6, 6, 6)}) {
            const Body body(block(size, held));
            EXPECT_LT(highest_omega_dt(body), 0.85 * kLimit) << size.x << ' ' << size.y << ' ' << size.z << ' ' << held;
        }
}

TEST(Stability, OfBurntBodies) {
    for (std::uint64_t seed = 1; seed <= 4; ++seed)
        for (const double severed : {0.0, 0.2, 0.5, 0.7, 0.9}) {
            Body evenly(block({6, 5, 6}, true));
            wound(evenly, 0.5, severed, seed);
            EXPECT_LT(highest_omega_dt(evenly), kLimit) << "seed " << seed << ", severed " << severed;
            Body unevenly(block({6, 5, 6}, true));
            thin_out(unevenly, seed);
            wound(unevenly, 0.0, severed, seed);
            EXPECT_LT(highest_omega_dt(unevenly), kLimit) << "seed " << seed << ", severed " << severed;
        }
}

// Hexels of fat and of duct, a hundred times as stiff, thrown together.
TEST(Stability, OfMixedTissues) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed)
        for (const double severed : {0.0, 0.5}) {
            tissue::Model model = block({6, 5, 6}, true);
            const tissue::MaterialIndex duct = tissue::find_material(model.materials, "cystic_duct");
            ASSERT_NE(duct, tissue::kNoMaterial);
            Random random(seed);
            for (std::int64_t p = model.phyxels.first; p < model.phyxels.last; ++p) {
                if (!model.phyxel_initial.test(p)) continue;
                const double share = std::max(0.0, random.uniform(-1.0, 1.0));
                const Int3 low = model.phyxels.coordinates(p) * 4;
                for (int bit = 0; bit < 64; ++bit)
                    if (random.uniform() < share)
                        model.hexel_material[static_cast<std::size_t>(
                            model.hexels.index(low + Int3(bit % 4, bit / 4 % 4, bit / 16)))] = duct;
            }
            tissue::prepare_time_step(model);
            Body body(std::move(model));
            wound(body, 0.1, severed, seed);
            EXPECT_LT(highest_omega_dt(body), kLimit) << "seed " << seed << ", severed " << severed;
        }
}

// Subnormal numbers are slow: without an end to ever slower motion, a tick of tissue left alone takes up to thirty times
// as long after a second or two.
TEST(Stability, TissueThatComesToRestLeavesNoSubnormalNumbers) {
    Body body(block({6, 5, 4}, true));
    shake(body, 0.02, 0.0, 7);
    auto subnormal = [](const Array<float>& values) {
        return std::count_if(values.begin(), values.end(), [](float x) { return std::fpclassify(x) == FP_SUBNORMAL; });
    };
    double moved = 0.0;
    for (int k = 0; k < 4000; ++k) {
        body.tick();
        if (k == 99) moved = kinetic_energy_J(body.model, body.state, body.work);
        if (k % 20 != 19) continue;
        body.for_each_phyxel([&](std::int64_t p) {
            for (std::size_t r = 0; r < 3; ++r) {
                const float u = std::fabs(body.state.displacement_m[r][static_cast<std::size_t>(p)]),
                            v = std::fabs(body.state.velocity_m_per_s[r][static_cast<std::size_t>(p)]);
                ASSERT_TRUE(u == 0.0f || u >= kNowhere_m) << u << " m in tick " << k;
                ASSERT_TRUE(v == 0.0f || v >= kRest_m_per_s) << v << " m/s in tick " << k;
            }
        });
        for (const auto* fields : {&body.work.gradient, &body.work.moment_stress})
            for (const auto& component : *fields) ASSERT_EQ(subnormal(component), 0) << "tick " << k;
    }
    EXPECT_GT(moved, 0.0);
    EXPECT_EQ(kinetic_energy_J(body.model, body.state, body.work), 0.0);
}

TEST(Stability, WhatIsNoNumberStopsTheRun) {
    constexpr float kNaN = std::numeric_limits<float>::quiet_NaN(), kInfinity = std::numeric_limits<float>::infinity();
    for (const float poison : {kNaN, kInfinity})
        for (const bool velocity : {false, true}) {
            Body body(block({6, 5, 4}, true));
            shake(body, 0.02, 0.0, 7);
            body.tick();
            ASSERT_TRUE(body.state.status.ok);
            const auto p = static_cast<std::size_t>(body.model.phyxels.index(Int3(4, 3, 3)));
            ASSERT_TRUE(body.state.phyxel_present.test(static_cast<std::int64_t>(p)));
            (velocity ? body.state.velocity_m_per_s : body.state.displacement_m)[1][p] = poison;
            body.tick();
            EXPECT_FALSE(body.state.status.ok) << poison << (velocity ? " as velocity" : " as displacement");
            EXPECT_STREQ(body.state.status.field, "displacement_m");
        }
}

}  // namespace calot::deformation::rig

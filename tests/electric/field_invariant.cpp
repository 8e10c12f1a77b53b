// What must hold for any field: power in = heat + outflow, symmetry, bounds, and the same answer from any start.

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "calot/base/random.h"
#include "calot/validation/electric_rig.h"

namespace calot::electric {

namespace {

double sum_of_density_W(const Rig& rig) {
    const tissue::JouleHeat& joule = rig.exchange.joule;
    double sum = 0.0;
    for (const float density : joule.density) sum += static_cast<double>(density);
    return sum * static_cast<double>(joule.scale) * rig.model.hexel_volume_m3();
}

float density_at(const Rig& rig, const Int3& hexel) {
    const tissue::JouleHeat& joule = rig.exchange.joule;
    return joule.scale * joule.density[static_cast<std::size_t>(joule.index(hexel))];
}

/// Takes away a share of the hexels and scales the conductivity of the others by up to 1e4.
void roughen(Rig& rig, double share, std::uint64_t seed) {
    Random random(seed);
    for (std::int64_t hexel = rig.model.hexels.first; hexel < rig.model.hexels.last; ++hexel) {
        const double chance = random.uniform(), decades = random.uniform(0.0, 4.0);
        rig.work->hexel_conductivity_S_per_m[static_cast<std::size_t>(hexel)] *=
            static_cast<float>(std::pow(10.0, -decades));
        if (chance < share && rig.state.hexel_present.test(hexel)) rig.state.hexel_present.clear(hexel);
    }
}

}  // namespace

// The current that leaves the metal, times the voltage, is the heat plus what flows out: within the specified 0.05 %
// at the residual that runs use, for smooth and for very uneven tissue.
TEST(FieldInvariant, PowerInIsHeatPlusOutflow) {
    for (const double share : {0.0, 0.2}) {
        Rig rig = held_rig(tissue::ElectricParameters().relative_residual);
        if (share > 0.0) roughen(rig, share, 7);
        rig.solve();
        const tissue::GeneratorState& generator = rig.state.generator;
        ASSERT_GT(generator.power_W, 0.0);
        const double by_current = rig.work->electrode_conductance_S * generator.voltage_V * generator.voltage_V;
        const double out = rig.exchange.joule.total_W + rig.exchange.joule.outflow_W + rig.exchange.joule.wire_W;
        EXPECT_NEAR(by_current / out, 1.0, 5e-4);
        EXPECT_NEAR(generator.voltage_V * generator.current_A / out, 1.0, 1e-9);
        EXPECT_NEAR(generator.power_W / out, 1.0, 1e-9);
        EXPECT_NEAR(sum_of_density_W(rig) / rig.exchange.joule.total_W, 1.0, 1e-6);  // floats
        EXPECT_GT(rig.exchange.joule.outflow_W, 0.0) << "the slab that holds the fat takes its share";
    }
}

TEST(FieldInvariant, HeatLiesInPresentHexelsOnly) {
    Rig rig = held_rig(1e-2);
    roughen(rig, 0.3, 3);
    rig.solve();
    const tissue::JouleHeat& joule = rig.exchange.joule;
    for (int z = 0; z < joule.size.z; ++z)
        for (int y = 0; y < joule.size.y; ++y)
            for (int x = 0; x < joule.size.x; ++x) {
                const Int3 hexel = joule.low + Int3(x, y, z), size = rig.model.hexels.size;
                const float density = density_at(rig, hexel);
                ASSERT_GE(density, 0.0f);
                const bool inside =
                    glm::all(glm::greaterThanEqual(hexel, Int3(0))) && glm::all(glm::lessThan(hexel, size));
                const bool present = inside && rig.state.hexel_present.test(rig.model.hexels.index(hexel));
                ASSERT_TRUE(present || density == 0.0f);
            }
}

// Tissue and metal are their own mirror images in x and in y; the aggregates of the multigrid are not, so the field is
// symmetric to the residual only.
TEST(FieldInvariant, MirrorImagesHeatAlike) {
    Rig rig = held_rig(1e-6);
    rig.solve();
    float largest = 0.0f, difference = 0.0f;
    for (int z = 4; z < 20; ++z)
        for (int y = 4; y < 44; ++y)
            for (int x = 4; x < 44; ++x) {
                const float here = density_at(rig, {x, y, z});
                largest = std::max(largest, here);
                difference = std::max(difference, std::abs(here - density_at(rig, {47 - x, y, z})));
                difference = std::max(difference, std::abs(here - density_at(rig, {x, 47 - y, z})));
            }
    EXPECT_LT(difference, 1e-4f * largest);
}

// No potential beyond those of the metal and of the far return.
TEST(FieldInvariant, MaximumPrinciple) {
    Rig rig = held_rig(1e-6);
    roughen(rig, 0.25, 11);
    rig.solve();
    const auto [low, high] = std::minmax_element(rig.state.potential.begin(), rig.state.potential.end());
    EXPECT_GE(*low, -1e-5f);  // the residual's share
    EXPECT_LE(*high, 1.0f + 1e-5f);
}

TEST(FieldInvariant, WarmStartEqualsColdStart) {
    Rig warm = disc_rig(32, 3.0, 0.025, 1e-5), cold = disc_rig(32, 3.0, 0.025, 1e-5);
    warm.solve();
    // The metal moves on, far enough that the window follows; some tissue is gone.
    for (Rig* rig : {&warm, &cold}) {
        rig->exchange.near.clear();
        for (int y = 0; y < 4; ++y)
            for (int x = 0; x < 4; ++x) rig->touch({34 + x, 30 + y, 41});
        for (int z = 42; z < 44; ++z)
            for (int y = 28; y < 34; ++y)
                for (int x = 32; x < 40; ++x) rig->state.hexel_present.clear(rig->model.hexels.index(x, y, z));
    }
    const Int3 low_before = warm.state.field_low;
    warm.solve();
    EXPECT_NE(warm.state.field_low, low_before);
    cold.solve();
    // One window stayed where the other started, so put both in the same place: the answer must not depend on the
    // start.
    cold.state.field_low = warm.state.field_low;
    std::fill(cold.state.potential.begin(), cold.state.potential.end(), 0.0f);
    cold.solve();
    ASSERT_EQ(cold.state.field_low, warm.state.field_low);
    EXPECT_NEAR(warm.resistance_Ohm() / cold.resistance_Ohm(), 1.0, 1e-5);
    float difference = 0.0f;
    for (std::size_t i = 0; i < warm.state.potential.size(); ++i)
        difference = std::max(difference, std::abs(warm.state.potential[i] - cold.state.potential[i]));
    EXPECT_LT(difference, 1e-4f);  // ten times the residual
}

// A solve at the running residual of 1e-2 has the load right to a part in a thousand: the error of a Dirichlet energy
// is the square of the field's.
TEST(FieldInvariant, TheRunningResidualSettlesTheCurrent) {
    Rig rough = held_rig(1e-2), fine = held_rig(1e-6);
    rough.solve();
    fine.solve();
    EXPECT_NEAR(rough.resistance_Ohm() / fine.resistance_Ohm(), 1.0, 1e-3);
}

}  // namespace calot::electric

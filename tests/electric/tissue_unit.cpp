// What tissue does to current: conductivity by temperature and water, dried contacts, stray current, a near return.

#include <cmath>

#include <gtest/gtest.h>

#include "calot/electric/conductivity.h"
#include "calot/tissue/phase.h"
#include "calot/validation/electric_rig.h"

namespace calot::electric {

namespace {

/// Conductivity of a hexel of fat at a temperature, with a share of its water.
double conductivity_at(Rig& rig, double temperature_K, double water_share) {
    const std::int64_t hexel = rig.model.hexels.index(20, 20, 12);
    const auto h = static_cast<std::size_t>(hexel);
    const tissue::Material& fat = rig.model.materials[rig.model.hexel_material[h]];
    const tissue::PhaseCurve curve = tissue::PhaseCurve::make(rig.model.thermal, fat);
    const double water = fat.density_kg_per_m3 * fat.water_mass_fraction * water_share;
    const double capacity =
        static_cast<double>(curve.dry_capacity_J_per_m3K) + water * static_cast<double>(curve.water_capacity_J_per_kgK);
    rig.state.water_kg_per_m3[h] = static_cast<float>(water);
    rig.state.enthalpy_J_per_m3[h] =
        static_cast<float>(capacity * (temperature_K - rig.model.thermal.body_temperature_K));
    look_at(rig.model, rig.state, rig.work->hexel_conductivity_S_per_m, rig.work->conductivity);
    return static_cast<double>(rig.work->conductivity.of(hexel));
}

}  // namespace

TEST(Conductivity, FollowsTemperatureAndWater) {
    Rig rig = held_rig(1e-2);
    const double at_rest = 0.025, body_K = rig.model.thermal.body_temperature_K;
    EXPECT_NEAR(conductivity_at(rig, body_K, 1.0), at_rest, 1e-8);
    EXPECT_NEAR(conductivity_at(rig, body_K + 10.0, 1.0), 1.2 * at_rest, 1e-6);
    const double boiling = at_rest * (1.0 + 0.02 * 63.0);
    EXPECT_NEAR(conductivity_at(rig, 373.15, 1.0), boiling, 1e-6);
    EXPECT_NEAR(conductivity_at(rig, 373.15, 0.5), 0.5 * (boiling + 1e-4), 1e-6);
    EXPECT_NEAR(conductivity_at(rig, 373.15, 0.0), 1e-4, 1e-8);
    EXPECT_NEAR(conductivity_at(rig, 450.0, 0.0), 1e-4, 1e-8);
}

// Metal on dried tissue: a low voltage makes no arc, and little flows; arcs burn through.
TEST(Conductivity, ArcsBurnThroughDriedTissue) {
    Rig rig = held_rig(1e-3);
    for (const tissue::NearHexel& near : rig.exchange.near) {
        rig.state.water_kg_per_m3[static_cast<std::size_t>(near.hexel)] = 0.0f;
        rig.state.enthalpy_J_per_m3[static_cast<std::size_t>(near.hexel)] = 2e8f;
    }
    rig.model.electric.arc_threshold_V = 1e4;
    rig.solve();
    const double dry = rig.state.generator.impedance_Ohm;
    rig.model.electric.arc_threshold_V = 200.0;
    rig.solve();
    EXPECT_GT(dry, 10.0 * rig.state.generator.impedance_Ohm);
    EXPECT_GT(rig.state.generator.power_W, 1.0);
}

// A cord of what conducts twenty times better draws current: its heat and density are told apart from the fat's.
TEST(Stray, CurrentInACordIsCounted) {
    tissue::Model model = tissue::sample(anatomy::make_block({.size_m = Vec3(0.024, 0.024, 0.0096)}), {});
    const auto duct = tissue::find_material(model.materials, "cystic_duct");
    const auto fat = tissue::find_material(model.materials, "fat");
    for (std::int64_t hexel = model.hexels.first; hexel < model.hexels.last; ++hexel) {
        const Int3 c = model.hexels.coordinates(hexel);
        if (model.hexel_initial.test(hexel) && c.y >= 22 && c.y < 26 && c.z >= 13 && c.z < 16)
            model.hexel_material[static_cast<std::size_t>(hexel)] = duct;
    }
    Rig rig(std::move(model));
    for (int y = 22; y < 26; ++y) rig.touch({24, y, 19});
    rig.solve();
    const tissue::StrayCurrent& stray = rig.state.stray;
    ASSERT_GT(rig.state.generator.power_W, 0.0);
    EXPECT_GT(stray.power_W[duct], 0.0);
    EXPECT_GT(stray.power_W[fat], stray.power_W[duct]);
    EXPECT_NEAR(stray.power_W[fat] + stray.power_W[duct], rig.exchange.joule.total_W, 1e-9);
    EXPECT_GT(stray.density_A_per_m2[duct], 0.0);
    const double energy_J = stray.energy_J[duct];
    EXPECT_NEAR(energy_J, stray.power_W[duct] * rig.model.tick_s, 1e-12);
    rig.input.pedal = false;
    rig.solve();
    EXPECT_EQ(stray.power_W[duct], 0.0);
    EXPECT_EQ(stray.energy_J[duct], energy_J);
    EXPECT_GT(stray.highest_density_A_per_m2[duct], 0.0);
}

// A return electrode to one side lowers the potential there; one far away in the same direction hardly does.
TEST(Return, ANearOneBendsTheField) {
    auto left_over_right = [](bool placed, double distance_m) {
        Rig rig = disc_rig(32, 2.0, 0.1, 1e-5);
        rig.model.electric.return_placed = placed;
        const Lattice& lattice = rig.model.hexels;
        rig.model.electric.return_m = lattice.centre_m(rig.exchange.near[0].hexel) - Vec3(distance_m, 0.0, 0.0);
        rig.solve();
        EXPECT_LT(rig.state.field.imbalance, 5e-4);
        const Window& window = rig.work->window;
        Int3 left = window.from_hexel(lattice.coordinates(rig.exchange.near[0].hexel)), right = left;
        for (int k = 0; k < 3; ++k) {
            // The disc's middle lies between two hexels, the first touched one is left of it.
            if (window.axis[k] == 0) left[k] -= 12;
            if (window.axis[k] == 0) right[k] += 13;
        }
        auto potential = [&](const Int3& c) {
            const int at = c.x + window.cells * (c.y + window.cells * c.z);
            return static_cast<double>(rig.state.potential[static_cast<std::size_t>(at)]);
        };
        return potential(left) / potential(right);
    };
    EXPECT_NEAR(left_over_right(false, 0.0), 1.0, 1e-3);
    EXPECT_LT(left_over_right(true, 0.05), 0.98);
    EXPECT_NEAR(left_over_right(true, 50.0), 1.0, 5e-3);
}

}  // namespace calot::electric

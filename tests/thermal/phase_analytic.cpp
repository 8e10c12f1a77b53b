// Boiling and gasification against closed forms.

#include <gtest/gtest.h>

#include "calot/validation/heat_rig.h"

namespace calot::thermal {

namespace {

tissue::Material liver() {
    const auto materials = tissue::default_materials();
    tissue::Material m = materials[tissue::find_material(materials, "liver")];
    bloodless(m);
    return m;
}

/// One insulated hexel under constant heat.
HeatRun heated_hexel(tissue::PhaseModel phase, double density_W_per_m3, double dt_s) {
    tissue::Model model = box_model({1, 1, 1}, 0.6e-3, dt_s, {liver()});
    insulate(model);
    model.thermal.phase_model = phase;
    HeatRun run(std::move(model));
    run.set_joule({0, 0, 0}, {1, 1, 1}, [=](const Int3&) { return density_W_per_m3; });
    return run;
}

constexpr double kDensity = 5e8;  // W/m^3: boils after 0.5 s
constexpr double kStep = 1e-3;    // s
constexpr double kStepHeat = kDensity * kStep;

}  // namespace

TEST(Phases, CapacityCloses) {
    for (const tissue::Material& m : tissue::default_materials()) {
        if (m.name == "none") continue;
        const PhaseCurve curve = PhaseCurve::make({}, m);
        const double alive =
            static_cast<double>(curve.dry_capacity_J_per_m3K) +
            static_cast<double>(curve.water_capacity_J_per_kgK) * m.density_kg_per_m3 * m.water_mass_fraction;
        EXPECT_NEAR(alive, m.density_kg_per_m3 * m.specific_heat_J_per_kgK, 1e-6 * alive) << m.name;
        EXPECT_NEAR(static_cast<double>(curve.water_capacity_J_per_kgK), 4187.0, 2.0) << m.name;
    }
}

TEST(Phases, BoilingAndGasifyingAHexelTakesTheClosedFormsEnergy) {
    HeatRun run = heated_hexel(tissue::PhaseModel::water_then_solids, kDensity, kStep);
    const tissue::Material m = liver();
    const double volume = run.model.hexel_volume_m3(), rho = m.density_kg_per_m3, f = m.water_mass_fraction;
    const double to_boil = rho * m.specific_heat_J_per_kgK * 63.0, to_dry = rho * f * 2.26e6;
    const double dry_capacity = rho * (1.0 - f) * m.dry_specific_heat_J_per_kgK;
    const double to_remove =
        dry_capacity * (m.removal_temperature_K - 373.15) + rho * (1.0 - f) * m.solid_latent_heat_J_per_kg;
    const std::int64_t cell = run.model.hexels.index(0, 0, 0);
    const auto h = static_cast<std::size_t>(cell);
    double boils_at = 0.0, dry_at = 0.0, steam_kg = 0.0, smoke_kg = 0.0;
    while (run.state.hexel_present.test(cell)) {
        const float water_before = run.state.water_kg_per_m3[h];
        run.tick();
        const double delivered = run.state.energy_J.delivered / volume;
        for (const tissue::GasEvent& e : run.exchange.gas) {
            steam_kg += static_cast<double>(e.steam_kg);
            smoke_kg += static_cast<double>(e.smoke_kg);
        }
        if (boils_at == 0.0 && run.state.water_kg_per_m3[h] < water_before) boils_at = delivered;
        if (dry_at == 0.0 && run.state.water_kg_per_m3[h] == 0.0f) dry_at = delivered;
        if (run.state.hexel_present.test(cell) && run.state.water_kg_per_m3[h] > 0.0f) {
            ASSERT_LE(temperature_K(run.model, run.state, cell), 373.1501f);
        }
        ASSERT_LT(delivered, 1e10);
    }
    const double total = run.state.energy_J.delivered / volume;
    EXPECT_NEAR(boils_at, to_boil, 1.01 * kStepHeat);  // events are seen at the end of a step
    EXPECT_NEAR(dry_at, to_boil + to_dry, 1.01 * kStepHeat);
    // The steam's own heat above T_0 counts for the water, not for the solids: it left while they stayed at 100 C.
    EXPECT_NEAR(total, to_boil + to_dry + to_remove, 1.01 * kStepHeat);
    EXPECT_EQ(run.exchange.removed_hexels, std::vector<std::int64_t>{cell});
    EXPECT_EQ(run.state.hexels_burnt, 1);
    EXPECT_NEAR(steam_kg, rho * f * volume, 1e-5 * rho * volume);
    EXPECT_NEAR(smoke_kg, rho * (1.0 - f) * volume, 1e-5 * rho * volume);
    // All that was delivered left with the gas.
    EXPECT_NEAR(run.state.energy_J.gas, run.state.energy_J.delivered, 1e-6 * run.state.energy_J.delivered);
    const double latent = rho * f * 2.26e6 + rho * (1.0 - f) * m.solid_latent_heat_J_per_kg;
    EXPECT_NEAR(run.state.energy_J.latent, latent * volume, 1e-5 * latent * volume);
}

TEST(Phases, ThresholdTakesTheClosedFormsEnergy) {
    HeatRun run = heated_hexel(tissue::PhaseModel::threshold, kDensity, kStep);
    const tissue::Material m = liver();
    const double rho = m.density_kg_per_m3, volume = run.model.hexel_volume_m3();
    const double exact = rho * (m.specific_heat_J_per_kgK * 63.0 + m.water_mass_fraction * 2.26e6);
    const std::int64_t cell = run.model.hexels.index(0, 0, 0);
    while (run.state.hexel_present.test(cell)) {
        run.tick();
        ASSERT_LT(run.state.energy_J.delivered / volume, 1e10);
    }
    EXPECT_NEAR(run.state.energy_J.delivered / volume, exact, 1.01 * kStepHeat);
    EXPECT_NEAR(run.state.energy_J.gas, run.state.energy_J.delivered, 1e-6 * run.state.energy_J.delivered);
    ASSERT_EQ(run.exchange.gas.size(), 1u);
    EXPECT_NEAR(static_cast<double>(run.exchange.gas[0].steam_kg), rho * m.water_mass_fraction * volume,
                1e-9 * rho * volume + 1e-14);
}

TEST(Phases, SteamDoesNotCondense) {
    HeatRun run = heated_hexel(tissue::PhaseModel::water_then_solids, kDensity, kStep);
    run.run(1500);  // well into boiling
    const auto h = static_cast<std::size_t>(run.model.hexels.index(0, 0, 0));
    const float water = run.state.water_kg_per_m3[h];
    ASSERT_GT(water, 0.0f);
    ASSERT_LT(water, 700.0f);
    run.exchange.joule.size = Int3(0);
    run.model.thermal.gas_transfer_W_per_m2K = 50.0;
    run.start();
    run.run(100000);
    EXPECT_LT(run.rise_K(run.model.hexels.index(0, 0, 0)), 5.0);
    EXPECT_EQ(run.state.water_kg_per_m3[h], water);
}

namespace {

/// Neumann's one-phase similarity solution: lambda exp(lambda^2) erf(lambda) = Ste / sqrt(pi); front at 2 lambda sqrt(a
/// t).
double stefan_lambda(double stefan) {
    double low = 0.0, high = 5.0;
    for (int k = 0; k < 100; ++k) {
        const double mid = 0.5 * (low + high);
        (mid * std::exp(mid * mid) * std::erf(mid) < stefan / std::sqrt(std::numbers::pi) ? low : high) = mid;
    }
    return low;
}

/// Relative error of the depth to which tissue on the threshold's plateau has given its latent heat back, when one end
/// is held at body temperature.
double threshold_front_error(int n) {
    const tissue::Material m = liver();
    const double length = 4e-3, s = length / n, rho_c = m.density_kg_per_m3 * m.specific_heat_J_per_kgK;
    const double a = m.thermal_conductivity_W_per_mK / rho_c,
                 latent = m.density_kg_per_m3 * m.water_mass_fraction * 2.26e6;
    tissue::Model model = bar_model(n, s, 0.08 * s * s / a, {m});
    for (int x = 1; x <= n; ++x)
        for (const Int3 side : {Int3(x, 0, 1), Int3(x, 2, 1), Int3(x, 1, 0), Int3(x, 1, 2)})
            model.hexel_held.clear(model.hexels.index(side));
    model.hexel_held.set(model.hexels.index(0, 1, 1));
    model.thermal.phase_model = tissue::PhaseModel::threshold;
    model.thermal.held_transfer_W_per_m2K = 1e9;
    model.thermal.gas_transfer_W_per_m2K = 0.0;
    HeatRun run(std::move(model));
    for (int k = 0; k < n; ++k)
        run.state.enthalpy_J_per_m3[static_cast<std::size_t>(bar_cell(run.model, k))] =
            static_cast<float>(rho_c * 63.0 + latent * (1.0 - 1e-6));
    run.start();
    const double lambda = stefan_lambda(rho_c * 63.0 / latent);
    run.run(static_cast<int>(std::lround(std::pow(0.5 * length / (2.0 * lambda), 2.0) / a / run.model.tick_s)));
    const double t = static_cast<double>(run.state.tick) * run.model.tick_s;
    double front = 0.0;
    for (int k = 0; k < n; ++k) {
        const auto h = static_cast<std::size_t>(bar_cell(run.model, k));
        const double held = std::max(static_cast<double>(run.state.enthalpy_J_per_m3[h]) - rho_c * 63.0, 0.0);
        front += s * (1.0 - held / latent);
    }
    return std::abs(front / (2.0 * lambda * std::sqrt(a * t)) - 1.0);
}

}  // namespace

// The front moves cell by cell, and how far it has come within a cell is known only while that cell boils: errors are
// of first order in s_h at least.
TEST(Stefan, ThresholdFrontFollowsTheSimilaritySolution) {
    const double coarse = threshold_front_error(20), fine = threshold_front_error(80);
    EXPECT_LT(coarse, 2e-3);
    EXPECT_LT(fine, 5e-4);
    EXPECT_LT(fine, 0.5 * coarse);
}

}  // namespace calot::thermal

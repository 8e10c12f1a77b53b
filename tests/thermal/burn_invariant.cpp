// What holds in every burn: energy and mass are kept, nothing gets hotter than its neighbours without heat.

#include "thermal/burn_bodies.h"

namespace calot::thermal {

namespace {

void expect_closed_budget(tissue::PhaseModel phase) {
    HeatRun run(burn_model({40, 34, 22}, phase));
    double steam_kg = 0.0, smoke_kg = 0.0, water_before = 0.0, water_after = 0.0;
    const auto water = [&] {
        double sum = 0.0;
        for (std::int64_t i = run.model.hexels.first; i < run.model.hexels.last; ++i)
            if (run.state.hexel_present.test(i))
                sum += static_cast<double>(run.state.water_kg_per_m3[static_cast<std::size_t>(i)]);
        return sum * run.model.hexel_volume_m3();
    };
    water_before = water();
    const std::int64_t hexels = run.state.hexel_present.count();
    while (run.state.tick < 2000) {
        burn_tick(run);
        for (const tissue::GasEvent& e : run.exchange.gas) {
            steam_kg += static_cast<double>(e.steam_kg);
            smoke_kg += static_cast<double>(e.smoke_kg);
        }
        ASSERT_TRUE(std::is_sorted(run.exchange.removed_hexels.begin(), run.exchange.removed_hexels.end()));
    }
    water_after = water();
    const tissue::EnergyBudget& e = run.state.energy_J;
    EXPECT_GT(run.state.hexels_burnt, 20);
    EXPECT_EQ(hexels - run.state.hexel_present.count(), run.state.hexels_burnt);
    EXPECT_NEAR(e.outflow, 16.0, 1e-5) << "10 W for 1.6 s";
    EXPECT_GT(e.surface, 1e-3 * e.delivered);
    EXPECT_GT(e.perfusion, 0.0);
    EXPECT_GT(e.latent, 0.1 * e.delivered);
    EXPECT_LT(e.latent, e.gas);
    EXPECT_LT(std::abs(run.imbalance()), 1e-6) << "burnt " << run.state.hexels_burnt << " delivered " << e.delivered;
    if (phase == tissue::PhaseModel::water_then_solids) {
        EXPECT_NEAR(steam_kg, water_before - water_after, 1e-5 * steam_kg);
    }
    EXPECT_GT(smoke_kg, 0.0);
    EXPECT_TRUE(run.state.status.ok);
}

}  // namespace

TEST(Burn, EnergyAndWaterAreKept) {
    expect_closed_budget(tissue::PhaseModel::water_then_solids);
}
TEST(Burn, EnergyIsKeptWithAThreshold) {
    expect_closed_budget(tissue::PhaseModel::threshold);
}

TEST(Burn, MaximumPrinciple) {
    // Without sources no temperature leaves the range of those before, for any mix of tissues at the longest stable
    // step.
    tissue::Model model = burn_model();
    insulate(model);
    for (auto& m : model.materials) bloodless(m);
    model.tick_s = 0.99 * static_cast<double>(Properties::make(model).longest_step_s) / model.thermal.refresh_ticks;
    HeatRun run(std::move(model));
    EXPECT_EQ(run.work.substeps, 1);
    Random random(7);
    for (std::int64_t i = run.model.hexels.first; i < run.model.hexels.last; ++i)
        if (run.state.hexel_present.test(i)) run.heat(i, 310.15 + random.uniform(0.0, 60.0));
    run.start();
    auto range = [&] {
        std::pair<double, double> r{1e9, -1e9};
        for (std::int64_t i = run.model.hexels.first; i < run.model.hexels.last; ++i)
            if (run.state.hexel_present.test(i)) {
                r.first = std::min(r.first, run.rise_K(i));
                r.second = std::max(r.second, run.rise_K(i));
            }
        return r;
    };
    auto before = range();
    for (int k = 0; k < 40; ++k) {
        run.tick();
        const auto after = range();
        ASSERT_GE(after.first, before.first - 1e-4);  // the last digit of a temperature is 3e-5 K
        ASSERT_LE(after.second, before.second + 1e-4);
        before = after;
        for (int skip = 1; skip < run.model.thermal.refresh_ticks; ++skip) run.tick();
    }
    EXPECT_LT(before.second - before.first, 40.0);
}

TEST(Burn, LongStepsAreSubdivided) {
    tissue::Model model = burn_model();
    model.tick_s = 0.1;  // 0.4 s per heat step, beyond what is stable
    HeatRun run(std::move(model));
    EXPECT_GT(run.work.substeps, 1);
    run.heat(run.model.hexels.index(10, 10, 10), 360.0);
    run.start();
    run.run(100);
    for (std::int64_t i = run.model.hexels.first; i < run.model.hexels.last; ++i)
        if (run.state.hexel_present.test(i)) {
            ASSERT_GE(run.rise_K(i), -1e-4);
            ASSERT_LE(run.rise_K(i), 50.0);
        }
}

TEST(Burn, UniformTemperatureIsAnEquilibrium) {
    tissue::Model model = burn_model();
    insulate(model);
    for (auto& m : model.materials) bloodless(m);
    HeatRun run(std::move(model));
    for (std::int64_t i = run.model.hexels.first; i < run.model.hexels.last; ++i)
        if (run.state.hexel_present.test(i)) run.heat(i, 350.0);
    run.start();
    run.run(2000);
    for (std::int64_t i = run.model.hexels.first; i < run.model.hexels.last; ++i)
        if (run.state.hexel_present.test(i)) {
            ASSERT_NEAR(run.rise_K(i), 39.85, 1e-4);
        }
}

TEST(Burn, ColdTissueStaysUntouched) {
    HeatRun run(burn_model());
    const std::uint64_t before = tissue::hash(run.state);
    run.run(400);
    run.state.tick = 0;
    EXPECT_EQ(tissue::hash(run.state), before);
    EXPECT_EQ(run.work.active.count(), 0);
}

TEST(Burn, TroubleIsReported) {
    HeatRun run(burn_model());
    const std::int64_t cell = run.model.hexels.index(20, 10, 10);
    run.state.enthalpy_J_per_m3[static_cast<std::size_t>(cell)] = std::numeric_limits<float>::quiet_NaN();
    run.start();
    run.run(run.model.thermal.refresh_ticks);
    EXPECT_FALSE(run.state.status.ok);
    EXPECT_STREQ(run.state.status.field, "enthalpy");
    EXPECT_LT(run.state.status.tick, run.model.thermal.refresh_ticks);
}

TEST(Burn, InjuriesAddUp) {
    HeatRun run(burn_model());
    while (run.state.tick < 2000) burn_tick(run);
    std::int64_t present = 0, removed = 0, damaged = 0;
    double hottest = 0.0;
    for (const MaterialInjury& injury : injuries(run.model, run.state)) {
        present += injury.present_hexels;
        removed += injury.removed_hexels;
        damaged += injury.damaged_hexels;
        hottest = std::max(hottest, injury.peak_temperature_K);
        EXPECT_NEAR(injury.damaged_volume_m3, static_cast<double>(injury.damaged_hexels) * 0.216e-9, 1e-15);
        EXPECT_LE(injury.damaged_hexels, injury.present_hexels);
    }
    EXPECT_EQ(present, run.state.hexel_present.count());
    EXPECT_EQ(removed, run.state.hexels_burnt);
    EXPECT_GT(damaged, 0);
    EXPECT_NEAR(hottest, run.model.materials[1].removal_temperature_K, 1e-3);  // where its solids turn to gas
}

}  // namespace calot::thermal

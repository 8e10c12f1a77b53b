// A heat step is spread over ticks: budgets close in between, hexels go a few at a time, crumbs may fall at any moment.

#include "thermal/burn_bodies.h"

namespace calot::thermal {

TEST(Schedule, BudgetClosesAtEveryTick) {
    HeatRun run(burn_model());
    for (int k = 0; k < 1200; ++k) {
        burn_tick(run);
        ASSERT_LT(std::abs(run.imbalance()), 2e-6) << "tick " << run.state.tick;
        if (run.state.tick % run.model.thermal.refresh_ticks == 0) {
            ASSERT_EQ(run.state.energy_J.transit, 0.0);
        }
    }
    EXPECT_GT(run.state.hexels_burnt, 10);
}

TEST(Schedule, CrumbsMayFallInTheMiddleOfAStep) {
    HeatRun run(burn_model());
    Random random(3);
    const Lattice& lattice = run.model.hexels;
    while (run.state.tick < 1000) {
        burn_tick(run);
        // As deformation drops them, after heat, in any tick.
        for (int n = 0; n < 3; ++n) {
            const auto cell = lattice.first + static_cast<std::int64_t>(
                                                  random.uniform() * static_cast<double>(lattice.last - lattice.first));
            if (!run.state.hexel_present.test(cell)) continue;
            float& enthalpy = run.state.enthalpy_J_per_m3[static_cast<std::size_t>(cell)];
            run.state.energy_J.debris += static_cast<double>(enthalpy) * run.model.hexel_volume_m3();
            enthalpy = 0.0f;
            run.state.hexel_present.clear(cell);
            ++run.state.hexels_fallen;
        }
    }
    EXPECT_GT(run.state.hexels_fallen, 500);
    EXPECT_LT(std::abs(run.imbalance()), 1e-6);
    for (std::int64_t i = lattice.first; i < lattice.last; ++i)
        if (!run.state.hexel_present.test(i)) {
            ASSERT_EQ(run.state.enthalpy_J_per_m3[static_cast<std::size_t>(i)], 0.0f) << i;
        }
}

TEST(Schedule, HexelsGoAFewAtATime) {
    HeatRun run(burn_model());
    // A plate of hexels that are all gas.
    int plate = 0;
    for (int x = 10; x < 20; ++x)
        for (int y = 10; y < 20; ++y, ++plate) {
            const auto cell = static_cast<std::size_t>(run.model.hexels.index(x, y, 14));
            run.state.water_kg_per_m3[cell] = 0.0f;
            run.state.enthalpy_J_per_m3[cell] = 1.5e9f;
        }
    run.start();
    int ticks = 0;
    for (; run.state.hexels_burnt < plate && ticks < 100; ++ticks) {
        const std::int64_t before = run.state.hexels_burnt;
        run.tick();
        ASSERT_LE(run.state.hexels_burnt - before, (plate + 3) / 4);
    }
    EXPECT_LE(ticks, 2 * run.model.thermal.refresh_ticks);
}

TEST(Schedule, CoagulatedTissueHasNoBlood) {
    // Equal warmth, with and without damage; only living tissue is cooled by its blood.
    const auto all = tissue::default_materials();
    double left[3];
    for (const int damage : {0, 1, 2}) {
        tissue::Model model = box_model({3, 3, 3}, 0.6e-3, 4e-3, {all[tissue::find_material(all, "liver")]});
        insulate(model);
        HeatRun run(std::move(model));
        for (std::int64_t i = run.model.hexels.first; i < run.model.hexels.last; ++i)
            if (run.state.hexel_present.test(i)) {
                run.heat(i, 314.0);  // below what damages
                run.state.damage[static_cast<std::size_t>(i)] = 0.5f * static_cast<float>(damage);
            }
        run.start();
        run.run(1000);
        left[damage] = run.rise_K(run.model.hexels.index(1, 1, 1)) / 3.85;
    }
    const tissue::Material& liver = all[tissue::find_material(all, "liver")];
    const tissue::ThermalParameters thermal;
    const double rate = liver.perfusion_m3_per_s_kg * liver.density_kg_per_m3 * thermal.blood_density_kg_per_m3 *
                        thermal.blood_specific_heat_J_per_kgK /
                        (liver.density_kg_per_m3 * liver.specific_heat_J_per_kgK);
    EXPECT_NEAR(left[0], std::exp(-4.0 * rate), 2e-3);
    EXPECT_NEAR(left[1], std::exp(-4.0 * rate * 0.5), 2e-3) << "half of the blood at Omega = 1/2";
    EXPECT_NEAR(left[2], 1.0, 1e-5);
}

TEST(Schedule, StreamingBloodCoolsTheArtery) {
    const auto all = tissue::default_materials();
    const tissue::Material& artery = all[tissue::find_material(all, "cystic_artery")];
    tissue::Model model = box_model({3, 3, 3}, 0.6e-3, 4e-3, {artery});
    insulate(model);
    HeatRun run(std::move(model));
    for (std::int64_t i = run.model.hexels.first; i < run.model.hexels.last; ++i)
        if (run.state.hexel_present.test(i)) run.heat(i, 314.0);
    run.start();
    run.run(250);
    const double rate = artery.vessel_transfer_W_per_m3K / (artery.density_kg_per_m3 * artery.specific_heat_J_per_kgK);
    EXPECT_GT(rate, 0.5);
    EXPECT_NEAR(run.rise_K(run.model.hexels.index(1, 1, 1)) / 3.85, std::exp(-rate), 3e-3);
    EXPECT_GT(run.state.energy_J.perfusion, 0.0);
}

}  // namespace calot::thermal

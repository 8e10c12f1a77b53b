// Conduction and surroundings against closed forms; more of them: calot/validation/heat.cpp.

#include <gtest/gtest.h>

#include "calot/validation/heat_rig.h"

namespace calot::thermal {

TEST(Conduction, PerfusedTissueDecaysExponentially) {
    // Pennes: k T'' = w (T - T_a), flux q at one end: T - T_a = q / (k m) exp(-m x), m = sqrt(w / k).
    tissue::Material material = plain_material();
    material.perfusion_m3_per_s_kg = 2e-4;
    const int n = 80;
    const double s = 0.2e-3, dt = 0.05;
    tissue::Model model = bar_model(n, s, dt, {material});
    insulate(model);
    const double w =
        2e-4 * 1000.0 * model.thermal.blood_density_kg_per_m3 * model.thermal.blood_specific_heat_J_per_kgK;
    const double m = std::sqrt(w / 0.5), flux = 2e4;
    HeatRun run(std::move(model));
    run.set_joule({1, 1, 1}, {1, 1, 1}, [&](const Int3&) { return flux / s; });
    run.run(static_cast<int>(12.0 * 4e6 / w / dt));  // twelve times the slowest time constant rho c / w
    for (int k = 0; k < 40; ++k) {
        const double exact = flux / (0.5 * m) * std::exp(-m * (k + 0.5) * s);
        // (m s)^2 = 0.06: second-order error of the source cell and of the decay.
        EXPECT_NEAR(run.rise_K(bar_cell(run.model, k)), exact, 0.02 * flux / (0.5 * m)) << k;
    }
    const tissue::EnergyBudget& e = run.state.energy_J;
    EXPECT_GT(e.perfusion, 0.5 * e.delivered);
    EXPECT_LT(std::abs(run.imbalance()), 1e-4);  // at rest most of a step's change is below H's last digit
}

TEST(Conduction, FluxAcrossTwoTissuesIsThatOfTheirSeries) {
    // Hot gas | k1 | k2 | held at body temperature: q = dT / (L1/k1 + L2/k2) once steady.
    tissue::Material one = plain_material("one"), two = plain_material("two");
    one.thermal_conductivity_W_per_mK = 0.2;
    two.thermal_conductivity_W_per_mK = 0.8;
    const int n = 16;
    const double s = 0.5e-3;
    tissue::Model model =
        bar_model(n, s, 0.05, {one, two}, [](int k) { return static_cast<tissue::MaterialIndex>(k < 6 ? 1 : 2); });
    for (int x = 1; x <= n; ++x)  // sides face nothing that exchanges: neither gas nor held exist there
        for (const Int3 side : {Int3(x, 0, 1), Int3(x, 2, 1), Int3(x, 1, 0), Int3(x, 1, 2)})
            model.hexel_held.clear(model.hexels.index(side));
    model.hexel_held.set(model.hexels.index(n + 1, 1, 1));
    model.thermal.gas_temperature_K = model.thermal.body_temperature_K + 50.0;
    model.thermal.gas_transfer_W_per_m2K = 0.0;
    model.thermal.held_transfer_W_per_m2K = 1e9;
    HeatRun run(std::move(model));
    const double flux = 1e3;
    run.set_joule({1, 1, 1}, {1, 1, 1}, [&](const Int3&) { return flux / s; });
    run.run(20000);
    // From the held end, over half cells: rise = flux * resistance in between.
    for (int k = 0; k < n; ++k) {
        double resistance = 0.0;
        for (int j = k; j < n; ++j) resistance += (j == k ? 0.5 : 1.0) * s / (j < 6 ? 0.2 : 0.8);
        EXPECT_NEAR(run.rise_K(bar_cell(run.model, k)), flux * resistance, 5e-3 * flux * resistance) << k;
    }
}

TEST(Conduction, OneHexelCoolsExponentially) {
    tissue::Model model = box_model({1, 1, 1}, 0.6e-3, 0.01, {plain_material()});
    model.thermal.gas_temperature_K = model.thermal.body_temperature_K;
    HeatRun run(std::move(model));
    const std::int64_t cell = run.model.hexels.index(0, 0, 0);
    run.heat(cell, run.model.thermal.body_temperature_K + 40.0);
    run.start();
    run.run(2000);
    const double h = 1.0 / (1.0 / 20.0 + 0.3e-3 / 0.5);
    const double exact = 40.0 * std::exp(-6.0 * h / (0.6e-3 * 4e6) * 20.0);
    EXPECT_NEAR(run.rise_K(cell), exact, 1e-3 * exact);  // explicit Euler: rate * dt / 2 per unit of exponent
}

TEST(Conduction, GasCoolsOnlyDownToBodyTemperature) {
    tissue::Model model = box_model({4, 4, 4}, 0.6e-3, 0.01, {plain_material()});
    HeatRun run(std::move(model));
    const std::int64_t warm = run.model.hexels.index(1, 1, 1);
    run.heat(warm, run.model.thermal.body_temperature_K + 1.0);
    run.start();
    run.run(100000);
    for (int z = 0; z < 4; ++z)
        for (int y = 0; y < 4; ++y)
            for (int x = 0; x < 4; ++x) EXPECT_GE(run.rise_K(run.model.hexels.index(x, y, z)), -1e-4);
    EXPECT_LT(run.rise_K(warm), 1e-3);
    EXPECT_GT(run.state.energy_J.surface, 0.0);
}

}  // namespace calot::thermal

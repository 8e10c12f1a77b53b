// Arrhenius damage against times to Omega = 1 at constant temperature: exp(Ea/(R T)) / A.

#include <gtest/gtest.h>

#include "calot/validation/heat_rig.h"

namespace calot::thermal {

namespace {

/// Time until Omega = 1 of a hexel that stays at a temperature [s].
double time_to_damage_s(const char* name, double celsius, double step_s) {
    const auto materials = tissue::default_materials();
    tissue::Material m = materials[tissue::find_material(materials, name)];
    bloodless(m);
    m.thermal_conductivity_W_per_mK = 0.0;
    tissue::Model model = box_model({1, 1, 1}, 0.6e-3, step_s, {m});
    insulate(model);
    HeatRun run(std::move(model));
    const std::int64_t cell = run.model.hexels.index(0, 0, 0);
    run.heat(cell, kelvin_from_celsius(celsius));
    run.start();
    const float& damage = run.state.damage[static_cast<std::size_t>(cell)];
    while (damage < 1.0f && run.state.tick < 1'000'000) run.tick();
    // Between the last two steps damage grew by the same amount as ever.
    return static_cast<double>(run.state.tick) * step_s / static_cast<double>(damage);
}

}  // namespace

TEST(Damage, TimesAreThoseOfTheRateInDouble) {
    const auto materials = tissue::default_materials();
    for (const char* name : {"liver", "cystic_artery", "cystic_duct"})
        for (const double celsius : {45.0, 52.0, 63.0, 77.0, 91.0, 99.0}) {
            const tissue::Material& m = materials[tissue::find_material(materials, name)];
            const double exact =
                std::exp(m.arrhenius_energy_J_per_mol / (kGasConstant_J_per_molK * kelvin_from_celsius(celsius)) -
                         std::log(m.arrhenius_frequency_per_s));
            // Temperatures are good to 3e-5 K, which is 2e-5 of the steepest rate; single precision sums do the rest.
            EXPECT_NEAR(time_to_damage_s(name, celsius, exact / 100.0), exact, 2e-4 * exact) << name << ' ' << celsius;
        }
}

TEST(Damage, SaturatesAndStaysZeroInTheCold) {
    const auto materials = tissue::default_materials();
    tissue::Material artery = materials[tissue::find_material(materials, "cystic_artery")];
    tissue::Model model = box_model({2, 1, 1}, 0.6e-3, 4e-3, {artery});
    insulate(model);
    model.materials[1].thermal_conductivity_W_per_mK = 0.0;
    HeatRun run(std::move(model));
    run.heat(run.model.hexels.index(0, 0, 0), 373.0);
    run.heat(run.model.hexels.index(1, 0, 0), 316.0);
    run.start();
    run.run(200000);
    EXPECT_EQ(run.state.damage[static_cast<std::size_t>(run.model.hexels.index(0, 0, 0))], 1e6f);
    EXPECT_EQ(run.state.damage[static_cast<std::size_t>(run.model.hexels.index(1, 0, 0))], 0.0f);
}

}  // namespace calot::thermal

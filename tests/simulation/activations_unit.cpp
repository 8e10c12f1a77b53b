// What each press of the pedal did.

#include "calot/simulation/activations.h"

#include <gtest/gtest.h>

#include "simulation/test_setups.h"

namespace calot::simulation {

TEST(Activations, AreMeasuredOneByOne) {
    const auto setup = burnt_block_setup();
    Simulation run(setup);
    ActivationWatch watch(run.model());
    std::int64_t removed = 0;
    while (run.time_s() < setup->duration_s) {
        const tissue::Input input = setup->script.at(run.time_s());
        ASSERT_TRUE(run.tick(input));
        watch.look(run, input);
        removed += static_cast<std::int64_t>(run.work().exchange.removed_hexels.size());
    }
    watch.finish(run);
    const std::vector<Activation>& all = watch.activations();
    ASSERT_EQ(all.size(), setup->script.bursts().size());
    double energy_J = 0.0;
    std::int64_t counted = 0;
    for (std::size_t k = 0; k < all.size(); ++k) {
        const Activation& a = all[k];
        EXPECT_NEAR(a.start_s, setup->script.bursts()[k].from_s, 1.1e-3);
        EXPECT_NEAR(a.stop_s, setup->script.bursts()[k].to_s, 1.1e-3);
        EXPECT_EQ(a.power_setting_W, setup->script.bursts()[k].power_W);
        EXPECT_EQ(a.from_cut, a.hexels_removed > 0);
        energy_J += a.energy_J;
        counted += a.hexels_removed;
        // Cooler levels reach at least as far; damage of fat at these times lies between 50 and 90 C.
        EXPECT_GE(a.spread_m[0], a.spread_m[1]);
        EXPECT_GE(a.spread_m[1], a.spread_m[2]);
        EXPECT_GE(a.spread_m[2], run.model().hexels.spacing_m);
        EXPECT_LE(a.spread_m[0], 8e-3);
        EXPECT_GT(a.spread_m[3], 0.0);
        EXPECT_LE(a.spread_m[3], a.spread_m[1]);
        EXPECT_GT(a.tip_temperature_K, 310.2) << "what burns heats the wire";
    }
    EXPECT_NEAR(energy_J, run.state().energy_J.delivered, 1e-2 * energy_J);  // a heat step's end after the release
    EXPECT_EQ(counted, removed);
}

TEST(Activations, InTheAirDoNothing) {
    auto setup = burnt_block_setup();
    setup->script = Script(Vec3(0.0, -0.08, 0.14), {{0.0, Vec3(0.0, 0.0, 0.01), 0.0}},
                           {{0.01, 0.03, 40.0, tissue::GeneratorMode::cut}});
    Simulation run(setup);
    ActivationWatch watch(run.model());
    for (int k = 0; k < 50; ++k) {
        const tissue::Input input = setup->script.at(run.time_s());
        run.tick(input);
        watch.look(run, input);
    }
    watch.finish(run);
    ASSERT_EQ(watch.activations().size(), 1u);
    EXPECT_EQ(watch.activations()[0].hexels_removed, 0);
    EXPECT_EQ(watch.activations()[0].energy_J, 0.0);
    for (const double spread_m : watch.activations()[0].spread_m) EXPECT_EQ(spread_m, 0.0);
}

}  // namespace calot::simulation

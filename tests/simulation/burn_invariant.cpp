// A whole burn of a fat block: budgets close, the surface stays closed, nothing is lost.

#include <gtest/gtest.h>

#include "calot/base/parallel.h"
#include "calot/simulation/simulation.h"
#include "calot/surface/surface.h"
#include "simulation/test_setups.h"
#include "support/allocations.h"

namespace calot::simulation {

TEST(Burn, BudgetsCloseAndTheSurfaceStaysClosed) {
    const auto setup = burnt_block_setup();
    Simulation run(setup);
    const std::int64_t hexels_before = run.state().hexel_present.count();
    double peak_force_N = 0.0;
    std::uint64_t version = 0;
    int checks = 0;
    while (run.time_s() < setup->duration_s) {
        ASSERT_TRUE(run.tick(setup->script.at(run.time_s())))
            << run.state().status.field << " at tick " << run.state().status.tick;
        peak_force_N = std::max(peak_force_N, glm::length(run.state().hook_force_N));
        if (run.surface().version() != version && run.state().tick % 8 == 0) {
            version = run.surface().version();
            const surface::MeshCheck check = surface::check(run.surface().rest_mesh());
            ASSERT_TRUE(check.closed) << "tick " << run.state().tick << ": " << check.open_edges << " open, "
                                      << check.nonmanifold_edges << " non-manifold edges";
            ++checks;
        }
    }
    const tissue::State& state = run.state();
    EXPECT_GT(checks, 5);
    EXPECT_GT(state.hexels_burnt, 20) << "60 W into fat must remove some";
    EXPECT_EQ(hexels_before - state.hexel_present.count(), state.hexels_burnt + state.hexels_fallen);
    EXPECT_GT(state.energy_J.delivered, 1.0);
    EXPECT_LT(std::abs(run.energy_imbalance()), 1e-3);  // the specification's bound
    EXPECT_GT(peak_force_N, 0.005);
    EXPECT_LT(peak_force_N, 2.0);
}

// One thread: oneTBB allocates its own tasks.
TEST(Burn, TicksAllocateNothing) {
    const ThreadLimit limit(1);
    const auto setup = burnt_block_setup();
    Simulation run(setup);
    long allocated = 0;
    while (run.time_s() < setup->duration_s) {
        const tissue::Input input = setup->script.at(run.time_s());
        const long before = calot::test::allocations();
        run.tick(input);
        allocated += calot::test::allocations() - before;
    }
    EXPECT_GT(run.state().hexels_burnt, 20);
    EXPECT_EQ(allocated, 0);
}

TEST(Burn, ColdPressLeavesNoTrace) {
    auto setup = burnt_block_setup();
    setup->script = Script(setup->script.trocar_m(), setup->script.keyframes(), {});
    Simulation run(setup);
    while (run.time_s() < setup->duration_s) ASSERT_TRUE(run.tick(setup->script.at(run.time_s())));
    EXPECT_EQ(run.state().hexels_burnt, 0);
    EXPECT_EQ(run.state().hexels_fallen, 0);
    EXPECT_EQ(run.state().energy_J.delivered, 0.0);
    EXPECT_EQ(run.state().links_severed, 0);
}

}  // namespace calot::simulation

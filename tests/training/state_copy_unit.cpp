// A copy that is brought up to date piece by piece is the state to the last bit, however heat and hexels come and go.

#include <gtest/gtest.h>

#include "calot/training/state_copy.h"
#include "setups.h"

namespace calot::training {
namespace {

/// Ticks a run that burns; compares every `interval` ticks, after `pieces` ticks with a piece each.
void expect_faithful(simulation::Simulation& run, StateCopy& copy, std::int64_t until, std::int64_t interval,
                     std::int64_t pieces) {
    while (run.state().tick < until) {
        ASSERT_TRUE(run.tick(run.setup().script.at(run.time_s())));
        copy.after_tick(run);
        const std::int64_t left = (interval - run.state().tick % interval) % interval;
        if (left > 0 && left <= pieces) copy.go_on(run);
        if (left > 0) continue;
        copy.bring_up_to_date(run);
        ASSERT_EQ(tissue::hash(copy.state()), tissue::hash(run.state())) << "at tick " << run.state().tick;
    }
}

TEST(StateCopy, IsTheStateToTheLastBit) {
    simulation::Simulation run(test::coarse_setup());
    StateCopy copy(run.state());
    expect_faithful(run, copy, 800, 40, 24);
    expect_faithful(run, copy, 1200, 24, 5);
    EXPECT_GT(run.state().hexels_burnt, 5);
}

TEST(StateCopy, OfARunThatGoesOnBeginsWithAllOfIt) {
    simulation::Simulation first(test::coarse_setup());
    while (first.state().tick < 640) first.tick(first.setup().script.at(first.time_s()));
    const tissue::State fresh = simulation::Simulation(test::coarse_setup()).state();
    simulation::Simulation run(test::coarse_setup(), first.state());
    StateCopy copy(fresh);
    expect_faithful(run, copy, 1000, 40, 24);
}

}  // namespace
}  // namespace calot::training

// A run that is saved at a multiple of Model::frame_ticks goes on bit for bit.

#include <cstring>

#include <gtest/gtest.h>

#include "calot/base/error.h"
#include "calot/simulation/simulation.h"
#include "simulation/test_setups.h"

namespace calot::simulation {

namespace {

/// A copy by way of tissue::fields alone, as a file would make it.
tissue::State through_fields(const tissue::Model& model, const tissue::State& state) {
    tissue::State copy = tissue::State::make(model);
    tissue::State source = state;
    const auto from = tissue::fields(source), to = tissue::fields(copy);
    for (std::size_t f = 0; f < from.size(); ++f) std::memcpy(to[f].data, from[f].data, from[f].bytes);
    return copy;
}

void run_to(Simulation& run, std::int64_t tick) {
    while (run.state().tick < tick) ASSERT_TRUE(run.tick(run.setup().script.at(run.time_s())));
}

}  // namespace

// Pressing, burning, dragging while burning, after the pedal is released.
TEST(Restore, GoesOnBitForBit) {
    const auto setup = burnt_block_setup();
    Simulation run(setup);
    for (const std::int64_t saved : {200, 408, 800, 1048, 1480}) {
        ASSERT_EQ(saved % run.model().frame_ticks, 0);
        run_to(run, saved);
        Simulation again(setup, through_fields(run.model(), run.state()));
        ASSERT_EQ(tissue::hash(again.state()), tissue::hash(run.state()));
        const std::int64_t end = saved + 101;
        run_to(again, end);
        run_to(run, end);
        EXPECT_EQ(tissue::hash_fields(again.state()), tissue::hash_fields(run.state())) << "saved at tick " << saved;
    }
    EXPECT_GT(run.state().hexels_burnt, 5);
}

TEST(Restore, RefusesWhatDoesNotFit) {
    const auto setup = burnt_block_setup();
    Simulation run(setup);
    run_to(run, 3);
    EXPECT_THROW(Simulation(setup, run.state()), InputError) << "in the middle of a frame";
    tissue::State other = tissue::State::make(run.model());
    other.enthalpy_J_per_m3.resize(other.enthalpy_J_per_m3.size() - 1);
    EXPECT_THROW(Simulation(setup, std::move(other)), InputError) << "another scene's";
}

}  // namespace calot::simulation

#pragma once
// A copy of a running State that is brought up to date a little each tick, so that no tick waits for a whole one.
//
// Nearly all of State are four arrays over the hexels. Of those a tick changes only the blocks that have their turn in
// the heat step, and the hexels that go; what those left behind is booked when the step ends (calot/thermal/heat.h). So
// the copy is exact at ticks that can be stored, where no step is under way.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "calot/simulation/simulation.h"
#include "calot/thermal/blocks.h"
#include "calot/tissue/state.h"

namespace calot::training {

class StateCopy {
  public:
    /// `initial`: the simulation's state at tick 0.
    explicit StateCopy(const tissue::State& initial);

    /// After every tick: notes what it changed.
    void after_tick(const simulation::Simulation& run);
    /// Copies some of what changed. state() is then of no moment at all, until ...
    void go_on(const simulation::Simulation& run);
    /// ... state() is made the run's. All of it is copied the first time of a run that did not begin at tick 0, else
    /// what is left.
    void bring_up_to_date(const simulation::Simulation& run);
    const tissue::State& state() const { return state_; }

  private:
    void start(const simulation::Simulation& run);
    void note(const simulation::Simulation& run, std::int64_t hexel);
    void copy_blocks(const simulation::Simulation& run, std::size_t most);

    tissue::State state_;
    thermal::BlockSet changed_;
    std::vector<std::int64_t> gone_;  ///< hexels that went since the heat step began
    bool whole_ = false;              ///< state() was the run's when changed_ was empty
};

}  // namespace calot::training

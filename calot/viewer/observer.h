#pragma once
// Watches a session from inside its physics thread: scores, recordings, tasks.

#include "calot/simulation/simulation.h"
#include "calot/tissue/input.h"

namespace calot::viewer {

class Observer {
  public:
    virtual ~Observer() = default;
    /// Before the first tick.
    virtual void begin(const simulation::Simulation& run) { static_cast<void>(run); }
    /// After every tick, within its millisecond: must be cheap, and neither wait nor throw.
    virtual void after_tick(const simulation::Simulation& run, const tissue::Input& input) = 0;
    /// After the last tick: the session stops.
    virtual void end(const simulation::Simulation& run) { static_cast<void>(run); }
};

}  // namespace calot::viewer

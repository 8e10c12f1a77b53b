#pragma once
// Watches a run tick by tick and keeps what a TickResult needs, without allocating while it runs.

#include <algorithm>
#include <cstdint>
#include <vector>

#include "bench_results.h"
#include "calot/simulation/simulation.h"

namespace calot::app {

class TickWatch {
  public:
    /// Room for so many ticks.
    explicit TickWatch(std::int64_t ticks);

    /// One tick, timed.
    bool tick(simulation::Simulation& run, const tissue::Input& input);
    /// Another pass over the scene has taken so long in a tick.
    void again(std::size_t tick, double us) { least_us_[tick] = std::min(least_us_[tick], static_cast<float>(us)); }
    std::size_t ticks() const { return us_.size(); }
    /// Once the first pass is over.
    void begin_passes() { least_us_ = us_; }
    void finish(const simulation::Simulation& run, TickResult& result) const;

  private:
    void note_event(const simulation::Simulation& run, const tissue::Input& input, double us, std::int64_t removed,
                    std::int64_t severed);

    std::vector<float> us_, least_us_;
    std::array<std::vector<float>, simulation::kStages> stages_us_;
    std::vector<std::uint8_t> pedal_;
    std::vector<std::uint16_t> removed_;
    std::vector<TickEvent> worst_;
    double tick_s_ = 1e-3;
    std::int64_t removed_before_ = 0, severed_before_ = 0;
};

}  // namespace calot::app

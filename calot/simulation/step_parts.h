#pragma once
// What the ticks of all backends have in common: times of stages, and what is on the host always.

#include <chrono>

#include "calot/deformation/embedding.h"
#include "calot/simulation/step.h"

namespace calot::simulation {

/// Wall time of each stage. It is shown to people and never flows back into the state.
class StageClock {
  public:
    explicit StageClock(std::array<float, kStages>& stage_us) : stage_us_(stage_us), last_(Clock::now()) {}
    void restart() { last_ = Clock::now(); }
    void lap(Stage stage) {
        const auto now = Clock::now();
        stage_us_[static_cast<std::size_t>(stage)] = std::chrono::duration<float, std::micro>(now - last_).count();
        last_ = now;
    }

  private:
    using Clock = std::chrono::steady_clock;
    std::array<float, kStages>& stage_us_;
    Clock::time_point last_;
};

/// At the beginning of a tick: what the last one handed over goes.
void clear_exchange(tissue::Exchange& exchange);
/// Capsules of hook and grasper, and how far its jaw closes.
void place_instruments(const tissue::Model& model, const tissue::State& state, Work& work, const tissue::Input& input);
/// Which hexels are embedded and offered to contact, current, the hot wire and the jaws.
deformation::NearReach near_reach(const tissue::Model& model, const tissue::State& state,
                                  const tissue::Exchange& exchange, const tissue::Input& input);
/// Contacts of the near hexels, and what the grasper takes hold of.
void find_contacts(const tissue::Model& model, tissue::State& state, Work& work);
/// After the tissue has moved: poses for the next tick's velocities, forces.
void remember_instruments(tissue::State& state, const tissue::Exchange& exchange, const tissue::Input& input);
/// Where this tick's gas came from, at rest: the sources of Work::gas, with room for their world_m.
void list_gas(const tissue::Model& model, Work& work);
/// Once the sources are placed in the world: all events, shifted from their sources as at rest.
void place_gas(const tissue::Model& model, Work& work);

}  // namespace calot::simulation

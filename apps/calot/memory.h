#pragma once
// What a scene takes in memory: everything that Model, State and the rooms' Work hold.

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "calot/simulation/setup.h"
#include "calot/tissue/state.h"

namespace calot::app {

struct MemoryUse {
    std::int64_t model = 0, state = 0, work = 0;
    std::int64_t pictures = 0;    ///< beside these: compact and smoothed meshes, made when a picture asks for them
    std::int64_t of_hexels = 0;   ///< model, state and work that belong to hexels: all but deformation
    std::int64_t of_phyxels = 0;  ///< that belong to phyxels: deformation
    std::vector<std::pair<std::string, std::int64_t>> work_of_rooms;

    std::int64_t all() const { return model + state + work; }
};

/// Counts arrays of model and state one by one, and what the rooms allocate when they set up. `state` is a fresh one
/// with its initial links severed.
MemoryUse memory_use(const simulation::Setup& setup, const tissue::State& state);

}  // namespace calot::app

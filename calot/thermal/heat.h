#pragma once
// Heat: conduction, surroundings, boiling, gasification, damage (docs/physics.md section 6).

#include <cstdint>
#include <vector>

#include "calot/base/array.h"
#include "calot/tissue/exchange.h"
#include "calot/tissue/state.h"

namespace calot::thermal {

/// Scratch. `temperature_K` is current for every present hexel at the end of conduct().
struct Work {
    Array<float> temperature_K;           ///< [hexels.cells]
    std::vector<std::int32_t> blocks;     ///< the room's own: warm blocks and the like
};
Work make_work(const tissue::Model& model, const tissue::State& state);

/// Temperature of a hexel from its enthalpy and water [K].
float temperature_K(const tissue::Model& model, const tissue::State& state, std::int64_t hexel);

/// Every ThermalParameters::refresh_ticks: one step of conduction, surroundings, perfusion, Joule heat
/// (Exchange::joule), boiling (State::water, GasEvents), damage and peak temperature, with the energy budget. On other
/// ticks returns at once.
void conduct(const tissue::Model& model, tissue::State& state, tissue::Exchange& exchange, Work& work);

/// Takes hexels whose latent budget is spent out of State::hexel_present and lists them in Exchange::removed_hexels, in
/// the order of their cells, with their GasEvents.
void remove_vaporised(const tissue::Model& model, tissue::State& state, tissue::Exchange& exchange, Work& work);

/// Enthalpy stored in present hexels [J].
double stored_J(const tissue::Model& model, const tissue::State& state);

}  // namespace calot::thermal

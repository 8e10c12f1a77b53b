#pragma once
// Hexels that fall: crumbs without a hold, strands that tore.

#include <cstdint>

#include "calot/deformation/occupancy.h"
#include "calot/tissue/exchange.h"
#include "calot/tissue/state.h"

namespace calot::deformation {

/// The hexels of `word` (bits of a phyxel's cell) leave State with the heat they hold and are listed as removed.
inline void drop_hexels(const tissue::Model& model, tissue::State& state, tissue::Exchange& exchange,
                        std::int64_t phyxel, std::uint64_t word) {
    const int m = model.hexels_per_edge;
    const Int3 cell = model.phyxels.coordinates(phyxel);
    for (; word != 0; word &= word - 1) {
        const std::int64_t hexel = model.hexels.index(cell * m + hexel_of_bit(m, __builtin_ctzll(word)));
        float& enthalpy_J_per_m3 = state.enthalpy_J_per_m3[static_cast<std::size_t>(hexel)];
        state.hexel_present.clear(hexel);
        state.energy_J.debris += static_cast<double>(enthalpy_J_per_m3) * model.hexel_volume_m3();
        enthalpy_J_per_m3 = 0.0f;
        ++state.hexels_fallen;
        exchange.removed_hexels.push_back(hexel);
    }
}

}  // namespace calot::deformation

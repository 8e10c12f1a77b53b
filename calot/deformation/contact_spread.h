#pragma once
// psi: what share of a material point's motion each phyxel has (contact.h).

#include <array>
#include <cstdint>

#include "calot/deformation/work.h"

namespace calot::deformation {

/// Of the centre of a hexel. All zero when nothing carries it.
void local_shares(const tissue::Model& model, const tissue::State& state, const Work& work, std::int64_t hexel,
                  LocalShares& out);

/// Calls visit(cell, share) for every cell of the lattice that has a share.
template <class Visit>
void for_each_share(const Lattice& phyxels, const LocalShares& local, const Visit& visit) {
    for (int z = -2; z <= 2; ++z)
        for (int y = -2; y <= 2; ++y) {
            const float* row = local.share.data() + 8 * (y + 2) + 40 * (z + 2);
            const std::int64_t cell = local.owner + phyxels.offset(Int3(-2, y, z));
            for (int x = 0; x < 5; ++x)
                if (row[x] != 0.0f) visit(cell + std::int64_t{x} * phyxels.stride.x, row[x]);
        }
}

}  // namespace calot::deformation

#pragma once
// The 18 links of a phyxel, one at a time, for set-up and reference code. Kernels read the same bits a vector at a
// time.

#include <cstdint>

#include "calot/tissue/state.h"

namespace calot::deformation {

/// Weights of the kernel w = (h^2 - r^2)^3 with h = sqrt(2.5) s (Pan et al. 2019, Eq. 3), in units of s^6 / 8: w only
/// ever appears in ratios. Edges count little: at a free surface they lead inward alone, so that the strain along the
/// surface is seen too deep by s / 11 with 8 : 1 (h = sqrt(3) s), by s / 28 with 27 : 1 (docs/validation.md).
inline constexpr double kFaceWeight = 27.0;
inline constexpr double kEdgeWeight = 1.0;

/// Calls visit(neighbour cell, step in cells from here to there, weight) for every live link of a phyxel.
template <class Visit>
void for_each_link(const Lattice& phyxels, const std::array<BitArray, 9>& links, std::int64_t phyxel,
                   const Visit& visit) {
    for (std::size_t d = 0; d < links.size(); ++d) {
        const Int3 step = tissue::kLinkDirections[d];
        const std::int64_t offset = phyxels.offset(step);
        const double weight = static_cast<int>(d) < tissue::kFaceDirections ? kFaceWeight : kEdgeWeight;
        if (links[d].test(phyxel)) visit(phyxel + offset, step, weight);
        if (links[d].test(phyxel - offset)) visit(phyxel - offset, -step, weight);
    }
}

}  // namespace calot::deformation

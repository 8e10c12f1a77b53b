#pragma once
// The 3^3 cells about a phyxel, and which of them its links reach.

#include <array>
#include <cstdint>

#include "calot/tissue/state.h"

namespace calot::deformation {

inline constexpr int kNeighbourhood = 27;  ///< cell k is (k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1) away
inline constexpr int kNeighbourhoodCentre = 13;

/// Where the link towards a neighbour is stored: bit of State::links[direction] at this end (forward) or at the other.
struct NeighbourLink {
    Int3 step{0};
    int direction = -1;  ///< -1: no link (the cell itself and the 8 corners)
    bool forward = true;
};

inline const std::array<NeighbourLink, kNeighbourhood>& neighbour_links() {
    static const std::array<NeighbourLink, kNeighbourhood> table = [] {
        std::array<NeighbourLink, kNeighbourhood> links;
        for (int k = 0; k < kNeighbourhood; ++k) {
            NeighbourLink& link = links[static_cast<std::size_t>(k)];
            link.step = Int3(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
            for (int d = 0; d < static_cast<int>(tissue::kLinkDirections.size()); ++d) {
                const Int3 direction = tissue::kLinkDirections[static_cast<std::size_t>(d)];
                if (link.step == direction || link.step == -direction) {
                    link.direction = d;
                    link.forward = link.step == direction;
                }
            }
        }
        return links;
    }();
    return table;
}

/// Index in the neighbourhood of a step with entries in -1..1.
inline int neighbour_index(const Int3& step) {
    return (step.x + 1) + 3 * (step.y + 1) + 9 * (step.z + 1);
}

/// Whether the link from `phyxel` towards one of its 18 face and edge neighbours lives.
inline bool link_lives(const tissue::State& state, std::int64_t phyxel, std::int64_t offset,
                       const NeighbourLink& link) {
    return state.links[static_cast<std::size_t>(link.direction)].test(link.forward ? phyxel : phyxel + offset);
}

/// As link_lives; two ghosts, both parts of one rigid hold, count as linked.
inline bool connected(const tissue::Model& model, const tissue::State& state, std::int64_t phyxel, std::int64_t offset,
                      const NeighbourLink& link) {
    return link_lives(state, phyxel, offset, link) ||
           (model.phyxel_ghost.test(phyxel) && model.phyxel_ghost.test(phyxel + offset));
}

}  // namespace calot::deformation

#pragma once
// The rules by which links live (topology.h), on words of occupancy. `View` gives the words and the links:
//   std::uint64_t main(phyxel)   main component of a phyxel, 0 for anything else
//   std::uint64_t held(phyxel)   held cells of the cell

#include <cstdint>

#include "calot/deformation/neighbours.h"
#include "calot/deformation/occupancy.h"

namespace calot::deformation {

/// Whether a face link may live: the components of the two cells touch.
template <class View>
bool face_holds(const tissue::Model& model, const OccupancyShifts& shifts, const View& view, std::int64_t below,
                std::size_t axis) {
    const std::int64_t above = below + model.phyxels.stride[static_cast<int>(axis)];
    const bool ghost_below = model.phyxel_ghost.test(below), ghost_above = model.phyxel_ghost.test(above);
    // A ghost set by hand, without held cells, fills its cell.
    auto ghost = [&](std::int64_t p) { return view.held(p) != 0 ? view.held(p) : shifts.all; };
    // Towards a ghost, a phyxel also counts with the held cells of its own cell that it touches.
    auto with_held = [&](std::int64_t p) { return shifts.flood(view.main(p), view.main(p) | view.held(p)); };
    const std::uint64_t a = ghost_below ? ghost(below) : ghost_above ? with_held(below) : view.main(below);
    const std::uint64_t b = ghost_above ? ghost(above) : ghost_below ? with_held(above) : view.main(above);
    return shifts.touch(a, b, axis);
}

/// Whether an edge link may live: one of its two paths over faces does.
inline bool edge_holds(const tissue::Model& model, const tissue::State& state, std::int64_t phyxel, const Int3& step) {
    const auto& links = neighbour_links();
    for (int axis = 0; axis < 3; ++axis) {
        if (step[axis] == 0) continue;
        Int3 first(0);
        first[axis] = step[axis];
        const Int3 second = step - first;
        const NeighbourLink& link1 = links[static_cast<std::size_t>(neighbour_index(first))];
        const NeighbourLink& link2 = links[static_cast<std::size_t>(neighbour_index(second))];
        const std::int64_t middle = phyxel + model.phyxels.offset(first);
        if (connected(model, state, phyxel, model.phyxels.offset(first), link1) &&
            connected(model, state, middle, model.phyxels.offset(second), link2))
            return true;
    }
    return false;
}

}  // namespace calot::deformation

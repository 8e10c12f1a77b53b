#pragma once
// The cube of hexels about the bare tip in which the field is solved.
//
// Its axes are those of the hexel lattice in the lattice's own order (fast, middle, slow), so that a row of the window
// is a run of hexels in memory. Window coordinates (a, b, c) count from the low corner along these.

#include <cstdint>

#include "calot/base/vec.h"
#include "calot/tissue/exchange.h"
#include "calot/tissue/model.h"

namespace calot::electric {

struct Window {
    int cells = 0;
    Int3 axis{0, 1, 2};  ///< axis[k]: which of x, y, z runs along window axis k
    Int3 low{0};         ///< hexel coordinates (x, y, z) of the low corner; may lie outside the lattice
    Int3 begin{0};       ///< window coordinates: the part inside the lattice is [begin, end)
    Int3 end{0};

    /// Window coordinates of a hexel.
    Int3 from_hexel(const Int3& hexel) const {
        const Int3 d = hexel - low;
        return {d[axis.x], d[axis.y], d[axis.z]};
    }
    Int3 to_hexel(const Int3& cell) const {
        Int3 hexel = low;
        for (int k = 0; k < 3; ++k) hexel[axis[k]] += cell[k];
        return hexel;
    }
    bool contains(const Int3& cell) const {
        return cell.x >= begin.x && cell.y >= begin.y && cell.z >= begin.z && cell.x < end.x && cell.y < end.y &&
               cell.z < end.z;
    }
};

struct Reach;  // contact.h

/// Where the window goes: it stays at `low` while the middle of the hexels that current enters is within an eighth of
/// its edge from its own middle; else it is centred there, on even coordinates. It never reaches past the lattice where
/// it could lie inside it.
Window place_window(const tissue::Model& model, const tissue::Exchange& exchange, const Reach& reach, const Int3& low);

}  // namespace calot::electric

#pragma once
// The axes of a lattice in the order in which they run through its arrays.

#include <utility>

#include "calot/base/lattice.h"

namespace calot::thermal {

struct Axes {
    int fast, middle, slow;
};
inline Axes axes_of(const Lattice& lattice) {
    Axes axes{};
    axes.fast = lattice.stride.x == 1 ? 0 : lattice.stride.y == 1 ? 1 : 2;
    axes.middle = (axes.fast + 1) % 3;
    axes.slow = (axes.fast + 2) % 3;
    if (lattice.stride[axes.middle] > lattice.stride[axes.slow]) std::swap(axes.middle, axes.slow);
    return axes;
}

}  // namespace calot::thermal

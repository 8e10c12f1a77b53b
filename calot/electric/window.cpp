#include "calot/electric/window.h"

#include <algorithm>

#include "calot/electric/contact.h"

namespace calot::electric {

namespace {

Int3 axes_by_stride(const Lattice& lattice) {
    Int3 axis{0, 1, 2};
    auto order = [&](int a, int b) {
        if (lattice.stride[axis[b]] < lattice.stride[axis[a]]) std::swap(axis[a], axis[b]);
    };
    order(0, 1);
    order(1, 2);
    order(0, 1);
    return axis;
}

int round_down_to_even(int n) {
    return n - (n & 1);
}

}  // namespace

Window place_window(const tissue::Model& model, const tissue::Exchange& exchange, const Reach& reach, const Int3& low) {
    Window window;
    window.cells = model.electric.window_cells;
    window.axis = axes_by_stride(model.hexels);

    Int3 lowest(1 << 30), highest(-(1 << 30));
    for (const tissue::NearHexel& near : exchange.near)
        if (reaches(reach, near)) {
            const Int3 hexel = model.hexels.coordinates(near.hexel);
            lowest = glm::min(lowest, hexel);
            highest = glm::max(highest, hexel);
        }
    for (int axis = 0; axis < 3; ++axis) {
        const int size = model.hexels.size[axis], room = size - window.cells;
        const int wanted = (lowest[axis] + highest[axis]) / 2 - window.cells / 2;
        const bool keep = std::abs(wanted - low[axis]) <= window.cells / 8;
        const int placed = keep ? low[axis] : round_down_to_even(wanted);
        window.low[axis] = std::clamp(placed, std::min(0, room), std::max(0, room));
    }
    for (int k = 0; k < 3; ++k) {
        const int axis = window.axis[k];
        window.begin[k] = std::clamp(-window.low[axis], 0, window.cells);
        window.end[k] = std::clamp(model.hexels.size[axis] - window.low[axis], 0, window.cells);
    }
    return window;
}

}  // namespace calot::electric

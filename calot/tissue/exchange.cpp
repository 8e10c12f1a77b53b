#include "calot/tissue/exchange.h"

#include <algorithm>
#include <utility>

namespace calot::tissue {

void JouleHeat::place(const Lattice& lattice, const Int3& low_corner, const Int3& extent) {
    low = low_corner;
    size = extent;
    const int fast = lattice.stride.x == 1 ? 0 : lattice.stride.y == 1 ? 1 : 2;
    int middle = (fast + 1) % 3, slow = (fast + 2) % 3;
    if (lattice.stride[middle] > lattice.stride[slow]) std::swap(middle, slow);
    stride[fast] = 1;
    stride[middle] = size[fast];
    stride[slow] = size[fast] * size[middle];
}

void reserve_exchange(const Model& model, Exchange& exchange) {
    const auto hexels = static_cast<std::size_t>(model.hexel_initial.count());
    const auto phyxels = static_cast<std::size_t>(model.phyxel_initial.count() + model.phyxel_ghost.count());
    const auto near = std::min(hexels, static_cast<std::size_t>(kNearCapacity));
    exchange.capsules.reserve(8);
    exchange.near.reserve(near);
    exchange.contacts.reserve(2 * near);
    exchange.removed_hexels.reserve(hexels);
    exchange.gas.reserve(std::min(2 * hexels, static_cast<std::size_t>(kGasCapacity)));
    exchange.changed_phyxels.reserve(phyxels);
}

}  // namespace calot::tissue

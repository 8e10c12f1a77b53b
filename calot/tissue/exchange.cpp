#include "calot/tissue/exchange.h"

#include <algorithm>

namespace calot::tissue {

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

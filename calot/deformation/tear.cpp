#include "calot/deformation/tear.h"

#include "calot/deformation/falling.h"

namespace calot::deformation {

void tear_overstretched(const tissue::Model& model, tissue::State& state, tissue::Exchange& exchange,
                        const Work& work) {
    for_each_strained(work, [&](const Group& group) {
        for (std::uint32_t rest = group.overstretched & group.present; rest != 0; rest &= rest - 1) {
            const std::int64_t phyxel = group.first + __builtin_ctz(rest);
            drop_hexels(model, state, exchange, phyxel, work.occupancy[static_cast<std::size_t>(phyxel)]);
        }
    });
}

}  // namespace calot::deformation

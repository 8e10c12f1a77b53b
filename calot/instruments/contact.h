#pragma once
// Contact between instruments and tissue, and between instruments and rigid organs (docs/physics.md section 8).

#include "calot/tissue/exchange.h"
#include "calot/tissue/state.h"

namespace calot::instruments {

/// From Exchange::capsules and ::near: one-sided constraints into Exchange::contacts (against many points at once), and
/// the penalty force of rigid organs on the hook into Exchange::organ_force_N.
void find_contacts(const tissue::Model& model, const tissue::State& state, tissue::Exchange& exchange);

}  // namespace calot::instruments

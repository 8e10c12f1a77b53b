#pragma once
// Burning changes topology: links are severed where tissue no longer holds together (docs/physics.md section 4).

#include "calot/deformation/work.h"

namespace calot::deformation {

/// For the phyxels that lost hexels this tick (Exchange::removed_hexels): recomputes components and links, frees crumbs
/// (components with no link to anything held: their hexels leave State::hexel_present, are appended to
/// Exchange::removed_hexels and counted as fallen), refreshes what changed and lists it in Exchange::changed_phyxels.
/// Nothing is allocated.
void sever_burnt_links(const tissue::Model& model, tissue::State& state, tissue::Exchange& exchange, Work& work);

}  // namespace calot::deformation

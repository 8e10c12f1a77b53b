#pragma once
// Overstretched tissue tears. What heat has eaten to strands stretches far under the hook; real strands part.

#include "calot/deformation/work.h"

namespace calot::deformation {

/// Lets the hexels of phyxels stretched beyond DeformationParameters::tear_stretch fall: they leave
/// State::hexel_present, are appended to Exchange::removed_hexels and counted as fallen, as crumbs are. Comes before
/// sever_burnt_links, which then cuts the links. Every phyxel is looked at in every tick: looked
/// at once in eight, a strand under the hook blew up in the standard scene. Nothing is allocated.
void tear_overstretched(const tissue::Model& model, tissue::State& state, tissue::Exchange& exchange, const Work& work);

}  // namespace calot::deformation

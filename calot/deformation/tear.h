#pragma once
// Overstretched tissue tears. What heat has eaten to strands stretches far under the hook; real strands part.

#include "calot/deformation/work.h"

namespace calot::deformation {

/// Lets the hexels of phyxels stretched beyond DeformationParameters::tear_stretch fall: they leave
/// State::hexel_present, are appended to Exchange::removed_hexels and counted as fallen, as crumbs are. Comes before
/// sever_burnt_links, which then cuts the links. Every phyxel is looked at in every tick: a strand that is pulled
/// through a burst can go from twice its length to inversion within five ticks, and then blows up. Nothing is
/// allocated.
void tear_overstretched(const tissue::Model& model, tissue::State& state, tissue::Exchange& exchange, const Work& work);

}  // namespace calot::deformation

#pragma once
// Ghosts: cells of the organ that holds the tissue. They are no phyxels of their own but images of those they touch,
//
//   u_ghost = 2 u_face - mean of u over its face neighbours (over its edge neighbours where it has no others),
//
// so that halfway between, at the held face itself, displacement is that of the organ: zero, or what it is moved by.
// With u_ghost = 0 (a fixed layer) it vanishes at the ghosts' centres, half a cell too deep: held blocks 4 to 12 cells
// deep then sag by 7 to 16 % too much, with images by less than 5 % (docs/validation.md).
// Energies are of phyxels alone; what they pull at a ghost acts, by the chain rule, on the phyxels that it mirrors.

#include "calot/deformation/work.h"

namespace calot::deformation {

/// Lists all ghosts in Work::mirrors, without phyxels.
void list_ghosts(const tissue::Model& model, Work& work);

/// The mirror of a ghost.
const Mirror& find_mirror(const Work& work, std::int64_t ghost);

/// Finds out anew which phyxels a ghost mirrors. Its links must be current.
void refresh_mirror(const tissue::Model& model, const tissue::State& state, Work& work, std::int64_t ghost);

/// Work::images from Work::mirrors, if any of these changed.
void refresh_images(Work& work);

/// Sets the ghosts' displacements from those of the phyxels, and their velocities to 0. Images must be current.
void move_ghosts(tissue::State& state, const Work& work);

/// Hands the impulses [N s] that the motion sweep left in the ghosts' velocities on to the phyxels, which it has moved.
/// `decay` is the sweep's. Images must be current.
void return_ghost_impulses(tissue::State& state, const Work& work, float decay);

}  // namespace calot::deformation

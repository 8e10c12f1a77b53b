#pragma once
// Meshfree elasticity in time: one tick = Work::substeps leapfrog steps (docs/physics.md section 2).
//
//   v' = exp(-gamma dt) (v + dt (f(u) / m + g m_tissue / m))      forces: reference.h, a vector at a time: kernel.h
//   v' obeys the contacts                                         contact.h
//   u' = u + dt v'                                                and ghosts follow: ghosts.h
//   G, M from u'

#include <span>

#include "calot/deformation/work.h"

namespace calot::deformation {

/// Advances displacement and velocity by one tick under elastic, hourglass, gravity and contact forces. Reads
/// Exchange::near and ::contacts, writes Exchange::contact_force_N. Leaves Work::gradient current. Neither reads nor
/// writes what heat and current do, so that both can be worked out at the same time.
void advance(const tissue::Model& model, tissue::State& state, tissue::Exchange& exchange, Work& work);
/// Sets State::status when a displacement is no longer finite.
void check(const tissue::Model& model, tissue::State& state, const Work& work);
/// Both, unless State::status is not ok.
void integrate(const tissue::Model& model, tissue::State& state, tissue::Exchange& exchange, Work& work);

/// Recomputes rest properties (moment, volume, constants, hourglass, mass) of phyxels whose hexels or links changed, of
/// the ghosts beside them and the masses of their neighbours, from links and Work::occupancy. Call it once for all of
/// them, after all have changed. Nothing is allocated.
void refresh_phyxels(const tissue::Model& model, const tissue::State& state, Work& work,
                     std::span<const std::int64_t> phyxels);
/// The same for all at once.
void refresh_all_phyxels(const tissue::Model& model, const tissue::State& state, Work& work);

/// Recomputes gradient and moment stress of all phyxels from displacements.
void update_gradients(const tissue::Model& model, const tissue::State& state, Work& work);

/// The same where it can have changed: of the given phyxels and their neighbours.
void update_gradients_about(const tissue::Model& model, const tissue::State& state, Work& work,
                            const std::vector<std::int64_t>& phyxels);

/// Elastic + hourglass energy [J] and kinetic energy [J].
double elastic_energy_J(const tissue::Model& model, const tissue::State& state, const Work& work);
double kinetic_energy_J(const tissue::Model& model, const tissue::State& state, const Work& work);

/// Mass that moves beyond that of the tissue [kg]: floors and what the time step needs
/// (stable_mass.h). It has inertia but no weight.
double added_mass_kg(const Work& work);

}  // namespace calot::deformation

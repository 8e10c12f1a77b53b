#pragma once
// The wide part of contact: dense lines of psi (contact.h). Sums over rows run in sixteen partial sums whatever the
// vector's width, added as a tree in the end, and multiplication and addition stay separate: every instruction set
// gives the same bytes.

#include "calot/deformation/contact.h"

namespace calot::deformation {

/// Rows to a step of the kernels; ranges of rows and counts of points are padded to it.
inline constexpr int kContactLanes = 16;

/// W of all pairs of points.
void couple_points(ContactWork& contact);

/// Velocities of the points from those of the rows.
void gather_point_velocities(ContactWork& contact);

/// Adds what the impulses in `points` do to the velocities of the points (W p).
void push_all_points(ContactWork& contact);

/// `sweeps` times over all points: impulses and velocities.
void sweep_points(ContactWork& contact, int sweeps, float friction, float substep_s);

/// Impulses on the rows from those of the points: sum_c psi_c p_c.
void spread_impulses(ContactWork& contact);

/// The plain reference of each of them.
namespace reference {
void couple_points(ContactWork& contact);
void gather_point_velocities(ContactWork& contact);
void push_all_points(ContactWork& contact);
void sweep_points(ContactWork& contact, int sweeps, float friction, float substep_s);
void spread_impulses(ContactWork& contact);
}  // namespace reference

}  // namespace calot::deformation

#pragma once
// The mass that a phyxel needs for the explicit step to be stable, whatever its neighbours are.
//
// A phyxel's own stress pulls at itself and its neighbours. With g_il = dG_i/du_l (w A_i^-1 X_il for a neighbour, minus
// their sum for itself), the Hessian of v_i Psi(G_i) has blocks of size about c_i |g_il| |g_ik|, c = v (lambda + 2 mu),
// so that the row sum of phyxel l over all elements i that see it is
//
//   D_l = sum_i pull_i |g_il|,    pull_i = c_i sum_k |g_ik|,
//
// and omega^2 <= max D_l / m_l (Gershgorin). Thin pieces, light phyxels beside full ones and fat beside stiff tissue
// have a large D / m. Their mass is raised to m = D dt^2 / kRowSum, and only their inertia: they weigh what they did.
//
// Deformed tissue is stiffer: a stable neo-Hookean wave along g takes l |cof F g|^2 where it took l |g|^2, and where a
// hook pulls a thin flap that is several times as much. The largest eigenvalue of (cof F)^T cof F is at most its trace
// less 2 near rest, so that Work::stiffening = max(0, |cof F|^2 - 3) bounds what is added; D grows by 1 + its largest
// value in the neighbourhood. Velocities stay when masses change from one tick to the next.

#include "calot/deformation/work.h"

namespace calot::deformation {

/// Of one phyxel alone the row sum is nearly attained, by neighbours that all move away from it. Where these neighbours
/// resist as much themselves, they cannot: on whole blocks the largest true omega^2 is 0.34 to 0.43 of the row sum, 0.91
/// where nine links of ten are cut. A phyxel's pull therefore counts less by this much times the share of its
/// neighbourhood, by weight of links, that is linked to it and was as stiff from the start.
inline constexpr double kSupport = 0.7;
/// On blocks, slender and burnt bodies, and tissues mixed at random, the largest true omega^2 is then at most 0.92 of the
/// row sum. Leapfrog is stable up to (omega dt)^2 = 4: a reserve of 13 % (tests/deformation/stability_invariant.cpp).
inline constexpr double kRowSum = 3.8;

/// Work::initial_stiffness_Nm of all phyxels.
void find_initial_stiffness(const tissue::Model& model, Work& work);

/// Work::pull_N_per_m2 of a cell; its moment, volume and constants must be current.
void refresh_pull(const tissue::Model& model, const tissue::State& state, Work& work, std::int64_t phyxel);

/// Inverse mass and share of gravity of a phyxel whose neighbourhood is `raise` times as stiff as at rest.
void set_mass(Work& work, std::int64_t phyxel, float raise);

/// At the start of a tick: masses for tissue as it is deformed then.
void raise_masses(const tissue::Model& model, const tissue::State& state, Work& work);

/// Smallest stable mass [kg] of a phyxel; pulls and moments of its neighbours must be current.
double stable_mass_kg(const tissue::Model& model, const tissue::State& state, const Work& work, std::int64_t phyxel);

}  // namespace calot::deformation

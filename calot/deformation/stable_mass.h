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

#include "calot/deformation/work.h"

namespace calot::deformation {

/// The bound is loose: on blocks, slender bodies and random cuts the largest true (omega dt)^2 was at most 0.73 of it,
/// and leapfrog is stable up to 4. tests/deformation/stability_invariant.cpp looks at burnt and mixed bodies.
inline constexpr double kRowSum = 5.0;

/// Work::pull_N_per_m2 of a cell; its moment, volume and constants must be current.
void refresh_pull(const tissue::Model& model, const tissue::State& state, Work& work, std::int64_t phyxel);

/// Smallest stable mass [kg] of a phyxel; pulls and moments of its neighbours must be current.
double stable_mass_kg(const tissue::Model& model, const tissue::State& state, const Work& work, std::int64_t phyxel);

}  // namespace calot::deformation

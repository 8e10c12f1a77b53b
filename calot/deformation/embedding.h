#pragma once
// Displacement anywhere from phyxels: u(X) = sum_j phi_j (u_j + G_j (X - X_j)) (docs/physics.md section 3).

#include <span>

#include "calot/deformation/work.h"

namespace calot::deformation {

/// World positions of material points given at rest. `owner` is for each point a hexel cell near it whose phyxel
/// decides which side of a cut it is on: weights never cross severed links. Optionally also the deformation gradients
/// F = I + sum phi_j G_j there (empty span = not wanted), to turn normals by F^-T. Parallel, deterministic.
void embed_points(const tissue::Model& model, const tissue::State& state, const Work& work,
                  std::span<const Vec3f> rest_m, std::span<const std::int64_t> owner, std::span<Vec3f> world_m,
                  std::span<Mat3f> deformation_gradient = {});

/// Fills Exchange::near with the surface hexels (present, with an absent face neighbour) whose world position lies
/// within `reach_m` of any capsule in Exchange::capsules, in the order of their cells, and their bare_gap_m. Never more
/// than the capacity reserved: the nearest cells in order are kept and the rest ignored.
void find_near(const tissue::Model& model, const tissue::State& state, tissue::Exchange& exchange, const Work& work, double reach_m);

/// Spreads a force at an embedded point to phyxels by the transpose of the embedding: adds to Work::contact_force_N and
/// ::contact_moment. Linear and angular momentum balance exactly.
void spread_force(const tissue::Model& model, const tissue::State& state, Work& work, std::int64_t hexel, const Vec3f& rest_m, const Vec3f& force_N);

}  // namespace calot::deformation

#pragma once
// Displacement anywhere from phyxels: u(X) = sum_j phi_j (u_j + G_j (X - X_j)) (docs/physics.md section 3).
//
// phi_j are Shepard weights w_j / sum w, w = (1 - r^2 / R^2)^3 within R = 1.3 s, over the owner's phyxel and those of
// the 3^3 cells about it that live links reach: face and edge neighbours by their own link, corners by two links. Exact
// on linear displacements wherever the G_j are, since every term then is. Ghosts take part with u = 0 and their own G.

#include <array>
#include <cstdint>
#include <span>

#include "calot/deformation/work.h"

namespace calot::deformation {

inline constexpr double kEmbeddingRadius = 1.3;  ///< R, in phyxel spacings: cells two away lie beyond it

/// World positions of material points given at rest. `owner` is for each point a hexel cell near it whose phyxel
/// decides which side of a cut it is on: weights never cross severed links. Optionally also the deformation gradients
/// F = I + sum phi_j G_j there (empty span = not wanted), to turn normals by F^-T. A point whose owner's phyxel is gone
/// stays at rest. Parallel, deterministic. Fastest when points of the same phyxel follow one another.
void embed_points(const tissue::Model& model, const tissue::State& state, const Work& work,
                  std::span<const Vec3f> rest_m, std::span<const std::int64_t> owner, std::span<Vec3f> world_m,
                  std::span<Mat3f> deformation_gradient = {});

/// What embedding reads of a body, copied at one moment: where points are can then be worked out while the body goes
/// on. Members are those of State and Work.
struct Pose {
    std::array<Array<float>, 3> displacement_m;
    std::array<Array<float>, 9> gradient;
    BitArray phyxel_present;
    Array<std::uint32_t> link_word;
    std::array<std::int64_t, 27> neighbour_offset{};
    std::int64_t links_severed = -1;

    void copy(const tissue::State& state, const Work& work);
};
void embed_points(const tissue::Model& model, const Pose& pose, std::span<const Vec3f> rest_m,
                  std::span<const std::int64_t> owner, std::span<Vec3f> world_m,
                  std::span<Mat3f> deformation_gradient = {});

/// How far from the surface of an instrument hexels are near it.
struct NearReach {
    double bare_m = 0.0;     ///< from bare metal
    double hook_m = 0.0;     ///< from the rest of the hook
    double grasper_m = 0.0;  ///< from the grasper

    NearReach(double all_m) : bare_m(all_m), hook_m(all_m), grasper_m(all_m) {}
    NearReach(double bare, double hook, double grasper) : bare_m(bare), hook_m(hook), grasper_m(grasper) {}
    double of(const tissue::Capsule& capsule) const {
        return capsule.instrument == tissue::Instrument::grasper ? grasper_m : capsule.bare ? bare_m : hook_m;
    }
};

/// Fills Exchange::near with the surface hexels (present, with a face neighbour that is neither present nor held) whose
/// world position lies within reach of any capsule in Exchange::capsules, in the order of their cells. Never more
/// than the capacity reserved (reserve_exchange): beyond it the nearest are kept.
void find_near(const tissue::Model& model, const tissue::State& state, tissue::Exchange& exchange, Work& work,
               const NearReach& reach);

/// The phyxels that carry a material point and their weights phi_j >= 0. Weights sum to 1; count 0: nothing carries it.
struct Stencil {
    static constexpr int kCapacity = 32;
    int count = 0;
    std::array<std::int64_t, kCapacity> phyxel{};
    std::array<float, kCapacity> weight{};
};

/// The stencil that embed_points uses for a point; it depends on rest geometry and links only. Contact forces go the
/// same way back (contact.h): integrate() asks for it once a tick and contact point.
Stencil embedding_stencil(const tissue::Model& model, const tissue::State& state, const Work& work,
                          std::int64_t owner_hexel, const Vec3f& rest_m);

/// Scalar reference of embed_points: each point from its own stencil.
void embed_points_reference(const tissue::Model& model, const tissue::State& state, const Work& work,
                            std::span<const Vec3f> rest_m, std::span<const std::int64_t> owner,
                            std::span<Vec3f> world_m, std::span<Mat3f> deformation_gradient = {});

}  // namespace calot::deformation

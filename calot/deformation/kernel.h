#pragma once
// The two sweeps of a substep, a vector of phyxels at a time; reference.h says what they compute. They write only
// cells of the groups that they are given, and lanes are independent: any split of the groups, any vector width and any
// instruction set give the same bytes (no fused multiply-add, no sums across lanes).
//
// What a cell's force needs from its own place alone, M_i sum w X_ij and the hourglass force, belongs to displacements
// that the gradient sweep has at hand: it leaves both in `own_force`, and the velocity sweep reads the neighbours'
// moment stresses only.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "calot/deformation/work.h"

namespace calot::deformation {

/// Everything that the kernels read and write, as bare pointers over the phyxel lattice.
struct KernelView {
    std::array<float*, 3> displacement_m{}, velocity_m_per_s{};
    std::array<float*, 9> gradient{}, moment_stress{};
    float* stiffening = nullptr;
    float most_squared_stretch = 0.0f;  ///< |F|^2 beyond which tissue tears
    std::array<const float*, 6> moment_inverse{};
    std::array<float*, 3> own_force_N{};
    std::array<const float*, 3> step_sum{};
    const float* volume_m3 = nullptr;
    const float* inverse_mass_per_kg = nullptr;
    const float* gravity_share = nullptr;
    const float* hourglass = nullptr;
    const float* lame_mu_Pa = nullptr;
    const float* lame_lambda_Pa = nullptr;
    std::array<std::int64_t, 9> offset{};  ///< of the nine positive directions
    bool embedding = true;  ///< the gradient sweep stores G, also ghosts', for whoever embeds points, and how far F stretches
    tissue::ElasticLaw law = tissue::ElasticLaw::stable_neo_hookean;
    float volume_stiffness_Pa = 0.0f;
    float spacing_m = 0.0f;
    float substep_s = 0.0f;
    float decay = 1.0f;                           ///< of velocity in a substep
    std::array<float, 3> gravity_step_m_per_s{};  ///< velocity gained in a substep

    static KernelView make(const tissue::Model& model, tissue::State& state, Work& work);
};

/// Groups that hold all phyxels and ghosts. Sweeps run over ranges of this list, so that empty space costs nothing.
std::vector<Group> make_groups(const tissue::Model& model, const tissue::State& state);
/// Reads a group's bits anew.
void refresh_group(const tissue::Model& model, const tissue::State& state, Group& group);
/// The group of a cell that is or was a phyxel or ghost; for any other, the last that begins before it, or the first.
Group& group_of(Work& work, std::int64_t phyxel);

/// Work::stiffening that counts: below it, tissue keeps its mass, and momentum with it.
inline constexpr float kStiffer = 0.5f;

using Groups = std::span<Group>;

/// G and M.
void sweep_gradients(const KernelView& view, Groups groups);
/// Velocities after a substep of elastic forces, gravity and damping. Ghosts, which have none, get the impulse [N s] of
/// the forces on them instead.
void sweep_velocities(const KernelView& view, Groups groups);
/// Displacements after a substep at the present velocities.
void sweep_displacements(const KernelView& view, Groups groups);

}  // namespace calot::deformation

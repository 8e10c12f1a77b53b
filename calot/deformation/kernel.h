#pragma once
// The two sweeps of a substep, a vector of phyxels at a time; reference.h says what they compute. They write only
// cells of the groups that they are given, and lanes are independent: any split of the groups, any vector width and any
// instruction set give the same bytes (no fused multiply-add, no sums across lanes).
//
// Motion of a cell asks for the moment stresses of its neighbours, and gradients for their displacements before they
// move. So one pass can do both, motion a reach (the furthest neighbour, about a plane of the lattice) behind:
//
//     groups    . . . . m m m m m m m . . . . . . g g g g g g g . . . .
//                   moved   ^ motion  <- reach ->  ^ gradients    not yet seen
//
// What lies between stays in the cache.
//
// What a cell's force needs from its own place alone, M_i sum w X_ij and the hourglass force, belongs to displacements
// that the gradient sweep has at hand: it leaves both in `own_force`, and the motion sweep reads the neighbours'
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
    std::uint8_t* strained = nullptr;  ///< by group
    std::uint8_t* fast = nullptr;  ///< by group, set where a phyxel is faster than kFast_m_per_s
    const Group* first_group = nullptr;
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
    std::int64_t reach = 0;                ///< of the furthest
    bool embedding =
        true;  ///< the gradient sweep stores G, also ghosts', for whoever embeds points, and how far F stretches
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

/// Slower is at rest, less is no displacement (floats round a millimetre to 1e-10 m). Else tissue that nobody touches
/// would go on to move by ever less, with numbers or products of three so small, below 1e-38, that processors take thirty
/// times as long over them.
inline constexpr float kRest_m_per_s = 1e-12f;
inline constexpr float kNowhere_m = 1e-11f;

/// Whoever relies on where tissue was some ticks ago is told where it is faster (Work::fast).
inline constexpr float kFast_m_per_s = 1.0f;

using Groups = std::span<Group>;

/// G and M.
void sweep_gradients(const KernelView& view, Groups groups);
/// Velocities and displacements after a substep of elastic forces, gravity and damping. Ghosts, which have neither, get
/// the impulse [N s] of the forces on them instead of a velocity.
void sweep_motion(const KernelView& view, Groups groups);

/// Groups [begin, end) of Work::groups.
struct GroupRange {
    std::int64_t begin = 0, end = 0;
};
/// Both in one pass over memory: G and M of some groups and, as soon as those of all their neighbours are there, motion
/// of others among them. `motion` may hold groups whose neighbours are all in `gradients`.
void sweep_both(const KernelView& view, Groups all, GroupRange gradients, GroupRange motion);
/// Those of `gradients` that can be moved in the same pass, because all their neighbours are in it as well.
GroupRange inner_groups(const KernelView& view, Groups all, GroupRange gradients);

}  // namespace calot::deformation

#pragma once
// The two sweeps of a substep, a vector of phyxels at a time; reference.h says what they compute. Within a range they
// write only cells of that range, and lanes are independent: any split into ranges, any vector width and any
// instruction set give the same bytes (no fused multiply-add, no sums across lanes).

#include <array>
#include <cstdint>

#include "calot/deformation/work.h"

namespace calot::deformation {

/// Everything that the kernels read and write, as bare pointers over the phyxel lattice.
struct KernelView {
    std::array<float*, 3> displacement_m{}, velocity_m_per_s{};
    std::array<float*, 9> gradient{}, moment_stress{};
    std::array<const float*, 6> moment_inverse{};
    const float* volume_m3 = nullptr;
    const float* inverse_mass_per_kg = nullptr;
    const float* gravity_share = nullptr;
    const float* hourglass = nullptr;
    const float* lame_mu_Pa = nullptr;
    const float* lame_lambda_Pa = nullptr;
    std::array<const std::uint8_t*, 9> links{};
    std::array<std::int64_t, 9> offset{};  ///< of the nine positive directions
    const std::uint8_t* present = nullptr;
    const std::uint8_t* ghost = nullptr;
    tissue::ElasticLaw law = tissue::ElasticLaw::stable_neo_hookean;
    float volume_stiffness_Pa = 0.0f;
    float spacing_m = 0.0f;
    float substep_s = 0.0f;
    float decay = 1.0f;                           ///< of velocity in a substep
    std::array<float, 3> gravity_step_m_per_s{};  ///< velocity gained in a substep

    static KernelView make(const tissue::Model& model, tissue::State& state, Work& work);
};

/// Cells a range must be a multiple of, but for the last; it starts at Lattice::first plus a multiple of it.
inline constexpr std::int64_t kKernelGrain = 64;

/// G and M of the cells [begin, end).
void sweep_gradients(const KernelView& view, std::int64_t begin, std::int64_t end);
/// Velocities of the cells [begin, end) after a substep of elastic forces, gravity and damping. Ghosts, which have
/// none, get the impulse [N s] of the forces on them instead.
void sweep_velocities(const KernelView& view, std::int64_t begin, std::int64_t end);
/// Displacements of the cells [begin, end) after a substep at the present velocities.
void sweep_displacements(const KernelView& view, std::int64_t begin, std::int64_t end);

}  // namespace calot::deformation

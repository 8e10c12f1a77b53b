#pragma once
// Scratch of the deformation room: all of it can be rebuilt from Model and State (make_work does), bit for bit.

#include <array>
#include <cstdint>
#include <vector>

#include "calot/base/array.h"
#include "calot/deformation/contact.h"
#include "calot/deformation/near_work.h"
#include "calot/tissue/exchange.h"
#include "calot/tissue/state.h"

namespace calot::deformation {

/// A ghost and the phyxels it mirrors: u_ghost = 2 face - mean(u), so that displacement halfway, at the held face, is
/// that of the organ (ghosts.h).
struct Mirror {
    std::int32_t ghost = 0;
    std::int32_t count = 0;
    std::array<std::int32_t, 12> phyxel{};
};

/// The same as flat lists, for loops over all of them. Ghost n, ghost[n], mirrors phyxels mirrored[start[n]] to
/// mirrored[start[n + 1]]; the other way, phyxel n, phyxel[n], is mirrored by ghosts by[first[n]] to by[first[n + 1]], of
/// whose impulses it gets `share`.
struct Images {
    std::vector<std::int32_t> ghost, start, mirrored;
    std::vector<std::int32_t> phyxel, first, by;
    std::vector<float> share;
    std::vector<std::int32_t> slot;  ///< [phyxels.cells] scratch, -1
    bool stale = true;               ///< a mirror has changed since
};

/// Cells of a group: the widest vector. Narrower ones take a group in parts.
inline constexpr std::int64_t kGroupCells = 16;

/// Sixteen cells in a row and what the kernels ask of them, as lane masks: lane k is bit k (kernel.h).
struct Group {
    std::int32_t first = 0;  ///< cell
    std::uint16_t present = 0, ghost = 0;
    std::uint16_t touched = 0;                     ///< scratch of update_gradients_about, 0 between calls
    std::uint16_t overstretched = 0, stiffened = 0;  ///< as gradient is: beyond Model's tear_stretch, or no number; see stiffening
    std::array<std::uint16_t, 9> plus{}, minus{};  ///< links towards +d and -d
};

/// [phyxels.cells] each. Cells without a phyxel hold zeros. Ghosts have moments and gradients, but no volume or mass.
struct Work {
    // Rest properties, recomputed for a phyxel whenever its hexels or links change (refresh_phyxels)
    Array<std::uint64_t>
        occupancy;  ///< surviving hexels of the main component; bit x + m (y + m z), local coordinates; 0 for ghosts
    std::array<Array<float>, 6> moment_inverse;  ///< A^-1 [1/m^2], symmetric: xx xy xz yy yz zz; zero = no own stress
    Array<float> volume_share;                   ///< v over the volume of a phyxel's own hexels, before burning (rest.h)
    Array<float> volume_m3;                      ///< v, effective (scaled down when poorly linked)
    Array<float> weighing_mass_kg;               ///< of the hexels that are left; 0 = absent or ghost
    Array<float> moving_mass_kg;                 ///< the same, with the floor of Model's mass_fraction_floor
    Array<float> initial_stiffness_Nm;           ///< v (lambda + 2 mu) of the whole phyxel; 0 for ghosts
    Array<float> stable_mass_kg;                 ///< least mass for a stable step at rest (stable_mass.h)
    Array<float> hourglass;                      ///< kappa
    Array<float> lame_mu_Pa, lame_lambda_Pa;     ///< volume averages over surviving hexels
    Array<float> pull_N_per_m2;                  ///< of a phyxel's own stress at its neighbours (stable_mass.h)
    std::array<Array<float>, 3> step_sum;        ///< sum w X_ij / s over live links
    Array<std::uint32_t> link_word;  ///< live links: bit k towards cell k of the neighbourhood (neighbours.h)
    std::vector<Mirror> mirrors;     ///< of all ghosts, in the order of their cells
    Images images;                   ///< of them
    std::array<std::vector<float>, 3> face_m;  ///< [mirrors] displacement of held faces; 0 unless somebody moves an organ

    // Of a tick: stable_mass.h says why masses depend on how tissue is deformed
    Array<float> inverse_mass_per_kg;  ///< of the mass that moves, 0 = absent or ghost
    Array<float> gravity_share;        ///< mass that weighs / mass that moves, 0 = absent
    std::vector<std::int32_t> raised;  ///< cells whose masses differ from those at rest
    Array<float> raise;                ///< by which factor; 1 elsewhere

    // Always current: belongs to State::displacement_m at the end of integrate() and after sever_burnt_links()
    std::array<Array<float>, 9> gradient;       ///< G, row-major: gradient[3 r + c] = du_r / dX_c
    std::array<Array<float>, 9> moment_stress;  ///< M = v P A^-1 - kappa G, row-major
    std::array<Array<float>, 3> own_force_N;    ///< M_i sum w X_ij + sum w (kappa_i + kappa_j) u_ij
    Array<float> stiffening;  ///< how much stiffer than at rest, at most: 0 = not (stable_mass.h)

    // Topology and embedding (initialise_topology)
    Array<std::uint64_t> held;           ///< [phyxels.cells] cells of Model::hexel_held, bits as in occupancy
    Array<std::uint16_t> hold_distance;  ///< [phyxels.cells] links to the nearest ghost at set-up, 65535 = none
    BitArray changed;                    ///< [phyxels.cells] in Exchange::changed_phyxels; clear between calls
    Array<std::uint32_t> search_mark;    ///< [phyxels.cells] last search of crumbs that came by
    Array<std::int64_t> search_stack;    ///< [phyxels.cells]
    std::uint32_t search = 0;            ///< number of the last search
    std::array<std::int64_t, 27> neighbour_offset{};  ///< of cell k of the neighbourhood (neighbours.h)
    Array<float> hexel_weight;  ///< [m^3][27] kernel of hexel centres towards the 3^3 phyxels about their own

    std::vector<Group> groups;                 ///< hold all phyxels and ghosts, do not overlap, ascending
    std::vector<std::uint8_t> strained;        ///< [groups] has an overstretched or stiffened cell
    std::vector<std::uint8_t> fast;            ///< [groups] had a fast phyxel since the search for near hexels looked (near.cpp)
    std::vector<std::int32_t> touched_groups;  ///< scratch
    NearWork near;                             ///< tables and lists of find_near
    std::array<Array<float>, 3> rest_m;        ///< [phyxels.cells] centres at rest
    ContactWork contact;                       ///< one tick's contact points

    int substeps = 1;
    float substep_s = 1e-3f;
};

/// Calls visit(group) for the groups that have an overstretched or stiffened cell.
template <class Visit>
void for_each_strained(const Work& work, const Visit& visit) {
    for (std::size_t g = 0; g < work.groups.size(); ++g)
        if (work.strained[g] != 0) visit(work.groups[g]);
}

/// Reserves and computes everything from model and state.
Work make_work(const tissue::Model& model, const tissue::State& state);

}  // namespace calot::deformation

#pragma once
// Contact between instruments and tissue inside a substep, and what a grasper holds.
//
// A contact point moves with the embedding, u(X) = sum_j phi_j (u_j + G_j (X - X_j)), which is linear in the phyxels'
// displacements: u(X) = sum_i psi_i u_i. An impulse p at the point acts on them by the transpose, psi_i p on phyxel i:
// linear and angular momentum balance, since the psi_i reproduce constant and linear fields.
//
// The law of a touching point is a one-sided spring and Coulomb friction; that of a held one a spring in all directions
// that slips beyond a limit (grasp.h). Explicit, 16 stiff hexels on a phyxel of 13 mg would need a much smaller step;
// it is implicit instead. With n the normal, g the gap, k the stiffness, W_cd = sum_i psi_ci psi_di / m_i, the impulses
// of a substep solve
//
//   0 <= p_c = -k dt (g_c + dt n_c (v_c - v_tool)),  v_c = v_c* + sum_d W_cd p_d,   |p_tangential| <= friction p_c
//
// by projected Gauss-Seidel over the points in their order, a fixed number of times, from the impulses of the substep
// before (State::contact between ticks). In rest this is exactly the spring k, in motion it damps.
//
// Layout. All points together are carried by some hundreds of phyxels; these are the rows. psi is dense, a line of rows
// for each point, and a point's share is zero outside its range of rows:
//
//            rows:  phyxel a, b, c, ...            W_cd, v_c: sums along lines, where the ranges overlap
//   point 0         | psi psi psi 0   0   0 |      impulses on phyxels: sums down the columns
//   point 1         | 0   psi psi psi psi 0 |
//
// so that every step is a few hundred multiplications of whole vectors (contact_simd.cpp; plainly in
// contact_reference.h).

#include <array>
#include <cstdint>
#include <vector>

#include "calot/base/array.h"
#include "calot/tissue/exchange.h"
#include "calot/tissue/state.h"

namespace calot::deformation {

struct Work;

/// Points that are solved at most: touching ones, then held ones. Of more that touch, the deepest of every phyxel stand
/// for all of its, with stiffness in proportion: even then they are closer to each other than phyxels are.
inline constexpr int kMaxContactPoints = tissue::kMostContactPoints;
inline constexpr int kMaxPoints = kMaxContactPoints + tissue::kMostGrasped;
static_assert(kMaxPoints % 16 == 0);

/// Constant over a tick but for what says otherwise.
struct ContactPoint {
    Vec3f normal{0.0f};  ///< unit; 0 = held
    Vec3f tool_velocity_m_per_s{0.0f};
    float stiffness_N_per_m = 0.0f;
    float gap_m = 0.0f;               ///< advances with the substeps
    Vec3f away_m{0.0f};               ///< of a held point: from where it is held to where it is; advances
    float most_force_N = 0.0f;        ///< of a held point: beyond it slips
    Vec3f impulse_Ns{0.0f};           ///< of the last substep, where the next one starts
    std::int32_t near = -1;           ///< index into Exchange::near; of a held point into State::grasper
    std::int32_t first = 0, end = 0;  ///< range of rows outside which psi is 0; multiples of 16
    std::int32_t shares_end = 0;      ///< of its ContactWork::shares
    std::int64_t hexel = 0;
    tissue::Instrument instrument = tissue::Instrument::hook;

    bool held() const { return normal == Vec3f(0.0f); }
};

/// psi of one point on the 5^3 cells about its own phyxel's, rows of x padded to eight: cell (x, y, z), each in -2 ..
/// 2, is at (x + 2) + 8 (y + 2) + 40 (z + 2) (contact_spread.h).
struct LocalShares {
    std::int64_t owner = -1;  ///< phyxel cell
    alignas(64) std::array<float, 200> share{};
    std::array<std::uint64_t, 4> there{};  ///< bits of those that are not 0
};

/// What a row has of a point.
struct RowShare {
    std::int32_t row;
    float share;
};

inline constexpr std::int32_t kGhostRow = -2;

/// One tick's points. Arrays of floats are 64-byte aligned and padded with zeros to multiples of 16.
struct ContactWork {
    std::vector<ContactPoint> points;
    std::vector<std::int32_t> phyxel;                  ///< [rows] cells
    std::int32_t stride = 0;                           ///< rows, padded
    Array<float> psi;                                  ///< [points][stride]
    Array<float> inverse_mass_per_kg;                  ///< [stride]
    std::array<Array<float>, 3> row_velocity_m_per_s;  ///< [stride]
    std::array<Array<float>, 3> row_impulse_Ns;        ///< [stride]
    Array<float> coupling_per_kg;                      ///< W, [kMaxPoints] per row
    std::array<Array<float>, 3> velocity_m_per_s;      ///< v_c, [kMaxPoints]
    Array<std::int32_t> row_of;                        ///< [phyxels.cells] between ticks -1, of ghosts always kGhostRow
    std::array<std::int32_t, 200> share_offset{};      ///< from a point's phyxel to the cells of LocalShares
    bool started = false;                              ///< a substep of this tick was solved
    std::vector<LocalShares, AlignedAllocator<LocalShares>> local;  ///< [kMaxPoints]
    std::vector<RowShare> shares;                                   ///< of all points in turn, on the way to psi
    Array<std::int32_t> entry_of;                                   ///< [rows] the last of them
    std::array<Vec3, tissue::kInstruments> impulse_Ns{};  ///< of each instrument on the tissue since the tick began
    std::vector<std::int32_t> owner, next, rank, kept;    ///< scratch of choosing among many, [contacts]
};

/// Reserves everything.
ContactWork make_contact_work(const tissue::Model& model);

/// At the start of a tick: from Exchange::near and ::contacts, and State::grasper.
void prepare_contacts(const tissue::Model& model, const tissue::State& state, const tissue::Exchange& exchange,
                      Work& work);

/// Parts of it, for whoever solves elsewhere. Which points there are, with the impulses they start from:
void list_points(const tissue::Model& model, const tissue::State& state, const tissue::Exchange& exchange,
                 ContactWork& contact);
/// and what carries them: rows and lines of psi.
void carry_points(const tissue::Model& model, const tissue::State& state, Work& work);

/// Gauss-Seidel sweeps in the first substep of a tick, which has new points, and in the others. Both start from the
/// impulses of the substep before.
inline constexpr int kFirstSweeps = 6;
inline constexpr int kSweeps = 4;

/// In a substep, once velocities are known: makes them obey the contacts.
void solve_contacts(const tissue::Model& model, tissue::State& state, Work& work);

/// At the end of a tick: keeps the impulses in State::contact.
void remember_contacts(tissue::State& state, const Work& work);

}  // namespace calot::deformation

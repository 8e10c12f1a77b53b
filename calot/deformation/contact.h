#pragma once
// Contact between instruments and tissue inside a substep.
//
// A contact point moves with the embedding, u(X) = sum_j phi_j (u_j + G_j (X - X_j)), which is linear in the phyxels'
// displacements: u(X) = sum_i psi_i u_i. An impulse p at the point acts on them by the transpose, psi_i p on phyxel i:
// linear and angular momentum balance, since the psi_i reproduce constant and linear fields.
//
// The law is a one-sided spring and Coulomb friction. Explicit, 16 stiff hexels on a phyxel of 13 mg would need a much
// smaller step; it is implicit instead. With n the normal, g the gap, k the stiffness, W_cd = sum_i psi_ci psi_di /
// m_i, the impulses of a substep solve
//
//   0 <= p_c = -k dt (g_c + dt n_c (v_c - v_tool)),  v_c = v_c* + sum_d W_cd p_d,   |p_tangential| <= friction p_c
//
// by projected Gauss-Seidel over the contacts in their order, a fixed number of times. In rest this is exactly the
// spring k, in motion it damps.

#include <array>
#include <cstdint>
#include <vector>

#include "calot/base/array.h"
#include "calot/tissue/exchange.h"
#include "calot/tissue/state.h"

namespace calot::deformation {

struct Work;

/// Contact points that are solved at most. Beyond it, evenly chosen ones stand for all, with stiffness in proportion:
/// even then they are far closer to each other than phyxels are.
inline constexpr int kMaxContactPoints = 64;

/// Constant over a tick but for what says otherwise.
struct ContactPoint {
    Vec3f normal{0.0f};
    Vec3f tool_velocity_m_per_s{0.0f};
    float stiffness_N_per_m = 0.0f;
    float gap_m = 0.0f;               ///< advances with the substeps
    std::int32_t first = 0, end = 0;  ///< its psi: ContactWork::phyxel, ::share in [first, end)
    float normal_impulse_Ns = 0.0f;   ///< of the last substep, where the next one starts
    Vec3f tangential_impulse_Ns{0.0f};
};

struct ContactWork {
    std::vector<ContactPoint> points;
    std::vector<std::int32_t> phyxel;                                        ///< cells
    std::vector<float> share;                                                ///< psi
    Array<float> coupling_per_kg;                                            ///< W, [kMaxContactPoints] per row
    std::array<std::array<float, kMaxContactPoints>, 3> velocity_m_per_s{};  ///< v_c
    Array<float> spread;                                                     ///< [phyxels.cells] zero between uses
    std::vector<std::int32_t> touched;                                       ///< cells of `spread` that are not
    bool started = false;  ///< a substep of this tick was solved: the next one starts from its impulses
    Vec3 impulse_Ns{0.0};  ///< on the tissue since the tick began
};

/// Reserves everything.
ContactWork make_contact_work(const tissue::Model& model);

/// At the start of a tick: from Exchange::near and ::contacts.
void prepare_contacts(const tissue::Model& model, const tissue::State& state, const tissue::Exchange& exchange,
                      Work& work);

/// In a substep, once velocities are known: makes them obey the contacts.
void solve_contacts(const tissue::Model& model, tissue::State& state, Work& work);

}  // namespace calot::deformation

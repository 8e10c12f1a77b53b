#include "calot/deformation/contact.h"

#include <algorithm>
#include <cmath>

#include "calot/deformation/embedding.h"
#include "calot/deformation/ghosts.h"
#include "calot/deformation/links.h"
#include "calot/deformation/work.h"

namespace calot::deformation {

using tissue::Model;
using tissue::State;

namespace {

/// Gauss-Seidel sweeps in the first substep of a tick, which starts from nothing, and in the others, which start from
/// the impulses of the last. A wire at rest 5 mm deep then holds its force to 0.1 % over half a second; 8 and 8 let it
/// creep by 1.6 %, 2 and 2 by 7 %. Nothing is kept over ticks, so that a saved state resumes bit for bit.
constexpr int kFirstSweeps = 24;
constexpr int kSweeps = 4;
/// Most phyxels that carry a point: the 5^3 about its own.
constexpr std::size_t kMostCarriers = 125;
/// Spacing of hexels to which ContactParameters::stiffness_N_per_m belongs; it grows with the area that a hexel has.
constexpr double kStandardHexel_m = 0.6e-3;

Mat3f moment_inverse(const Work& work, std::size_t i) {
    std::array<float, 6> a;
    for (std::size_t k = 0; k < a.size(); ++k) a[k] = work.moment_inverse[k][i];
    return Mat3f(a[0], a[1], a[2], a[1], a[3], a[4], a[2], a[4], a[5]);
}

void add_spread(ContactWork& contact, std::int64_t cell, float value) {
    float& sum = contact.spread[static_cast<std::size_t>(cell)];
    if (sum == 0.0f) contact.touched.push_back(static_cast<std::int32_t>(cell));
    sum += value;
}

/// Adds psi of a material point to ContactWork::spread.
void spread_point(const Model& model, const State& state, Work& work, std::int64_t hexel, const Vec3f& rest_m) {
    ContactWork& contact = work.contact;
    const auto spacing = static_cast<float>(model.phyxels.spacing_m);
    const Stencil stencil = embedding_stencil(model, state, work, hexel, rest_m);
    for (int n = 0; n < stencil.count; ++n) {
        const std::int64_t carrier = stencil.phyxel[static_cast<std::size_t>(n)];
        const float weight = stencil.weight[static_cast<std::size_t>(n)];
        // G_j (X - X_j) = sum_l w u_jl (X_jl . A_j^-1 (X - X_j))
        const Vec3f away = Vec3f(Vec3(rest_m) - model.phyxels.centre_m(carrier));
        const Vec3f lever = (weight * spacing) * (moment_inverse(work, static_cast<std::size_t>(carrier)) * away);
        float own = weight;
        for_each_link(model.phyxels, state.links, carrier, [&](std::int64_t other, const Int3& step, double w) {
            const float share = static_cast<float>(w) * glm::dot(lever, Vec3f(step));
            own -= share;
            add_spread(contact, other, share);
        });
        add_spread(contact, carrier, own);
    }
}

/// What a ghost carries, the phyxels that it mirrors carry.
void resolve_ghosts(const Model& model, Work& work) {
    ContactWork& contact = work.contact;
    for (std::size_t k = 0; k < contact.touched.size(); ++k) {
        const std::int32_t cell = contact.touched[k];
        if (!model.phyxel_ghost.test(cell)) continue;
        const Mirror& mirror = find_mirror(work, cell);
        const float share = contact.spread[static_cast<std::size_t>(cell)];
        contact.spread[static_cast<std::size_t>(cell)] = 0.0f;
        for (int n = 0; n < mirror.count; ++n)
            add_spread(contact, mirror.phyxel[static_cast<std::size_t>(n)], -share / static_cast<float>(mirror.count));
    }
}

/// Moves ContactWork::spread into a point's list and clears it. A cell may stand in `touched` twice.
void collect_point(ContactWork& contact, ContactPoint& point) {
    point.first = static_cast<std::int32_t>(contact.phyxel.size());
    for (const std::int32_t cell : contact.touched) {
        float& share = contact.spread[static_cast<std::size_t>(cell)];
        if (share != 0.0f) {
            contact.phyxel.push_back(cell);
            contact.share.push_back(share);
        }
        share = 0.0f;
    }
    contact.touched.clear();
    point.end = static_cast<std::int32_t>(contact.phyxel.size());
}

/// sum_i psi_i field_i, in four sums at a time so that additions do not wait for each other.
float gather(const ContactWork& contact, const ContactPoint& point, const Array<float>& field) {
    std::array<float, 4> sum{};
    std::int32_t e = point.first;
    auto term = [&](std::int32_t at) {
        return contact.share[static_cast<std::size_t>(at)] *
               field[static_cast<std::size_t>(contact.phyxel[static_cast<std::size_t>(at)])];
    };
    for (; e + 4 <= point.end; e += 4)
        for (std::int32_t k = 0; k < 4; ++k) sum[static_cast<std::size_t>(k)] += term(e + k);
    for (; e < point.end; ++e) sum[0] += term(e);
    return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

void couple_points(Work& work) {
    ContactWork& contact = work.contact;
    const std::size_t count = contact.points.size();
    for (std::size_t c = 0; c < count; ++c) {
        const ContactPoint& point = contact.points[c];
        for (std::int32_t e = point.first; e < point.end; ++e) {
            const auto i = static_cast<std::size_t>(contact.phyxel[static_cast<std::size_t>(e)]);
            contact.spread[i] = contact.share[static_cast<std::size_t>(e)] * work.inverse_mass_per_kg[i];
        }
        for (std::size_t d = c; d < count; ++d) {
            const float value = gather(contact, contact.points[d], contact.spread);
            contact.coupling_per_kg[c * kMaxContactPoints + d] = value;
            contact.coupling_per_kg[d * kMaxContactPoints + c] = value;
        }
        for (std::int32_t e = point.first; e < point.end; ++e)
            contact.spread[static_cast<std::size_t>(contact.phyxel[static_cast<std::size_t>(e)])] = 0.0f;
    }
}

/// An impulse more at point c moves all points.
void push_points(ContactWork& contact, std::size_t c, const Vec3f& impulse) {
    const float* coupling = &contact.coupling_per_kg[c * kMaxContactPoints];
    const std::size_t count = contact.points.size();
    for (std::size_t r = 0; r < 3; ++r)
        for (std::size_t d = 0; d < count; ++d)
            contact.velocity_m_per_s[r][d] += coupling[d] * impulse[static_cast<int>(r)];
}

Vec3f velocity_of(const ContactWork& contact, std::size_t c) {
    return Vec3f(contact.velocity_m_per_s[0][c], contact.velocity_m_per_s[1][c], contact.velocity_m_per_s[2][c]);
}

/// Solves point c with all others as they are.
void solve_point(ContactWork& contact, std::size_t c, float friction, float dt) {
    ContactPoint& point = contact.points[c];
    const float coupling = contact.coupling_per_kg[c * kMaxContactPoints + c];
    if (coupling <= 0.0f) return;  // nothing that moves carries it
    const Vec3f relative = velocity_of(contact, c) - point.tool_velocity_m_per_s;
    const float closing = glm::dot(relative, point.normal);
    const float without = closing - coupling * point.normal_impulse_Ns;
    const float stiffness = point.stiffness_N_per_m;
    const float wanted = -stiffness * dt * (point.gap_m + dt * without) / (1.0f + stiffness * dt * dt * coupling);
    const float normal_impulse = std::fmax(0.0f, wanted);

    // Stick if friction suffices, else slide.
    Vec3f tangential = point.tangential_impulse_Ns - (relative - closing * point.normal) / coupling;
    const float most = friction * normal_impulse, length = glm::length(tangential);
    if (length > most) tangential *= most > 0.0f ? most / length : 0.0f;

    const Vec3f more =
        (normal_impulse - point.normal_impulse_Ns) * point.normal + (tangential - point.tangential_impulse_Ns);
    point.normal_impulse_Ns = normal_impulse;
    point.tangential_impulse_Ns = tangential;
    if (more != Vec3f(0.0f)) push_points(contact, c, more);
}

}  // namespace

ContactWork make_contact_work(const Model& model) {
    ContactWork contact;
    contact.points.reserve(kMaxContactPoints);
    contact.phyxel.reserve(kMaxContactPoints * kMostCarriers);
    contact.share.reserve(kMaxContactPoints * kMostCarriers);
    contact.touched.reserve(8 * kMostCarriers);
    contact.coupling_per_kg.assign(kMaxContactPoints * kMaxContactPoints, 0.0f);
    contact.spread.assign(static_cast<std::size_t>(model.phyxels.cells), 0.0f);
    return contact;
}

void prepare_contacts(const Model& model, const State& state, const tissue::Exchange& exchange, Work& work) {
    ContactWork& contact = work.contact;
    contact.points.clear();
    contact.phyxel.clear();
    contact.share.clear();
    contact.impulse_Ns = Vec3(0.0);
    contact.started = false;
    const std::size_t count = exchange.contacts.size(), kept = std::min<std::size_t>(count, kMaxContactPoints);
    if (kept == 0) return;
    const double spacing = model.hexels.spacing_m / kStandardHexel_m;
    const double stiffness =
        model.contact.stiffness_N_per_m * spacing * spacing * static_cast<double>(count) / static_cast<double>(kept);
    for (std::size_t k = 0; k < kept; ++k) {
        const tissue::Contact& from = exchange.contacts[k * count / kept];
        const tissue::NearHexel& hexel = exchange.near[static_cast<std::size_t>(from.near)];
        ContactPoint point;
        point.normal = from.normal;
        point.tool_velocity_m_per_s = from.tool_velocity_m_per_s;
        point.stiffness_N_per_m = static_cast<float>(stiffness);
        point.gap_m = from.gap_m;
        spread_point(model, state, work, hexel.hexel, hexel.rest_m);
        resolve_ghosts(model, work);
        collect_point(contact, point);
        contact.points.push_back(point);
    }
    couple_points(work);
}

void solve_contacts(const Model& model, State& state, Work& work) {
    ContactWork& contact = work.contact;
    const std::size_t count = contact.points.size();
    if (count == 0) return;
    for (std::size_t r = 0; r < 3; ++r)
        for (std::size_t c = 0; c < count; ++c)
            contact.velocity_m_per_s[r][c] = gather(contact, contact.points[c], state.velocity_m_per_s[r]);
    auto impulse_of = [](const ContactPoint& p) { return p.normal_impulse_Ns * p.normal + p.tangential_impulse_Ns; };
    for (std::size_t c = 0; c < count; ++c) {
        const Vec3f impulse = impulse_of(contact.points[c]);
        if (impulse != Vec3f(0.0f)) push_points(contact, c, impulse);
    }
    const auto friction = static_cast<float>(model.contact.friction);
    const int sweeps = contact.started ? kSweeps : kFirstSweeps;
    contact.started = true;
    for (int sweep = 0; sweep < sweeps; ++sweep)
        for (std::size_t c = 0; c < count; ++c) solve_point(contact, c, friction, work.substep_s);

    for (std::size_t c = 0; c < count; ++c) {
        ContactPoint& point = contact.points[c];
        const Vec3f impulse = impulse_of(point);
        point.gap_m += work.substep_s * glm::dot(velocity_of(contact, c) - point.tool_velocity_m_per_s, point.normal);
        if (impulse == Vec3f(0.0f)) continue;
        contact.impulse_Ns += Vec3(impulse);
        for (std::int32_t e = point.first; e < point.end; ++e) {
            const auto i = static_cast<std::size_t>(contact.phyxel[static_cast<std::size_t>(e)]);
            const float gain = contact.share[static_cast<std::size_t>(e)] * work.inverse_mass_per_kg[i];
            for (std::size_t r = 0; r < 3; ++r) state.velocity_m_per_s[r][i] += gain * impulse[static_cast<int>(r)];
        }
    }
}

}  // namespace calot::deformation

#include "calot/deformation/contact.h"

#include <algorithm>
#include <cmath>

#include "calot/base/random.h"
#include "calot/deformation/contact_kernel.h"
#include "calot/deformation/contact_spread.h"
#include "calot/deformation/ghosts.h"
#include "calot/deformation/grasp.h"

namespace calot::deformation {

using tissue::Model;
using tissue::State;

namespace {

/// Most phyxels that carry a point: the 5^3 about its own.
constexpr std::size_t kMostCarriers = 125;
/// With those that ghosts among them mirror: the 7^3.
constexpr std::size_t kMostMirrored = 343;
/// Spacing of hexels to which ContactParameters::stiffness_N_per_m belongs; it grows with the area that a hexel has.
constexpr double kStandardHexel_m = 0.6e-3;
/// Impulses of a tick before are taken over where normals agree within 60 degrees.
constexpr float kSameNormal = 0.5f;

std::int32_t padded(std::int32_t rows) {
    return (rows + kContactLanes - 1) / kContactLanes * kContactLanes;
}

// ---- Which points

/// Contacts that are solved: ContactWork::kept, in their order; rank says which of its phyxel's a contact is, by depth.
/// Those of a rank are kept before any of the next; of the last rank that finds room, evenly chosen ones. Returns the
/// share of phyxels that keep none, as a factor for the others' stiffness.
double choose(const Model& model, const tissue::Exchange& exchange, ContactWork& contact) {
    const auto count = static_cast<std::int32_t>(exchange.contacts.size());
    contact.owner.resize(static_cast<std::size_t>(count));
    contact.next.resize(static_cast<std::size_t>(count));
    contact.rank.assign(static_cast<std::size_t>(count), 0);
    auto deeper = [&](std::int32_t a, std::int32_t b) {
        const float x = exchange.contacts[static_cast<std::size_t>(a)].gap_m,
                    y = exchange.contacts[static_cast<std::size_t>(b)].gap_m;
        return x != y ? x < y : a < b;
    };
    std::array<std::int32_t, 64> of_rank{};
    for (std::int32_t c = 0; c < count; ++c) {
        const auto near = static_cast<std::size_t>(exchange.contacts[static_cast<std::size_t>(c)].near);
        const auto owner = model.phyxel_of(model.hexels.coordinates(exchange.near[near].hexel));
        std::int32_t& head = contact.row_of[static_cast<std::size_t>(owner)];
        contact.owner[static_cast<std::size_t>(c)] = static_cast<std::int32_t>(owner);
        for (std::int32_t other = head; other >= 0; other = contact.next[static_cast<std::size_t>(other)])
            ++contact.rank[static_cast<std::size_t>(deeper(c, other) ? other : c)];
        contact.next[static_cast<std::size_t>(c)] = head;
        head = c;
    }
    for (std::int32_t c = 0; c < count; ++c) {
        contact.row_of[static_cast<std::size_t>(contact.owner[static_cast<std::size_t>(c)])] = -1;
        ++of_rank[static_cast<std::size_t>(std::min(63, contact.rank[static_cast<std::size_t>(c)]))];
    }
    std::int32_t whole = 0, room = kMaxContactPoints;  // ranks that are kept whole
    while (whole < 63 && of_rank[static_cast<std::size_t>(whole)] > 0 &&
           of_rank[static_cast<std::size_t>(whole)] <= room)
        room -= of_rank[static_cast<std::size_t>(whole++)];
    const std::int32_t last = of_rank[static_cast<std::size_t>(whole)];
    contact.kept.clear();
    for (std::int32_t c = 0, seen = 0; c < count; ++c) {
        const std::int32_t rank = contact.rank[static_cast<std::size_t>(c)];
        bool keep = rank < whole;
        if (rank == whole && last > 0) {  // evenly: where the count of kept ones steps up
            keep = (seen + 1) * room / std::max(last, room) > seen * room / std::max(last, room);
            ++seen;
        }
        if (keep) contact.kept.push_back(c);
    }
    return whole > 0 || last <= kMaxContactPoints ? 1.0 : static_cast<double>(last) / kMaxContactPoints;
}

/// How many contacts of its phyxel each kept one stands for.
double stands_for(const ContactWork& contact, std::int32_t c) {
    const std::int32_t owner = contact.owner[static_cast<std::size_t>(c)];
    int all = 0, kept = 0;
    for (const std::int32_t other : contact.owner) all += other == owner ? 1 : 0;
    for (const std::int32_t other : contact.kept)
        kept += contact.owner[static_cast<std::size_t>(other)] == owner ? 1 : 0;
    return static_cast<double>(all) / kept;
}

void add_touching(const Model& model, const tissue::Exchange& exchange, ContactWork& contact) {
    const double spacing = model.hexels.spacing_m / kStandardHexel_m;
    const double stiffness = model.contact.stiffness_N_per_m * spacing * spacing;
    const bool all = exchange.contacts.size() <= static_cast<std::size_t>(kMaxContactPoints);
    const double share = all ? 1.0 : choose(model, exchange, contact);
    const std::size_t count = all ? exchange.contacts.size() : contact.kept.size();
    for (std::size_t k = 0; k < count; ++k) {
        const std::int32_t c = all ? static_cast<std::int32_t>(k) : contact.kept[k];
        const tissue::Contact& from = exchange.contacts[static_cast<std::size_t>(c)];
        ContactPoint point;
        point.normal = from.normal;
        point.tool_velocity_m_per_s = from.tool_velocity_m_per_s;
        point.stiffness_N_per_m = static_cast<float>(stiffness * (all ? 1.0 : share * stands_for(contact, c)));
        point.gap_m = from.gap_m;
        point.instrument = from.instrument;
        point.near = from.near;
        point.hexel = exchange.near[static_cast<std::size_t>(from.near)].hexel;
        contact.points.push_back(point);
    }
}

/// Normal impulses that the same hexels had in the tick before. Friction starts anew in every tick: taken over, it
/// holds single hexels beside the wire until they let go all at once (dips of 27 % in the force of a pressing foot; 12
/// % so).
void recall(const State& state, ContactWork& contact) {
    std::array<bool, tissue::kMostContactPoints> taken{};
    for (ContactPoint& point : contact.points) {
        if (point.held()) continue;
        for (std::size_t k = 0; k < static_cast<std::size_t>(state.contact.count); ++k) {
            if (taken[k] || state.contact.hexel[k] != point.hexel) continue;
            const Vec3f before = state.contact.impulse_Ns[k];
            const float normal = glm::dot(before, point.normal);
            if (!(normal > kSameNormal * glm::length(before))) continue;
            taken[k] = true;
            point.impulse_Ns = normal * point.normal;
            break;
        }
    }
}

// ---- What carries them

/// The row of a phyxel, which gets one if it has none.
std::int32_t row_of(ContactWork& contact, std::int64_t phyxel) {
    std::int32_t& row = contact.row_of[static_cast<std::size_t>(phyxel)];
    if (row < 0) {
        row = static_cast<std::int32_t>(contact.phyxel.size());
        contact.phyxel.push_back(static_cast<std::int32_t>(phyxel));
        contact.entry_of[static_cast<std::size_t>(row)] = -1;
    }
    return row;
}

/// Calls visit(phyxel, share) for all phyxels that carry a point; what a ghost carries, the phyxels that it mirrors do.
template <class Visit>
void for_each_carrier(const Work& work, const LocalShares& local, const Visit& visit) {
    for_each_share(local, [&](std::size_t at, float share) {
        const std::int64_t cell = local.owner + work.contact.share_offset[at];
        if (work.contact.row_of[static_cast<std::size_t>(cell)] != kGhostRow) return visit(cell, share);
        const Mirror& mirror = find_mirror(work, cell);
        for (int n = 0; n < mirror.count; ++n)
            visit(mirror.phyxel[static_cast<std::size_t>(n)], -share / static_cast<float>(mirror.count));
    });
}

/// Fills rows and lines from the local shares of all points.
void fill_lines(Work& work) {
    ContactWork& contact = work.contact;
    const std::size_t count = contact.points.size();
    contact.shares.clear();
    for (std::size_t c = 0; c < count; ++c) {
        const auto begin = static_cast<std::int32_t>(contact.shares.size());
        for_each_carrier(work, contact.local[c], [&](std::int64_t phyxel, float share) {
            const std::int32_t row = row_of(contact, phyxel);
            std::int32_t& entry = contact.entry_of[static_cast<std::size_t>(row)];
            if (entry < begin) {
                entry = static_cast<std::int32_t>(contact.shares.size());
                contact.shares.push_back({row, share});
            } else {
                contact.shares[static_cast<std::size_t>(entry)].share += share;
            }
        });
        contact.points[c].shares_end = static_cast<std::int32_t>(contact.shares.size());
    }
    contact.stride = padded(static_cast<std::int32_t>(contact.phyxel.size()));
    const auto stride = static_cast<std::size_t>(contact.stride);
    std::fill_n(contact.psi.begin(), count * stride, 0.0f);
    auto share = contact.shares.cbegin();
    for (std::size_t c = 0; c < count; ++c) {
        ContactPoint& point = contact.points[c];
        float* line = contact.psi.data() + c * stride;
        std::int32_t first = contact.stride, end = 0;
        for (; share != contact.shares.cbegin() + point.shares_end; ++share) {
            line[share->row] = share->share;
            first = std::min(first, share->row);
            end = std::max(end, share->row + 1);
        }
        point.first = end > 0 ? first / kContactLanes * kContactLanes : 0;
        point.end = padded(end);
    }
    for (std::size_t row = 0; row < stride; ++row) {
        const bool filled = row < contact.phyxel.size();
        const auto phyxel = filled ? static_cast<std::size_t>(contact.phyxel[row]) : 0;
        contact.inverse_mass_per_kg[row] = filled ? work.inverse_mass_per_kg[phyxel] : 0.0f;
        for (auto& velocity : contact.row_velocity_m_per_s) velocity[row] = 0.0f;
        if (filled) contact.row_of[phyxel] = -1;
    }
}

}  // namespace

ContactWork make_contact_work(const Model& model) {
    ContactWork contact;
    const auto cells = static_cast<std::size_t>(model.phyxels.cells);
    const auto rows = static_cast<std::size_t>(padded(
        static_cast<std::int32_t>(std::min<std::int64_t>(model.phyxel_initial.count(), kMaxPoints * kMostCarriers))));
    contact.points.reserve(kMaxPoints);
    contact.local.resize(kMaxPoints);
    contact.phyxel.reserve(rows);
    contact.shares.reserve(kMaxPoints * kMostMirrored);
    contact.entry_of.assign(rows, -1);
    contact.psi.assign(rows * kMaxPoints, 0.0f);
    contact.inverse_mass_per_kg.assign(rows, 0.0f);
    for (auto& velocity : contact.row_velocity_m_per_s) velocity.assign(rows, 0.0f);
    for (auto& impulse : contact.row_impulse_Ns) impulse.assign(rows, 0.0f);
    contact.coupling_per_kg.assign(kMaxPoints * kMaxPoints, 0.0f);
    for (auto& velocity : contact.velocity_m_per_s) velocity.assign(kMaxPoints, 0.0f);
    contact.row_of.assign(cells, -1);
    for (std::int64_t p = model.phyxels.first; p < model.phyxels.last; ++p)
        if (model.phyxel_ghost.test(p)) contact.row_of[static_cast<std::size_t>(p)] = kGhostRow;
    for (std::size_t at = 0; at < contact.share_offset.size(); ++at)
        contact.share_offset[at] = static_cast<std::int32_t>(model.phyxels.offset(share_step(static_cast<int>(at))));
    const auto most =
        static_cast<std::size_t>(std::min<std::int64_t>(model.hexel_initial.count(), tissue::kNearCapacity)) * 2;
    for (auto* list : {&contact.owner, &contact.next, &contact.rank}) list->reserve(most);
    contact.kept.reserve(kMaxContactPoints);
    return contact;
}

void list_points(const Model& model, const State& state, const tissue::Exchange& exchange, ContactWork& contact) {
    contact.points.clear();
    contact.phyxel.clear();
    contact.stride = 0;
    contact.impulse_Ns.fill(Vec3(0.0));
    contact.started = false;
    add_touching(model, exchange, contact);
    add_held(model, state, contact);
    recall(state, contact);
}

void carry_points(const Model& model, const State& state, Work& work) {
    // Points of a phyxel come one after another or nearly so.
    std::array<PhyxelCarriers, 8> kept;
    for (std::size_t c = 0; c < work.contact.points.size(); ++c) {
        const std::int64_t hexel = work.contact.points[c].hexel;
        const auto phyxel = static_cast<std::uint64_t>(model.phyxel_of(model.hexels.coordinates(hexel)));
        local_shares(model, state, work, hexel, kept[mix64(phyxel) % kept.size()], work.contact.local[c]);
    }
    fill_lines(work);
}

void prepare_contacts(const Model& model, const State& state, const tissue::Exchange& exchange, Work& work) {
    ContactWork& contact = work.contact;
    list_points(model, state, exchange, contact);
    if (contact.points.empty()) return;
    carry_points(model, state, work);
    couple_points(contact);
    place_held(model, state, exchange, contact);
}

void solve_contacts(const Model& model, State& state, Work& work) {
    ContactWork& contact = work.contact;
    if (contact.points.empty()) return;
    for (std::size_t r = 0; r < 3; ++r)
        for (std::size_t row = 0; row < contact.phyxel.size(); ++row)
            contact.row_velocity_m_per_s[r][row] =
                state.velocity_m_per_s[r][static_cast<std::size_t>(contact.phyxel[row])];
    gather_point_velocities(contact);
    push_all_points(contact);
    sweep_points(contact, contact.started ? kSweeps : kFirstSweeps, static_cast<float>(model.contact.friction),
                 work.substep_s);
    contact.started = true;
    spread_impulses(contact);
    for (std::size_t row = 0; row < contact.phyxel.size(); ++row)
        for (std::size_t r = 0; r < 3; ++r) {
            const auto phyxel = static_cast<std::size_t>(contact.phyxel[row]);
            const float more = contact.inverse_mass_per_kg[row] * contact.row_impulse_Ns[r][row];
            state.velocity_m_per_s[r][phyxel] += more;
            state.displacement_m[r][phyxel] += work.substep_s * more;
        }

    for (std::size_t c = 0; c < contact.points.size(); ++c) {
        ContactPoint& point = contact.points[c];
        const Vec3f velocity(contact.velocity_m_per_s[0][c], contact.velocity_m_per_s[1][c],
                             contact.velocity_m_per_s[2][c]);
        const Vec3f moved_m = work.substep_s * (velocity - point.tool_velocity_m_per_s);
        point.gap_m += glm::dot(moved_m, point.normal);
        point.away_m += moved_m;
        contact.impulse_Ns[static_cast<std::size_t>(point.instrument)] += Vec3(point.impulse_Ns);
    }
}

void remember_contacts(State& state, const Work& work) {
    tissue::ContactMemory& memory = state.contact;
    memory = {};
    for (const ContactPoint& point : work.contact.points) {
        if (point.held() || point.impulse_Ns == Vec3f(0.0f)) continue;
        const auto k = static_cast<std::size_t>(memory.count++);
        memory.hexel[k] = point.hexel;
        memory.impulse_Ns[k] = point.impulse_Ns;
    }
}

}  // namespace calot::deformation

// The surface hexels near the instrument, in the world.
//
// Phyxels first: those whose moved centre lies near a capsule. Then their surface hexels, by words: a hexel is inside
// where all six shifted neighbours are filled. The centres of hexels sit at the same m^3 places in every cell, so
// their kernel values are a table (Work::hexel_weight), and only which carriers live differs.
//
// Blending is what costs, so most is ruled out before: a blend lies within the carriers' fields, and these differ from
// the owner's own by no more than a bound that is the same for the whole cell.

#include <algorithm>
#include <array>
#include <cmath>

#include "calot/deformation/carriers.h"
#include "calot/deformation/embedding.h"
#include "calot/deformation/near_kernel.h"
#include "calot/deformation/occupancy.h"

namespace calot::deformation {

namespace {

float distance_to_surface(const CapsuleF& capsule, const Vec3f& p) {
    const Vec3f ap = p - capsule.a;
    const float t = std::min(1.0f, std::max(0.0f, glm::dot(ap, capsule.ab) * capsule.inverse_length2));
    const Vec3f d = ap - t * capsule.ab;
    return std::sqrt(glm::dot(d, d)) - capsule.radius;
}

}  // namespace

Capsules::Capsules(const std::vector<tissue::Capsule>& capsules, const NearReach& reach) {
    for (const tissue::Capsule& c : capsules) {
        if (count == item.size()) break;
        const Vec3f a(c.a_m), ab = Vec3f(c.b_m) - a;
        const float length2 = glm::dot(ab, ab);
        item[count++] = {a,
                         ab,
                         length2 > 0.0f ? 1.0f / length2 : 0.0f,
                         static_cast<float>(c.radius_m),
                         static_cast<float>(reach.of(c)),
                         c.bare};
    }
}

float Capsules::distance(const Vec3f& p) const {
    float nearest = 1e9f;
    for (std::size_t k = 0; k < count; ++k) nearest = std::min(nearest, distance_to_surface(item[k], p));
    return nearest;
}

float Capsules::beyond_reach(const Vec3f& p, std::uint32_t which) const {
    float least = 1e9f;
    for (std::uint32_t rest = which; rest != 0; rest &= rest - 1) {
        const CapsuleF& capsule = item[static_cast<std::size_t>(__builtin_ctz(rest))];
        least = std::min(least, distance_to_surface(capsule, p) - capsule.reach);
    }
    return least;
}

std::uint32_t Capsules::within(const Vec3f& p, float further_m) const {
    std::uint32_t which = 0;
    for (std::size_t k = 0; k < count; ++k)
        which |= (distance_to_surface(item[k], p) - item[k].reach <= further_m ? 1u : 0u) << k;
    return which;
}

float Capsules::bare_distance(const Vec3f& p) const {
    float nearest = 1e9f;
    for (std::size_t k = 0; k < count; ++k)
        if (item[k].bare) nearest = std::min(nearest, distance_to_surface(item[k], p));
    return nearest;
}

namespace {

/// The hexels of a phyxel with an absent face neighbour.
std::uint64_t surface_hexels(const tissue::Model& model, const Work& work, const OccupancyShifts& shifts,
                             std::int64_t phyxel) {
    auto filled = [&](std::int64_t p) {
        return work.occupancy[static_cast<std::size_t>(p)] | work.held[static_cast<std::size_t>(p)];
    };
    const std::uint64_t here = filled(phyxel);
    std::uint64_t inside = work.occupancy[static_cast<std::size_t>(phyxel)];
    const std::uint64_t own = inside;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::int64_t step = model.phyxels.stride[static_cast<int>(axis)];
        inside &= shifts.down(here, axis) | shifts.low_as_high(filled(phyxel + step), axis);
        inside &= shifts.up(here, axis) | shifts.high_as_low(filled(phyxel - step), axis);
    }
    return own & ~inside;
}

/// Away from the tissue at rest: against the sum of the directions to the 26 neighbours that are filled. 0 where they
/// balance, as in a sheet one hexel thick.
Vec3f rest_outward(const tissue::Model& model, const tissue::State& state, const OutwardRows& rows, std::int64_t hexel) {
    Vec3f sum(0.0f);
    for (std::size_t row = 0; row < rows.offset.size(); ++row) {
        const std::int64_t cell = hexel + rows.offset[row];
        const auto& row_outward =
            kRowOutward[row][(state.hexel_present.bits32(cell) | model.hexel_held.bits32(cell)) & 7u];
        sum += Vec3f(row_outward[0], row_outward[1], row_outward[2]);
    }
    Vec3f outward;
    for (int k = 0; k < 3; ++k) outward[rows.axis[k]] = sum[k];
    return outward;
}

/// A rest normal turned into the world by cof F = J F^-T, normalised.
Vec3f turn_normal(const Mat3f& F, const Vec3f& n) {
    const Vec3f turned = glm::cross(F[1], F[2]) * n.x + glm::cross(F[2], F[0]) * n.y + glm::cross(F[0], F[1]) * n.z;
    const float length = glm::length(turned);
    constexpr float kBalanced = 1e-3f;  // rounding of sums that cancel
    return length > kBalanced ? turned / length : Vec3f(0.0f);
}

/// Order of the heap that keeps the nearest: furthest on top, of equals the later cell.
bool nearer(const tissue::NearHexel& a, const tissue::NearHexel& b) {
    return a.distance_m != b.distance_m ? a.distance_m < b.distance_m : a.hexel < b.hexel;
}

void keep(std::vector<tissue::NearHexel>& near, const tissue::NearHexel& item) {
    constexpr auto kCapacity = static_cast<std::size_t>(tissue::kNearCapacity);
    if (near.size() < kCapacity) {
        near.push_back(item);
        if (near.size() == kCapacity) std::make_heap(near.begin(), near.end(), nearer);
        return;
    }
    if (!nearer(item, near.front())) return;
    std::pop_heap(near.begin(), near.end(), nearer);
    near.back() = item;
    std::push_heap(near.begin(), near.end(), nearer);
}

/// How far apart the displacements of any carrier and of the first can be, within `radius_m` of the phyxel's centre.
float bound_spread(const CarrierFields& fields, int count, float radius_m) {
    const FieldFours own = fours(fields.field[0]);
    float offset2 = 0.0f, gradient2 = 0.0f;  // the greatest
    for (int n = 1; n < count; ++n) {
        FieldFours d = fours(fields.field[static_cast<std::size_t>(n)]);
        for (std::size_t c = 0; c < d.size(); ++c) {
            d[c] -= own[c];
            d[c] *= d[c];
        }
        const Four rest = d[1] + d[2];
        offset2 = std::max(offset2, d[0][0] + d[0][1] + d[0][2]);
        gradient2 = std::max(gradient2, (d[0][3] + rest[0]) + (rest[1] + (rest[2] + rest[3])));
    }
    return std::sqrt(offset2) + radius_m * std::sqrt(gradient2);
}

/// Half the longest diagonal of a cube of half edge `half_m` after the first carrier's deformation.
float bound_stretch(const CarrierFields& fields, float half_m) {
    const Mat3f F = half_m * deformation_gradient_of(fields.field[0]);
    const Vec3f a = F[0] + F[1], b = F[0] - F[1];
    return std::max(std::max(glm::length(a + F[2]), glm::length(a - F[2])),
                    std::max(glm::length(b + F[2]), glm::length(b - F[2])));
}

/// Embeds the surface hexels of one phyxel and keeps those within reach.
void add_hexels(const tissue::Model& model, const tissue::State& state, tissue::Exchange& exchange, const Work& work,
                const OccupancyShifts& shifts, const OutwardRows& rows, const Capsules& capsules, std::int64_t phyxel,
                const Int3& c) {
    const std::uint64_t surface = surface_hexels(model, work, shifts, phyxel);
    if (surface == 0) return;
    const Carriers carriers = find_carriers(model, state, work, phyxel);
    if (carriers.count == 0) return;
    CarrierFields fields;
    fields.gather(model, state, work, carriers);
    const Vec3f centre_m(model.phyxels.centre_m(c));
    const auto half_hexel_m = static_cast<float>(0.5 * model.hexels.spacing_m);
    const float half_m = half_hexel_m * static_cast<float>(shifts.m - 1);  // of the cube of the hexels' centres
    const float spread_m = bound_spread(fields, carriers.count, std::sqrt(3.0f) * half_m);
    const std::uint32_t which = capsules.within(centre_m + displacement_at(fields.field[0], Vec3f(0.0f)),
                                                spread_m + bound_stretch(fields, half_m));
    if (which == 0) return;

    for (std::uint64_t rest = surface; rest != 0; rest &= rest - 1) {
        const int bit = __builtin_ctzll(rest);
        const Int3 cell = c * shifts.m + hexel_of_bit(shifts.m, bit);
        tissue::NearHexel item;
        item.rest_m = Vec3f(model.hexels.centre_m(cell));
        const Vec3f r = item.rest_m - centre_m;
        if (capsules.beyond_reach(item.rest_m + displacement_at(fields.field[0], r), which) > spread_m) continue;

        const float* table = work.hexel_weight.data() + kNeighbourhood * bit;
        std::array<float, kNeighbourhood> weight;
        for (std::size_t n = 0; n < static_cast<std::size_t>(carriers.count); ++n) weight[n] = table[carriers.cell[n]];
        const auto f = blend(fields, carriers.count, weight.data());
        item.world_m = item.rest_m + displacement_at(f, r);
        if (capsules.beyond_reach(item.world_m, which) > 0.0f) continue;
        item.distance_m = capsules.distance(item.world_m);
        item.hexel = model.hexels.index(cell);
        item.bare_gap_m = capsules.bare_distance(item.world_m) - half_hexel_m;
        item.outward = turn_normal(deformation_gradient_of(f), rest_outward(model, state, rows, item.hexel));
        keep(exchange.near, item);
    }
}

}  // namespace

void find_near(const tissue::Model& model, const tissue::State& state, tissue::Exchange& exchange, Work& work,
               const NearReach& reach) {
    exchange.near.clear();
    if (exchange.capsules.empty()) return;
    const OccupancyShifts shifts(model.hexels_per_edge);
    const Capsules capsules(exchange.capsules, reach);
    const OutwardRows rows(model.hexels);
    PlaceView places;
    for (std::size_t r = 0; r < 3; ++r) {
        places.rest_m[r] = work.rest_m[r].data();
        places.displacement_m[r] = state.displacement_m[r].data();
    }
    find_near_phyxels(places, work.groups, capsules, static_cast<float>(kPhyxelMargin * model.phyxels.spacing_m),
                      work.near_lanes);
    for (std::size_t g = 0; g < work.groups.size(); ++g) {
        const Group& group = work.groups[g];
        for (std::uint32_t rest = group.present & work.near_lanes[g]; rest != 0; rest &= rest - 1) {
            const std::int64_t phyxel = group.first + __builtin_ctz(rest);
            add_hexels(model, state, exchange, work, shifts, rows, capsules, phyxel, model.phyxels.coordinates(phyxel));
        }
    }
    std::sort(exchange.near.begin(), exchange.near.end(),
              [](const tissue::NearHexel& a, const tissue::NearHexel& b) { return a.hexel < b.hexel; });
}

}  // namespace calot::deformation

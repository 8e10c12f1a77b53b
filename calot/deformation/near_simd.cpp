// The wide parts of the search for near hexels (near_kernel.h). What only rules out may round as it likes, with a
// margin; what is kept is computed as a plain loop over hexels, carriers and capsules would: every instruction set
// gives the same bytes.

#include <algorithm>
#include <cmath>
#include <cstring>

#include "calot/deformation/near_kernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "calot/deformation/near_simd.cpp"
#include <hwy/foreach_target.h>

#include "calot/base/simd.h"

HWY_BEFORE_NAMESPACE();
namespace calot::deformation {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace simd = calot::HWY_NAMESPACE::simd;

using D = simd::Floats;
using V = hn::Vec<D>;
constexpr int kLanes = static_cast<int>(hn::MaxLanes(D()));

/// More than rounding in what rules out.
constexpr float kRounding_m = 1e-6f;

HWY_INLINE std::uint32_t bits_of(hn::Mask<D> mask) {
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(D(), mask, bytes);
    return bytes[0] | static_cast<std::uint32_t>(bytes[1]) << 8;
}

HWY_INLINE V dot(V ax, V ay, V az, V bx, V by, V bz) {
    return hn::Add(hn::Add(hn::Mul(ax, bx), hn::Mul(ay, by)), hn::Mul(az, bz));
}

/// |p - a - t ab|^2 at the nearest t in [0, 1], where `x`, `y`, `z` are p - a.
HWY_INLINE V squared_distance(V x, V y, V z, V abx, V aby, V abz, V inverse_length2) {
    const D d;
    V t = hn::Mul(dot(x, y, z, abx, aby, abz), inverse_length2);
    t = hn::Min(hn::Max(t, hn::Zero(d)), hn::Set(d, 1.0f));
    const V dx = hn::Sub(x, hn::Mul(t, abx)), dy = hn::Sub(y, hn::Mul(t, aby)), dz = hn::Sub(z, hn::Mul(t, abz));
    return dot(dx, dy, dz, dx, dy, dz);
}

HWY_INLINE V squared_distance(const CapsuleF& capsule, V px, V py, V pz) {
    const D d;
    return squared_distance(hn::Sub(px, hn::Set(d, capsule.a.x)), hn::Sub(py, hn::Set(d, capsule.a.y)),
                            hn::Sub(pz, hn::Set(d, capsule.a.z)), hn::Set(d, capsule.ab.x), hn::Set(d, capsule.ab.y),
                            hn::Set(d, capsule.ab.z), hn::Set(d, capsule.inverse_length2));
}

/// Lanes at most `further_m` beyond a capsule's reach.
HWY_INLINE hn::Mask<D> within(const CapsuleF& capsule, V px, V py, V pz, float further_m) {
    const float most = capsule.radius + (capsule.reach + further_m);
    return hn::Le(squared_distance(capsule, px, py, pz), hn::Set(D(), most * most));
}

HWY_INLINE V place(const PlaceView& view, std::size_t axis, std::int64_t i) {
    const D d;
    return hn::Add(hn::LoadU(d, view.rest_m[axis] + i), hn::LoadU(d, view.displacement_m[axis] + i));
}

void list_phyxels(const PlaceView& view, std::span<const Group> groups, const Capsules& capsules, float further_m,
                  std::span<const CapsuleF> bounds, NearWork& near) {
    const D d;
    near.blocks.clear();
    std::size_t free = 0;  // lanes of the last block
    for (const Group& group : groups) {
        if (group.present == 0) continue;
        for (int lane = 0; lane < kGroupCells; lane += kLanes) {
            const std::int64_t i = group.first + lane;
            const V x = place(view, 0, i), y = place(view, 1, i), z = place(view, 2, i);
            const auto present = simd::mask_of(d, group.present, lane);
            hn::Mask<D> lanes = hn::FirstN(d, 0);
            std::uint32_t which = 0;
            for (const CapsuleF& bound : bounds) {
                if (hn::AllFalse(d, within(bound, x, y, z, 0.0f))) continue;
                for (std::size_t k = 0; k < capsules.count; ++k) {
                    if (capsules.item[k].instrument != bound.instrument) continue;
                    const auto near_lanes = hn::And(within(capsules.item[k], x, y, z, further_m), present);
                    lanes = hn::Or(lanes, near_lanes);
                    which |= (hn::AllFalse(d, near_lanes) ? 0u : 1u) << k;
                }
            }
            if (which == 0) continue;
            for (std::uint32_t rest = bits_of(lanes); rest != 0; rest &= rest - 1) {
                if (free == 0) {
                    near.blocks.emplace_back();
                    free = 16;
                }
                NearBlock& block = near.blocks.back();
                const std::size_t at = 16 - free--;
                const std::int64_t cell = i + __builtin_ctz(rest);
                block.cell[at] = static_cast<std::int32_t>(cell);
                for (std::size_t r = 0; r < 3; ++r) block.rest_m[r][at] = view.rest_m[r][cell];
                block.there = static_cast<std::uint16_t>(block.there | 1u << at);
                block.capsules = static_cast<std::uint16_t>(block.capsules | which);
            }
        }
    }
}

void find_phyxels(const PlaceView& view, const Capsules& capsules, float further_m, NearWork& near) {
    const D d;
    const hn::RebindToSigned<D> di;
    for (NearBlock& block : near.blocks) {
        std::uint32_t bits = 0;
        for (std::size_t lane = 0; lane < 16; lane += kLanes) {
            const auto cells = hn::Load(di, block.cell.data() + lane);
            const auto at = [&](std::size_t r) HWY_ATTR {
                return hn::Add(hn::Load(d, block.rest_m[r].data() + lane),
                               hn::GatherIndex(d, view.displacement_m[r], cells));
            };
            const V x = at(0), y = at(1), z = at(2);
            hn::Mask<D> near_lanes = hn::FirstN(d, 0);
            for (std::uint32_t rest = block.capsules; rest != 0; rest &= rest - 1)
                near_lanes = hn::Or(near_lanes, within(capsules.item[static_cast<std::size_t>(__builtin_ctz(rest))], x,
                                                       y, z, further_m));
            bits |= bits_of(near_lanes) << lane;
        }
        block.near = static_cast<std::uint16_t>(bits & block.there);
    }
}

// ---- Hexels of one phyxel

constexpr std::size_t kOwnSlot = 13;

/// The fields of the cells about a phyxel by component, each as a + G r with r = X - X_owner.
struct SlotFields {
    alignas(64) float of[12][32];

    HWY_INLINE void gather(const CellView& view, std::int64_t phyxel) {
        const D d;
        for (std::size_t c = 0; c < 12; ++c) {
            const float* from = view.field[c] + phyxel;
            for (std::size_t row = 0; row < 9; ++row)  // a fourth cell is overwritten by the next row
                std::memcpy(of[c] + 3 * row, from + view.row[row], sizeof(Four));
            std::memset(of[c] + 28, 0, sizeof(Four));
        }
        for (std::size_t s = 0; s < 32; s += kLanes) {
            const V x = hn::Load(d, view.step_m[0].data() + s), y = hn::Load(d, view.step_m[1].data() + s),
                    z = hn::Load(d, view.step_m[2].data() + s);
            for (std::size_t r = 0; r < 3; ++r) {
                const V moved = dot(hn::Load(d, of[3 + 3 * r] + s), hn::Load(d, of[4 + 3 * r] + s),
                                    hn::Load(d, of[5 + 3 * r] + s), x, y, z);
                hn::Store(hn::Sub(hn::Load(d, of[r] + s), moved), d, of[r] + s);
            }
        }
    }

    /// How far apart the displacements of any of `slots` and of the own field can be, within `radius_m` of the centre.
    HWY_INLINE float spread(std::uint32_t slots, float radius_m) const {
        const D d;
        V most = hn::Zero(d);
        for (std::size_t s = 0; s < 32; s += kLanes) {
            const auto squared = [&](std::size_t c) HWY_ATTR {
                const auto off = [&](std::size_t k)
                                     HWY_ATTR { return hn::Sub(hn::Load(d, of[k] + s), hn::Set(d, of[k][kOwnSlot])); };
                const V x = off(c), y = off(c + 1), z = off(c + 2);
                return dot(x, y, z, x, y, z);
            };
            const V gradient = hn::Sqrt(hn::Add(hn::Add(squared(3), squared(6)), squared(9)));
            const V apart = hn::Add(hn::Sqrt(squared(0)), hn::Mul(hn::Set(d, radius_m), gradient));
            const auto there = simd::mask_of(d, static_cast<std::uint16_t>(slots >> s), 0);
            most = hn::Max(most, hn::IfThenElseZero(there, apart));
        }
        return hn::GetLane(hn::MaxOfLanes(d, most));
    }

    /// By cell instead, in the order of carriers. A last one holds nothing.
    HWY_INLINE void turn(const CellView& view, PaddedField* out) const {
        const auto load = [&](std::size_t c, std::size_t s) HWY_ATTR {
            Four four;
            std::memcpy(&four, of[c] + s, sizeof(four));
            return four;
        };
        for (std::size_t s = 0; s < 28; s += 4)
            for (std::size_t c = 0; c < 12; c += 4) {
                const Four x = load(c, s), y = load(c + 1, s), z = load(c + 2, s), w = load(c + 3, s);
                const Four xy0 = __builtin_shufflevector(x, y, 0, 4, 1, 5),
                           xy1 = __builtin_shufflevector(x, y, 2, 6, 3, 7),
                           zw0 = __builtin_shufflevector(z, w, 0, 4, 1, 5),
                           zw1 = __builtin_shufflevector(z, w, 2, 6, 3, 7);
                const Four cell[4] = {
                    __builtin_shufflevector(xy0, zw0, 0, 1, 4, 5), __builtin_shufflevector(xy0, zw0, 2, 3, 6, 7),
                    __builtin_shufflevector(xy1, zw1, 0, 1, 4, 5), __builtin_shufflevector(xy1, zw1, 2, 3, 6, 7)};
                for (std::size_t k = 0; k < 4; ++k)
                    std::memcpy(out[view.place[s + k]].data() + c, &cell[k], sizeof(Four));
            }
    }

    HWY_INLINE Vec3f own_column(std::size_t column) const {
        Vec3f f(of[3 + column][kOwnSlot], of[6 + column][kOwnSlot], of[9 + column][kOwnSlot]);
        f[static_cast<int>(column)] += 1.0f;
        return f;
    }
};

/// Half the longest diagonal of a cube of half edge 1 after a deformation with these columns.
HWY_INLINE float longest_diagonal(const Vec3f& x, const Vec3f& y, const Vec3f& z) {
    const Vec3f a = x + y, b = x - y, p = a + z, q = a - z, r = b + z, s = b - z;
    return std::sqrt(std::max(std::max(glm::dot(p, p), glm::dot(q, q)), std::max(glm::dot(r, r), glm::dot(s, s))));
}

/// Capsules whose reach a place is at most `further_m` beyond.
HWY_INLINE std::uint32_t which_reach(const CapsuleLanes& capsules, const Vec3f& p, float further_m) {
    const D d;
    std::uint32_t which = 0;
    for (std::size_t k = 0; k < 16; k += kLanes) {
        const auto load = [&](const std::array<float, 16>& values) HWY_ATTR { return hn::Load(d, values.data() + k); };
        const V squared = squared_distance(hn::Sub(hn::Set(d, p.x), load(capsules.a[0])),
                                           hn::Sub(hn::Set(d, p.y), load(capsules.a[1])),
                                           hn::Sub(hn::Set(d, p.z), load(capsules.a[2])), load(capsules.ab[0]),
                                           load(capsules.ab[1]), load(capsules.ab[2]), load(capsules.inverse_length2));
        const V most = hn::Max(hn::Add(load(capsules.within), hn::Set(d, further_m)), hn::Zero(d));
        which |= bits_of(hn::Lt(squared, hn::Mul(most, most))) << k;
    }
    return which;
}

/// Of `hexels`, those that in the own field are at most `further_m` beyond the reach of the capsules `which`.
HWY_INLINE std::uint64_t reached(const CellView& view, const SlotFields& fields, const Vec3f& centre,
                                 std::uint32_t which, float further_m, std::uint64_t hexels) {
    const D d;
    const Vec3f fx = fields.own_column(0), fy = fields.own_column(1), fz = fields.own_column(2);
    std::uint64_t found = 0;
    for (int lane = 0; lane < 64; lane += kLanes) {
        const std::uint64_t here = (hexels >> lane) & ((std::uint64_t{1} << kLanes) - 1);
        if (here == 0) continue;
        const V rx = hn::Load(d, view.tables->offset_m[0].data() + lane),
                ry = hn::Load(d, view.tables->offset_m[1].data() + lane),
                rz = hn::Load(d, view.tables->offset_m[2].data() + lane);
        const auto at = [&](int axis) HWY_ATTR {
            return hn::Add(hn::Set(d, centre[axis]),
                           dot(rx, ry, rz, hn::Set(d, fx[axis]), hn::Set(d, fy[axis]), hn::Set(d, fz[axis])));
        };
        const V x = at(0), y = at(1), z = at(2);
        hn::Mask<D> lanes = hn::FirstN(d, 0);
        for (std::uint32_t rest = which; rest != 0; rest &= rest - 1)
            lanes = hn::Or(
                lanes, within(view.capsules->item[static_cast<std::size_t>(__builtin_ctz(rest))], x, y, z, further_m));
        found |= (here & bits_of(lanes)) << lane;
    }
    return found;
}

/// sum_n weight[n] field[n] / sum_n weight[n] over the carriers in their order, as blend() of carriers.h. Those that
/// are not there count with a weight of 0: their number is hard to predict.
HWY_INLINE void blend_one(const PaddedField* fields, const HexelWeights& table, std::uint32_t carriers, float* out) {
    const D d;
    const hn::RebindToUnsigned<D> du;
    alignas(64) std::array<float, 16> weight;
    for (std::size_t n = 0; n < 16; n += kLanes) {
        const auto place = hn::BitCast(du, hn::Load(hn::RebindToSigned<D>(), table.carrier.data() + n));
        const auto one = hn::Set(du, 1u);
        const auto there = hn::Eq(hn::And(hn::Shr(hn::Set(du, carriers), place), one), one);
        hn::Store(hn::IfThenElseZero(hn::RebindMask(d, there), hn::Load(d, table.weight.data() + n)), d,
                  weight.data() + n);
    }
    for (std::size_t c = 0; c < 12; c += kLanes) {
        V sum = hn::Zero(d), total = sum;
        for (std::size_t n = 0; n < kMostWeighted; ++n) {
            const V w = hn::Set(d, weight[n]);
            total = hn::Add(total, w);
            sum = hn::Add(sum, hn::Mul(w, hn::Load(d, fields[table.carrier[n]].data() + c)));
        }
        hn::Store(hn::Mul(sum, hn::Set(d, 1.0f / hn::GetLane(total))), d, out + c);
    }
}

std::uint64_t blend_cell(const CellView& view, const Cell& cell, PaddedField* blended) {
    SlotFields fields;
    fields.gather(view, cell.phyxel);
    std::uint32_t slots = 0;
    for (std::size_t s = 0; s < kNeighbourhood; ++s) slots |= ((cell.carriers >> view.place[s]) & 1u) << s;
    const float spread_m = fields.spread(slots, std::sqrt(3.0f) * view.half_m) + kRounding_m;
    const float stretch_m =
        view.half_m * longest_diagonal(fields.own_column(0), fields.own_column(1), fields.own_column(2));
    const Vec3f centre_m =
        cell.centre_m + Vec3f(fields.of[0][kOwnSlot], fields.of[1][kOwnSlot], fields.of[2][kOwnSlot]);
    const std::uint32_t which = which_reach(*view.lanes, centre_m, spread_m + stretch_m);
    if (which == 0) return 0;
    const std::uint64_t hexels = reached(view, fields, centre_m, which, spread_m, cell.hexels);
    if (hexels == 0) return 0;
    alignas(64) PaddedField of[kNeighbourhood + 1];
    for (PaddedField& field : of) std::memset(field.data() + 12, 0, sizeof(Four));
    fields.turn(view, of);
    for (std::uint64_t rest = hexels; rest != 0; rest &= rest - 1) {
        const auto bit = static_cast<std::size_t>(__builtin_ctzll(rest));
        blend_one(of, view.tables->weights[bit], cell.carriers, (blended++)->data());
    }
    return hexels;
}

void measure_places(const Capsules& capsules, NearPlaces& places) {
    const D d;
    for (std::size_t i = 0; i < places.count; i += kLanes) {
        const V x = hn::Load(d, places.world_m[0].data() + i), y = hn::Load(d, places.world_m[1].data() + i),
                z = hn::Load(d, places.world_m[2].data() + i);
        V beyond = hn::Set(d, 1e9f), nearest = beyond, bare = beyond;
        for (std::size_t k = 0; k < capsules.count; ++k) {
            const CapsuleF& capsule = capsules.item[k];
            const V distance = hn::Sub(hn::Sqrt(squared_distance(capsule, x, y, z)), hn::Set(d, capsule.radius));
            beyond = hn::Min(beyond, hn::Sub(distance, hn::Set(d, capsule.reach)));
            nearest = hn::Min(nearest, distance);
            if (capsule.bare) bare = hn::Min(bare, distance);
        }
        hn::Store(beyond, d, places.beyond_m.data() + i);
        hn::Store(nearest, d, places.distance_m.data() + i);
        hn::Store(bare, d, places.bare_m.data() + i);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace calot::deformation
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace calot::deformation {

HWY_EXPORT(list_phyxels);
HWY_EXPORT(find_phyxels);
HWY_EXPORT(blend_cell);
HWY_EXPORT(measure_places);

namespace {

/// One capsule about all that is `further_m` beyond the reach of an instrument's, along the longest of them; false
/// where it has none. Its reach is within its radius.
bool bound(const Capsules& capsules, tissue::Instrument instrument, float further_m, CapsuleF& out) {
    const CapsuleF* longest = nullptr;
    for (std::size_t k = 0; k < capsules.count; ++k) {
        const CapsuleF& item = capsules.item[k];
        if (item.instrument != instrument) continue;
        if (longest == nullptr || glm::dot(item.ab, item.ab) > glm::dot(longest->ab, longest->ab)) longest = &item;
    }
    if (longest == nullptr) return false;
    float first = 0.0f, last = 1.0f, aside_m = 0.0f, most_m = 0.0f;
    for (std::size_t k = 0; k < capsules.count; ++k) {
        const CapsuleF& item = capsules.item[k];
        if (item.instrument != instrument) continue;
        most_m = std::max(most_m, item.radius + item.reach);
        for (const Vec3f& end : {item.a, item.a + item.ab}) {
            const Vec3f from = end - longest->a;
            const float t = glm::dot(from, longest->ab) * longest->inverse_length2;
            first = std::min(first, t);
            last = std::max(last, t);
            aside_m = std::max(aside_m, glm::length(from - t * longest->ab));
        }
    }
    constexpr float kRounding_m = 1e-5f;
    out = *longest;
    out.a += first * longest->ab;
    out.ab *= last - first;
    out.inverse_length2 = out.inverse_length2 / ((last - first) * (last - first));
    out.radius = most_m + aside_m + further_m + kRounding_m;
    out.reach = 0.0f;
    return true;
}

}  // namespace

CapsuleLanes::CapsuleLanes(const Capsules& capsules) : a{}, ab{}, inverse_length2{}, within{} {
    within.fill(-1e9f);
    for (std::size_t k = 0; k < capsules.count; ++k) {
        const CapsuleF& capsule = capsules.item[k];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            a[axis][k] = capsule.a[static_cast<int>(axis)];
            ab[axis][k] = capsule.ab[static_cast<int>(axis)];
        }
        inverse_length2[k] = capsule.inverse_length2;
        within[k] = capsule.radius + capsule.reach;
    }
}

void list_near_phyxels(const PlaceView& view, std::span<const Group> groups, const Capsules& capsules, float further_m,
                       NearWork& near) {
    std::array<CapsuleF, tissue::kInstruments> bounds;
    std::size_t count = 0;
    for (std::size_t k = 0; k < tissue::kInstruments; ++k)
        if (bound(capsules, static_cast<tissue::Instrument>(k), further_m, bounds[count])) ++count;
    HWY_DYNAMIC_DISPATCH(list_phyxels)(view, groups, capsules, further_m, {bounds.data(), count}, near);
}

void find_near_phyxels(const PlaceView& view, const Capsules& capsules, float further_m, NearWork& near) {
    HWY_DYNAMIC_DISPATCH(find_phyxels)(view, capsules, further_m, near);
}

std::uint64_t blend_near(const CellView& view, const Cell& cell, PaddedField* blended) {
    return HWY_DYNAMIC_DISPATCH(blend_cell)(view, cell, blended);
}

void measure(const Capsules& capsules, NearPlaces& places) {
    HWY_DYNAMIC_DISPATCH(measure_places)(capsules, places);
}

}  // namespace calot::deformation
#endif

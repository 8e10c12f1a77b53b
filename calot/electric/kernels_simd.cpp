// The loops of kernels.h, a vector of neighbouring cells at a time. Neighbours are unaligned loads at constant offsets.

#include <algorithm>
#include <cstring>

#include "calot/electric/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "calot/electric/kernels_simd.cpp"
#include <hwy/foreach_target.h>

#include <hwy/cache_control.h>
#include "calot/base/simd.h"

HWY_BEFORE_NAMESPACE();
namespace calot::electric {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace simd = calot::HWY_NAMESPACE::simd;

using D = simd::Floats;
using V = hn::Vec<D>;

HWY_INLINE V load(const float* p) {
    return hn::LoadU(D(), p);
}
HWY_INLINE void store(V v, float* p) {
    hn::StoreU(v, D(), p);
}
HWY_INLINE V all(float value) {
    return hn::Set(D(), value);
}
HWY_INLINE std::int64_t lanes() {
    return static_cast<std::int64_t>(hn::Lanes(D()));
}

/// Adds a vector's lanes, in double, to as many places.
HWY_INLINE void add_lanes(V values, double* place) {
#if HWY_TARGET == HWY_SCALAR
    *place += static_cast<double>(hn::GetLane(values));
#else
    const hn::Half<D> half;
    const hn::Rebind<double, decltype(half)> wide;
    const auto low = hn::PromoteTo(wide, hn::LowerHalf(half, values));
    const auto high = hn::PromoteTo(wide, hn::UpperHalf(half, values));
    double* high_place = place + hn::Lanes(wide);
    hn::Store(hn::Add(hn::Load(wide, place), low), wide, place);
    hn::Store(hn::Add(hn::Load(wide, high_place), high), wide, high_place);
#endif
}

/// Partial sums, whatever the width of a vector.
struct Sum {
    alignas(64) double place[kSums] = {};

    /// `cell` counts from the first cell of the range.
    HWY_INLINE void add(std::int64_t cell, V products) { add_lanes(products, place + cell % kSums); }
    HWY_INLINE double total() const {
        double sum = 0.0;
        for (double value : place) sum += value;
        return sum;
    }
};

/// Pointers of a level, so that the compiler need not fetch them anew after every store.
struct Rows {
    const float *gx, *gy, *gz, *ground;
    std::int64_t row, plane;
    HWY_INLINE explicit Rows(const Level& level)
        : gx(level.g[0].data()),
          gy(level.g[1].data()),
          gz(level.g[2].data()),
          ground(level.ground.data()),
          row(level.row),
          plane(level.plane) {}

    /// (A z) of the cells from i on.
    HWY_INLINE V times(const float* z, std::int64_t i) const {
        const V here = load(z + i);
        auto flow = [&](const float* g, std::int64_t face, std::int64_t there)
                        HWY_ATTR { return hn::Mul(load(g + face), hn::Sub(here, load(z + there))); };
        V sum = hn::Add(flow(gx, i, i + 1), flow(gx, i - 1, i - 1));
        sum = hn::Add(sum, hn::Add(flow(gy, i, i + row), flow(gy, i - row, i - row)));
        sum = hn::Add(sum, hn::Add(flow(gz, i, i + plane), flow(gz, i - plane, i - plane)));
        return hn::Add(sum, hn::Mul(load(ground + i), here));
    }
};

/// Calls for lines of arrays at a group some way ahead of the n-th, about the time that memory takes.
template <class... Pointers>
HWY_INLINE void call_for(const Level& level, std::int64_t n, std::int64_t end, Pointers... arrays) {
    constexpr std::int64_t kAhead = 12;
    if (n + kAhead >= end) return;
    const std::int64_t at = level.groups[static_cast<std::size_t>(n + kAhead)].at;
    (hwy::Prefetch(arrays + at), ...);
}

/// One value per material, for the lanes of a vector that `wanted` names; the others get anything.
struct Lookup {
    using DI = hn::RebindToSigned<D>;
    hn::Vec<DI> index;
    std::int32_t first;
    bool same;
    HWY_INLINE Lookup(const tissue::MaterialIndex* material, hn::Mask<D> wanted)
        : index(hn::PromoteTo(DI(), hn::LoadU(hn::Rebind<std::uint8_t, D>(), material))),
          first(material[hn::FindFirstTrue(D(), wanted)]),
          same(hn::AllFalse(D(), hn::AndNot(hn::RebindMask(D(), hn::Eq(index, hn::Set(DI(), first))), wanted))) {}
    HWY_INLINE V of(const Conductivity::PerMaterial<float>& table) const {
        if (HWY_LIKELY(same)) return all(table[static_cast<std::size_t>(first)]);
        return hn::GatherIndex(D(), table.data(), index);
    }
};

/// As it is in hexels that are not at rest.
HWY_INLINE V warm_conductivity(const Conductivity& tissue, V rest, V enthalpy, std::int64_t hexel,
                               hn::Mask<D> warm) {
    const Lookup lookup(tissue.material + hexel, warm);
    const V water = load(tissue.water_kg_per_m3 + hexel);
    const V capacity =
        hn::Add(lookup.of(tissue.dry_capacity_J_per_m3K), hn::Mul(water, lookup.of(tissue.water_capacity_J_per_kgK)));
    const V rise = hn::Min(hn::Mul(enthalpy, hn::Div(all(1.0f), capacity)), all(tissue.wet_limit_K));
    const V wet = hn::Mul(rest, hn::Add(all(1.0f), hn::Mul(lookup.of(tissue.slope_per_K), rise)));
    const V missing =
        hn::Mul(hn::Sub(lookup.of(tissue.alive_water_kg_per_m3), water), lookup.of(tissue.per_water_m3_per_kg));
    return hn::Sub(wet, hn::Mul(hn::Sub(wet, lookup.of(tissue.dry_S_per_m)), missing));
}

void gather(const Conductivity& tissue, std::int64_t first, std::int64_t count, float* out) {
    const D d;
    std::int64_t k = 0;
    for (; k + lanes() <= count; k += lanes()) {
        const std::int64_t hexel = first + k;
        const auto present = simd::mask_at(d, tissue.present, hexel);
        const auto conducts = hn::Or(present, simd::mask_at(d, tissue.held, hexel));
        if (hn::AllFalse(d, conducts)) {
            store(hn::Zero(d), out + k);
            continue;
        }
        V sigma = hn::IfThenElseZero(conducts, load(tissue.rest_S_per_m + hexel));
        const V enthalpy = load(tissue.enthalpy_J_per_m3 + hexel);
        const auto warm = hn::And(present, hn::Ne(enthalpy, hn::Zero(d)));
        if (!hn::AllFalse(d, warm))
            sigma = hn::IfThenElse(warm, warm_conductivity(tissue, sigma, enthalpy, hexel, warm), sigma);
        store(sigma, out + k);
    }
    for (; k < count; ++k) out[k] = tissue.of(first + k);
}

void faces(Level& level, const float* sigma, std::int64_t begin, std::int64_t end) {
    float* const g[3] = {level.g[0].data(), level.g[1].data(), level.g[2].data()};
    float* ground = level.ground.data();
    const std::int64_t step[3] = {1, level.row, level.plane};
    for (std::int64_t n = begin; n < end; ++n) {
        call_for(level, n, end, sigma, sigma + level.plane, g[0], g[1], g[2], ground);
        const std::int64_t at = level.groups[static_cast<std::size_t>(n)].at;
        for (std::int64_t i = at; i < at + kGroup; i += lanes()) {
            const V here = load(sigma + i);
            for (int axis = 0; axis < 3; ++axis) {
                const V there = load(sigma + i + step[axis]);
                const V twice = hn::Mul(hn::Mul(all(2.0f), here), there);
                store(hn::Div(twice, hn::Max(hn::Add(here, there), all(1e-30f))), g[axis] + i);
            }
            store(all(0.0f), ground + i);
        }
    }
}

void weights(Level& level, std::int64_t begin, std::int64_t end) {
    const Rows rows(level);
    float* weight = level.weight.data();
    for (std::int64_t n = begin; n < end; ++n) {
        call_for(level, n, end, rows.gx, rows.gy, rows.gz, rows.ground, weight);
        const std::int64_t at = level.groups[static_cast<std::size_t>(n)].at;
        for (std::int64_t i = at; i < at + kGroup; i += lanes()) {
            V sum = hn::Add(load(rows.ground + i), hn::Add(load(rows.gx + i), load(rows.gx + i - 1)));
            sum = hn::Add(sum, hn::Add(load(rows.gy + i), load(rows.gy + i - rows.row)));
            sum = hn::Add(sum, hn::Add(load(rows.gz + i), load(rows.gz + i - rows.plane)));
            const auto unknown = hn::Gt(sum, all(0.0f));
            store(hn::IfThenElseZero(unknown, hn::Div(all(kDamping), sum)), weight + i);
        }
    }
}

/// Sum over the four fine rows of an aggregate, from p on.
HWY_INLINE V four(const float* p, std::int64_t row, std::int64_t plane) {
    return hn::Add(hn::Add(load(p), load(p + row)), hn::Add(load(p + plane), load(p + row + plane)));
}
/// Every other lane of low and high together.
#if HWY_TARGET == HWY_SCALAR
HWY_INLINE V even(V, V low) {
    return low;
}
HWY_INLINE V odd(V high, V) {
    return high;
}
#else
HWY_INLINE V even(V high, V low) {
    return hn::ConcatEven(D(), high, low);
}
HWY_INLINE V odd(V high, V low) {
    return hn::ConcatOdd(D(), high, low);
}
#endif

void aggregate(const Level& fine, Level& coarse, int plane) {
    const D d;
    const std::int64_t n = lanes(), y = fine.row, z = fine.plane;
    for (int b = 0; b < coarse.cells; ++b)
        for (std::int64_t a = 0; a < coarse.cells; a += n) {
            // Lanes past the last coarse cell may have read the next fine row: they must stay empty.
            const auto inside = hn::FirstN(d, static_cast<std::size_t>(coarse.cells - a));
            const std::int64_t f = fine.index(2 * static_cast<int>(a), 2 * b, 2 * plane);
            const std::int64_t to = coarse.index(static_cast<int>(a), b, plane);
            auto put = [&](V value, float* out) HWY_ATTR { store(hn::IfThenElseZero(inside, value), out + to); };
            auto pair = [&](const float* p, std::int64_t other) HWY_ATTR { return hn::Add(load(p), load(p + other)); };

            const float *gx = fine.g[0].data() + f, *gy = fine.g[1].data() + f + y, *gz = fine.g[2].data() + f + z;
            put(odd(four(gx + n, y, z), four(gx, y, z)), coarse.g[0].data());
            const V y_low = pair(gy, z), y_high = pair(gy + n, z);
            put(hn::Add(even(y_high, y_low), odd(y_high, y_low)), coarse.g[1].data());
            const V z_low = pair(gz, y), z_high = pair(gz + n, y);
            put(hn::Add(even(z_high, z_low), odd(z_high, z_low)), coarse.g[2].data());
            const float* ground = fine.ground.data() + f;
            const V low = four(ground, y, z), high = four(ground + n, y, z);
            put(hn::Add(even(high, low), odd(high, low)), coarse.ground.data());
        }
}

double apply(Level& level, const float* p, std::int64_t begin, std::int64_t end) {
    const Rows rows(level);
    float* out = level.scratch.data();
    Sum sum;
    for (std::int64_t n = begin; n < end; ++n) {
        call_for(level, n, end, p + level.plane, rows.gx, rows.gy, rows.gz, rows.ground, out);
        const std::int64_t at = level.groups[static_cast<std::size_t>(n)].at;
        for (std::int64_t k = 0; k < kGroup; k += lanes()) {
            const std::int64_t i = at + k;
            const V product = rows.times(p, i);
            store(product, out + i);
            sum.add((n - begin) * kGroup + k, hn::Mul(load(p + i), product));
        }
    }
    return sum.total();
}

double dot(const Level& level, const float* a, const float* b, std::int64_t begin, std::int64_t end) {
    Sum sum;
    for (std::int64_t n = begin; n < end; ++n) {
        const std::int64_t at = level.groups[static_cast<std::size_t>(n)].at;
        for (std::int64_t k = 0; k < kGroup; k += lanes())
            sum.add((n - begin) * kGroup + k, hn::Mul(load(a + at + k), load(b + at + k)));
    }
    return sum.total();
}

/// The sums of a step, while it goes.
struct NormSums {
    Sum residual, weighted;
    HWY_INLINE void add(std::int64_t cell, V rest, V weight) {
        residual.add(cell, hn::Mul(rest, rest));
        weighted.add(cell, hn::Mul(rest, hn::Mul(weight, rest)));
    }
    HWY_INLINE Norms total() const { return {residual.total(), weighted.total()}; }
};

Norms start(Level& level, Krylov& krylov, float alpha, std::int64_t begin, std::int64_t end) {
    float *x = krylov.x.data(), *right = level.right.data();
    const float *ax = level.scratch.data(), *weight = level.weight.data();
    const V step = all(alpha);
    NormSums sums;
    for (std::int64_t n = begin; n < end; ++n) {
        call_for(level, n, end, x, right, ax, weight);
        const std::int64_t at = level.groups[static_cast<std::size_t>(n)].at;
        for (std::int64_t k = 0; k < kGroup; k += lanes()) {
            const std::int64_t i = at + k;
            const V w = load(weight + i);
            const V scaled = hn::IfThenElseZero(hn::Gt(w, all(0.0f)), hn::Mul(step, load(x + i)));
            const V rest = hn::Sub(load(right + i), hn::Mul(step, load(ax + i)));
            store(scaled, x + i);
            store(rest, right + i);
            sums.add((n - begin) * kGroup + k, rest, w);
        }
    }
    return sums.total();
}

Norms advance(Level& level, Krylov& krylov, float alpha, std::int64_t begin, std::int64_t end) {
    float *x = krylov.x.data(), *right = level.right.data();
    const float *p = krylov.p.data(), *ap = level.scratch.data(), *weight = level.weight.data();
    const V step = all(alpha);
    NormSums sums;
    for (std::int64_t n = begin; n < end; ++n) {
        call_for(level, n, end, x, right, p, ap, weight);
        const std::int64_t at = level.groups[static_cast<std::size_t>(n)].at;
        for (std::int64_t k = 0; k < kGroup; k += lanes()) {
            const std::int64_t i = at + k;
            const V moved = hn::Add(load(x + i), hn::Mul(step, load(p + i)));
            const V rest = hn::Sub(load(right + i), hn::Mul(step, load(ap + i)));
            store(moved, x + i);
            store(rest, right + i);
            sums.add((n - begin) * kGroup + k, rest, load(weight + i));
        }
    }
    return sums.total();
}

/// Every lane of the lower half of a vector from p on, twice.
HWY_INLINE V twice(const float* p) {
    alignas(64) static constexpr std::int32_t kHalves[16] = {0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 5, 5, 6, 6, 7, 7};
    const D d;
    return hn::TableLookupLanes(load(p), hn::SetTableIndices(d, kHalves));
}

void direction(const Level& level, Krylov& krylov, const float* coarse, float beta, std::int64_t begin,
               std::int64_t end) {
    const float *right = level.right.data(), *weight = level.weight.data();
    float* p = krylov.p.data();
    const V share = all(beta);
    for (std::int64_t n = begin; n < end; ++n) {
        call_for(level, n, end, p, right, weight);
        const Level::Group& group = level.groups[static_cast<std::size_t>(n)];
        for (std::int64_t k = 0; k < kGroup; k += lanes()) {
            const std::int64_t i = group.at + k;
            const V w = load(weight + i);
            const V own = hn::Mul(hn::Mul(all(kAdded), w), load(right + i));
            const V z = hn::Add(own, hn::Mul(all(kCorrection), twice(coarse + group.parent + k / 2)));
            const V next = hn::Add(z, hn::Mul(share, load(p + i)));
            store(hn::IfThenElseZero(hn::Gt(w, all(0.0f)), next), p + i);
        }
    }
}

void residual(Level& level, std::int64_t begin, std::int64_t end) {
    const Rows rows(level);
    const float *right = level.right.data(), *solution = level.solution.data();
    float* out = level.scratch.data();
    for (std::int64_t n = begin; n < end; ++n) {
        const std::int64_t at = level.groups[static_cast<std::size_t>(n)].at;
        for (std::int64_t i = at; i < at + kGroup; i += lanes())
            store(hn::Sub(load(right + i), rows.times(solution, i)), out + i);
    }
}

double smooth(Level& level, std::int64_t begin, std::int64_t end) {
    const Rows rows(level);
    const float *right = level.right.data(), *solution = level.solution.data(), *weight = level.weight.data();
    float* out = level.scratch.data();
    Sum sum;
    for (std::int64_t n = begin; n < end; ++n) {
        const std::int64_t at = level.groups[static_cast<std::size_t>(n)].at;
        for (std::int64_t k = 0; k < kGroup; k += lanes()) {
            const std::int64_t i = at + k;
            const V rest = hn::Sub(load(right + i), rows.times(solution, i));
            const V smoothed = hn::Add(load(solution + i), hn::Mul(load(weight + i), rest));
            store(smoothed, out + i);
            sum.add((n - begin) * kGroup + k, hn::Mul(load(right + i), smoothed));
        }
    }
    return sum.total();
}

void restrict_residual(const Level& fine, const float* values, Level& coarse, std::int64_t begin, std::int64_t end) {
    const std::int64_t width = lanes();
    float *right = coarse.right.data(), *solution = coarse.solution.data();
    for (std::int64_t n = begin; n < end; ++n) {
        const Level::Group& group = coarse.groups[static_cast<std::size_t>(n)];
        for (std::int64_t k = 0; k < kGroup; k += width) {
            const float* r = values + group.child + 2 * k;
            const V low = four(r, fine.row, fine.plane), high = four(r + width, fine.row, fine.plane);
            const std::int64_t i = group.at + k;
            const V weight = load(coarse.weight.data() + i);
            const V sum = hn::IfThenElseZero(hn::Gt(weight, all(0.0f)), hn::Add(even(high, low), odd(high, low)));
            store(sum, right + i);
            store(hn::Mul(weight, sum), solution + i);
        }
    }
}

void correct(Level& fine, const Level& coarse, std::int64_t begin, std::int64_t end) {
    float* z = fine.solution.data();
    for (std::int64_t n = begin; n < end; ++n) {
        const Level::Group& group = fine.groups[static_cast<std::size_t>(n)];
        for (std::int64_t k = 0; k < kGroup; k += lanes()) {
            const V parents = twice(coarse.solution.data() + group.parent + k / 2);
            float* to = z + group.at + k;
            store(hn::Add(load(to), hn::Mul(all(kCorrection), parents)), to);
        }
    }
}

void heat(const Level& level, const float* sigma, const float* phi, float factor, float* out, std::int64_t begin,
          std::int64_t end) {
    const Rows rows(level);
    const V half = all(0.5f * factor);
    for (std::int64_t n = begin; n < end; ++n) {
        call_for(level, n, end, sigma, phi + level.plane, rows.gx, rows.gy, rows.gz, out);
        const std::int64_t at = level.groups[static_cast<std::size_t>(n)].at;
        for (std::int64_t i = at; i < at + kGroup; i += lanes()) {
            const V conductivity = load(sigma + i), here = load(phi + i);
            auto square = [&](const float* g, std::int64_t face, std::int64_t there) HWY_ATTR {
                const V flow = hn::Mul(load(g + face), hn::Sub(here, load(phi + there)));
                return hn::Mul(flow, flow);
            };
            V sum = hn::Add(square(rows.gx, i, i + 1), square(rows.gx, i - 1, i - 1));
            sum = hn::Add(sum, hn::Add(square(rows.gy, i, i + rows.row), square(rows.gy, i - rows.row, i - rows.row)));
            sum = hn::Add(sum,
                          hn::Add(square(rows.gz, i, i + rows.plane), square(rows.gz, i - rows.plane, i - rows.plane)));
            const auto conducts = hn::Gt(conductivity, all(0.0f));
            store(hn::IfThenElseZero(conducts, hn::Div(hn::Mul(half, sum), conductivity)), out + i);
        }
    }
}

/// Bits [first, first + 16).
HWY_INLINE std::uint32_t sixteen_bits(const std::uint8_t* bits, std::int64_t first) {
    const std::uint8_t* at = bits + (first >> 3);
    const std::uint32_t three =
        at[0] | static_cast<std::uint32_t>(at[1]) << 8 | static_cast<std::uint32_t>(at[2]) << 16;
    return three >> (first & 7) & 0xffffu;
}

/// The lanes of a vector, from the k-th of sixteen bits on.
HWY_INLINE hn::Mask<D> lanes_of(std::uint32_t bits, std::int64_t k) {
    return simd::mask_of(D(), static_cast<std::uint16_t>(bits), static_cast<int>(k));
}

/// Which of 16 cells are of a material, as bits.
HWY_INLINE std::uint32_t places_of(const tissue::MaterialIndex* material, tissue::MaterialIndex wanted) {
    const hn::CappedTag<std::uint8_t, 16> d;
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < kGroup; k += hn::Lanes(d)) {
        std::uint8_t some[8] = {};
        hn::StoreMaskBits(d, hn::Eq(hn::LoadU(d, material + k), hn::Set(d, wanted)), some);
        std::uint16_t low;
        std::memcpy(&low, some, sizeof(low));
        bits |= static_cast<std::uint32_t>(low) << k;
    }
    return bits;
}

/// Adds those of 16 floats whose bits are set to 16 places.
HWY_INLINE void add_group(const float* values, std::uint32_t bits, HeatSums::Places& places) {
    const hn::CappedTag<double, 8> wide;
    const hn::Rebind<float, decltype(wide)> narrow;
    alignas(64) float wanted[kGroup];
    for (std::int64_t k = 0; k < kGroup; k += lanes())
        hn::Store(hn::IfThenElseZero(lanes_of(bits, k), load(values + k)), D(), wanted + k);
    for (std::size_t k = 0; k < kGroup; k += hn::Lanes(wide))
        hn::StoreU(hn::Add(hn::LoadU(wide, places.data() + k), hn::PromoteTo(wide, hn::Load(narrow, wanted + k))),
                   wide, places.data() + k);
}

void split(const Conductivity& tissue, const float* heat, const float* sigma, float scale, std::int64_t first,
           std::int64_t count, float* out, HeatSums& sums) {
    auto one = [&](std::int64_t k) {
        const std::int64_t hexel = first + k;
        const auto place = static_cast<std::size_t>(k % kGroup);
        const bool kept = (tissue.present[hexel >> 3] >> (hexel & 7)) & 1;
        out[k] = kept ? scale * heat[k] : 0.0f;
        if (!kept) {
            sums.rest[place] += static_cast<double>(heat[k]);
            return;
        }
        const tissue::MaterialIndex m = tissue.material[hexel];
        sums.kept[m][place] += static_cast<double>(heat[k]);
        sums.greatest[m] = std::max(sums.greatest[m], heat[k] * sigma[k]);
    };
    std::int64_t low = 0;
    for (; low + kGroup <= count; low += kGroup) {
        const tissue::MaterialIndex* material = tissue.material + first + low;
        const std::uint32_t kept = sixteen_bits(tissue.present, first + low);
        if (kept != 0xffff) add_group(heat + low, ~kept, sums.rest);
        const V factor = all(scale);
        for (std::int64_t k = 0; k < kGroup; k += lanes())
            store(hn::IfThenElseZero(lanes_of(kept, k), hn::Mul(factor, load(heat + low + k))), out + low + k);
        // Nearly always they are of one material.
        for (std::uint32_t left = kept; left != 0;) {
            const tissue::MaterialIndex m = material[hwy::Num0BitsBelowLS1Bit_Nonzero32(left)];
            const std::uint32_t alike = left & places_of(material, m);
            left &= ~alike;
            add_group(heat + low, alike, sums.kept[m]);
            V most = all(0.0f);
            for (std::int64_t k = 0; k < kGroup; k += lanes()) {
                const V density = hn::Mul(load(heat + low + k), load(sigma + low + k));
                most = hn::Max(most, hn::IfThenElseZero(lanes_of(alike, k), density));
            }
            if (!hn::AllFalse(D(), hn::Gt(most, all(sums.greatest[m]))))
                sums.greatest[m] = hn::GetLane(hn::MaxOfLanes(D(), most));
        }
    }
    for (; low < count; ++low) one(low);
}

}  // namespace HWY_NAMESPACE
}  // namespace calot::electric
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace calot::electric {

HWY_EXPORT(gather);
HWY_EXPORT(faces);
HWY_EXPORT(weights);
HWY_EXPORT(aggregate);
HWY_EXPORT(apply);
HWY_EXPORT(dot);
HWY_EXPORT(start);
HWY_EXPORT(advance);
HWY_EXPORT(direction);
HWY_EXPORT(residual);
HWY_EXPORT(smooth);
HWY_EXPORT(restrict_residual);
HWY_EXPORT(correct);
HWY_EXPORT(heat);
HWY_EXPORT(split);

Kernels wide_kernels() {
    // Decide on the target first: what is taken below are then the functions themselves.
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    return {HWY_DYNAMIC_DISPATCH(gather),    HWY_DYNAMIC_DISPATCH(faces),   HWY_DYNAMIC_DISPATCH(weights),
            HWY_DYNAMIC_DISPATCH(aggregate), HWY_DYNAMIC_DISPATCH(apply),   HWY_DYNAMIC_DISPATCH(dot),
            HWY_DYNAMIC_DISPATCH(start),     HWY_DYNAMIC_DISPATCH(advance), HWY_DYNAMIC_DISPATCH(direction),
            HWY_DYNAMIC_DISPATCH(residual),  HWY_DYNAMIC_DISPATCH(smooth),  HWY_DYNAMIC_DISPATCH(restrict_residual),
            HWY_DYNAMIC_DISPATCH(correct),   HWY_DYNAMIC_DISPATCH(heat),    HWY_DYNAMIC_DISPATCH(split)};
}

}  // namespace calot::electric
#endif

// The loops of kernels.h, a vector of neighbouring cells at a time. Neighbours are unaligned loads at constant offsets.

#include "calot/electric/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "calot/electric/kernels_simd.cpp"
#include <hwy/foreach_target.h>

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

/// Adds the products of a vector's lanes, in double, to as many places.
HWY_INLINE void add_products(V a, V b, double* place) {
#if HWY_TARGET == HWY_SCALAR
    *place += static_cast<double>(hn::GetLane(a)) * static_cast<double>(hn::GetLane(b));
#else
    const hn::Half<D> half;
    const hn::Rebind<double, decltype(half)> wide;
    const auto low = hn::Mul(hn::PromoteTo(wide, hn::LowerHalf(half, a)), hn::PromoteTo(wide, hn::LowerHalf(half, b)));
    const auto high = hn::Mul(hn::PromoteTo(wide, hn::UpperHalf(half, a)), hn::PromoteTo(wide, hn::UpperHalf(half, b)));
    double* high_place = place + hn::Lanes(wide);
    hn::Store(hn::Add(hn::Load(wide, place), low), wide, place);
    hn::Store(hn::Add(hn::Load(wide, high_place), high), wide, high_place);
#endif
}

/// Partial sums, whatever the width of a vector.
struct Sum {
    alignas(64) double place[kSums] = {};

    /// `cell` counts from the first cell of the range.
    HWY_INLINE void add(std::int64_t cell, V a, V b) { add_products(a, b, place + cell % kSums); }
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

void gather(const float* conductivity, const std::uint8_t* present, const std::uint8_t* held, std::int64_t first,
            std::int64_t count, float* out) {
    const D d;
    std::int64_t k = 0;
    for (; k + lanes() <= count; k += lanes()) {
        const auto conducts = hn::Or(simd::mask_at(d, present, first + k), simd::mask_at(d, held, first + k));
        store(hn::IfThenElseZero(conducts, load(conductivity + first + k)), out + k);
    }
    for (; k < count; ++k) {
        const std::int64_t hexel = first + k;
        out[k] = ((present[hexel >> 3] | held[hexel >> 3]) >> (hexel & 7)) & 1 ? conductivity[hexel] : 0.0f;
    }
}

void faces(Level& level, const float* sigma, std::int64_t begin, std::int64_t end) {
    float* const g[3] = {level.g[0].data(), level.g[1].data(), level.g[2].data()};
    const std::int64_t step[3] = {1, level.row, level.plane};
    for (std::int64_t i = level.first + begin * kGroup; i < level.first + end * kGroup; i += lanes()) {
        const V here = load(sigma + i);
        for (int axis = 0; axis < 3; ++axis) {
            const V there = load(sigma + i + step[axis]);
            const V twice = hn::Mul(hn::Mul(all(2.0f), here), there);
            store(hn::Div(twice, hn::Max(hn::Add(here, there), all(1e-30f))), g[axis] + i);
        }
    }
}

void weights(Level& level, std::int64_t begin, std::int64_t end) {
    const Rows rows(level);
    float* weight = level.weight.data();
    for (std::int64_t i = level.first + begin * kGroup; i < level.first + end * kGroup; i += lanes()) {
        V sum = hn::Add(load(rows.ground + i), hn::Add(load(rows.gx + i), load(rows.gx + i - 1)));
        sum = hn::Add(sum, hn::Add(load(rows.gy + i), load(rows.gy + i - rows.row)));
        sum = hn::Add(sum, hn::Add(load(rows.gz + i), load(rows.gz + i - rows.plane)));
        const auto unknown = hn::Gt(sum, all(0.0f));
        store(hn::IfThenElseZero(unknown, hn::Div(all(kDamping), sum)), weight + i);
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
        const std::int64_t at = level.groups[static_cast<std::size_t>(n)].at;
        for (std::int64_t k = 0; k < kGroup; k += lanes()) {
            const std::int64_t i = at + k;
            const V product = rows.times(p, i);
            store(product, out + i);
            sum.add((n - begin) * kGroup + k, load(p + i), product);
        }
    }
    return sum.total();
}

double start(Level& level, const float* x, std::int64_t begin, std::int64_t end) {
    const Rows rows(level);
    float *right = level.right.data(), *solution = level.solution.data();
    const float* weight = level.weight.data();
    Sum sum;
    for (std::int64_t n = begin; n < end; ++n) {
        const std::int64_t at = level.groups[static_cast<std::size_t>(n)].at;
        for (std::int64_t k = 0; k < kGroup; k += lanes()) {
            const std::int64_t i = at + k;
            const V rest = hn::Sub(load(right + i), rows.times(x, i));
            store(rest, right + i);
            store(hn::Mul(load(weight + i), rest), solution + i);
            sum.add((n - begin) * kGroup + k, rest, rest);
        }
    }
    return sum.total();
}

double advance(Level& level, Krylov& krylov, float alpha, std::int64_t begin, std::int64_t end) {
    float *x = krylov.x.data(), *right = level.right.data(), *solution = level.solution.data();
    const float *p = krylov.p.data(), *ap = level.scratch.data(), *weight = level.weight.data();
    const V step = all(alpha);
    Sum sum;
    for (std::int64_t n = begin; n < end; ++n) {
        const std::int64_t at = level.groups[static_cast<std::size_t>(n)].at;
        for (std::int64_t k = 0; k < kGroup; k += lanes()) {
            const std::int64_t i = at + k;
            store(hn::Add(load(x + i), hn::Mul(step, load(p + i))), x + i);
            const V rest = hn::Sub(load(right + i), hn::Mul(step, load(ap + i)));
            store(rest, right + i);
            store(hn::Mul(load(weight + i), rest), solution + i);
            sum.add((n - begin) * kGroup + k, rest, rest);
        }
    }
    return sum.total();
}

void direction(const Level& level, Krylov& krylov, float beta, std::int64_t begin, std::int64_t end) {
    const float* z = level.scratch.data();
    float* p = krylov.p.data();
    const V share = all(beta);
    for (std::int64_t n = begin; n < end; ++n) {
        const std::int64_t at = level.groups[static_cast<std::size_t>(n)].at;
        for (std::int64_t i = at; i < at + kGroup; i += lanes())
            store(hn::Add(load(z + i), hn::Mul(share, load(p + i))), p + i);
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
            sum.add((n - begin) * kGroup + k, load(right + i), smoothed);
        }
    }
    return sum.total();
}

void restrict_residual(const Level& fine, Level& coarse, std::int64_t begin, std::int64_t end) {
    const std::int64_t width = lanes();
    float *right = coarse.right.data(), *solution = coarse.solution.data();
    for (std::int64_t n = begin; n < end; ++n) {
        const Level::Group& group = coarse.groups[static_cast<std::size_t>(n)];
        for (std::int64_t k = 0; k < kGroup; k += width) {
            const float* r = fine.scratch.data() + group.child + 2 * k;
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
    alignas(64) static constexpr std::int32_t kHalves[16] = {0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 5, 5, 6, 6, 7, 7};
    const D d;
    const auto halves = hn::SetTableIndices(d, kHalves);
    float* z = fine.solution.data();
    for (std::int64_t n = begin; n < end; ++n) {
        const Level::Group& group = fine.groups[static_cast<std::size_t>(n)];
        for (std::int64_t k = 0; k < kGroup; k += lanes()) {
            const V parents = hn::TableLookupLanes(load(coarse.solution.data() + group.parent + k / 2), halves);
            float* to = z + group.at + k;
            store(hn::Add(load(to), hn::Mul(all(kCorrection), parents)), to);
        }
    }
}

void heat(const Level& level, const float* sigma, const float* phi, float* out, std::int64_t begin, std::int64_t end) {
    const Rows rows(level);
    for (std::int64_t i = level.first + begin * kGroup; i < level.first + end * kGroup; i += lanes()) {
        const V conductivity = load(sigma + i), here = load(phi + i);
        auto square = [&](const float* g, std::int64_t face, std::int64_t there) HWY_ATTR {
            const V flow = hn::Mul(load(g + face), hn::Sub(here, load(phi + there)));
            return hn::Mul(flow, flow);
        };
        V sum = hn::Add(square(rows.gx, i, i + 1), square(rows.gx, i - 1, i - 1));
        sum = hn::Add(sum, hn::Add(square(rows.gy, i, i + rows.row), square(rows.gy, i - rows.row, i - rows.row)));
        sum =
            hn::Add(sum, hn::Add(square(rows.gz, i, i + rows.plane), square(rows.gz, i - rows.plane, i - rows.plane)));
        const auto conducts = hn::Gt(conductivity, all(0.0f));
        store(hn::IfThenElseZero(conducts, hn::Div(hn::Mul(all(0.5f), sum), conductivity)), out + i);
    }
}

void split(float* heat, const std::uint8_t* present, std::int64_t first, std::int64_t count, HeatSums& sums) {
    const hn::CappedTag<double, 8> wide;
    const hn::Rebind<float, decltype(wide)> narrow;
    const auto width = static_cast<std::int64_t>(hn::Lanes(wide));
    std::int64_t k = 0;
    for (; k + width <= count; k += width) {
        const auto all_heat = hn::LoadU(narrow, heat + k);
        const auto mask = simd::mask_at(narrow, present, first + k);
        const auto kept = hn::IfThenElseZero(mask, all_heat), rest = hn::IfThenZeroElse(mask, all_heat);
        hn::StoreU(kept, narrow, heat + k);
        double *kept_sum = sums.kept + k % kGroup, *rest_sum = sums.rest + k % kGroup;
        hn::StoreU(hn::Add(hn::LoadU(wide, kept_sum), hn::PromoteTo(wide, kept)), wide, kept_sum);
        hn::StoreU(hn::Add(hn::LoadU(wide, rest_sum), hn::PromoteTo(wide, rest)), wide, rest_sum);
    }
    for (; k < count; ++k) {
        const std::int64_t hexel = first + k;
        const bool kept = (present[hexel >> 3] >> (hexel & 7)) & 1;
        double* place = kept ? sums.kept : sums.rest;
        place[k % kGroup] += static_cast<double>(heat[k]);
        if (!kept) heat[k] = 0.0f;
    }
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
    return {HWY_DYNAMIC_DISPATCH(gather),
            HWY_DYNAMIC_DISPATCH(faces),
            HWY_DYNAMIC_DISPATCH(weights),
            HWY_DYNAMIC_DISPATCH(aggregate),
            HWY_DYNAMIC_DISPATCH(apply),
            HWY_DYNAMIC_DISPATCH(start),
            HWY_DYNAMIC_DISPATCH(advance),
            HWY_DYNAMIC_DISPATCH(direction),
            HWY_DYNAMIC_DISPATCH(residual),
            HWY_DYNAMIC_DISPATCH(smooth),
            HWY_DYNAMIC_DISPATCH(restrict_residual),
            HWY_DYNAMIC_DISPATCH(correct),
            HWY_DYNAMIC_DISPATCH(heat),
            HWY_DYNAMIC_DISPATCH(split)};
}

}  // namespace calot::electric
#endif

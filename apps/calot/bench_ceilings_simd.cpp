// See bench_ceilings_simd.h.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "apps/calot/bench_ceilings_simd.cpp"
#include <hwy/foreach_target.h>

#include "apps/calot/bench_ceilings_simd.h"
#include "calot/base/simd.h"

HWY_BEFORE_NAMESPACE();
namespace calot::app {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using D = calot::HWY_NAMESPACE::simd::Floats;
using Lanes = hn::Vec<D>;

float read_floats(const float* from, std::int64_t floats) {
    const D d;
    const auto lanes = static_cast<std::int64_t>(hn::Lanes(d));
    Lanes a = hn::Zero(d), b = a, c = a, e = a, f = a, g = a, h = a, i = a;
    for (std::int64_t k = 0; k + 8 * lanes <= floats; k += 8 * lanes) {
        a = hn::Add(a, hn::LoadU(d, from + k));
        b = hn::Add(b, hn::LoadU(d, from + k + lanes));
        c = hn::Add(c, hn::LoadU(d, from + k + 2 * lanes));
        e = hn::Add(e, hn::LoadU(d, from + k + 3 * lanes));
        f = hn::Add(f, hn::LoadU(d, from + k + 4 * lanes));
        g = hn::Add(g, hn::LoadU(d, from + k + 5 * lanes));
        h = hn::Add(h, hn::LoadU(d, from + k + 6 * lanes));
        i = hn::Add(i, hn::LoadU(d, from + k + 7 * lanes));
    }
    const Lanes sum = hn::Add(hn::Add(hn::Add(a, b), hn::Add(c, e)), hn::Add(hn::Add(f, g), hn::Add(h, i)));
    return hn::GetLane(hn::SumOfLanes(d, sum));
}

void copy_floats(const float* from, float* to, std::int64_t floats) {
    const D d;
    const auto lanes = static_cast<std::int64_t>(hn::Lanes(d));
    for (std::int64_t k = 0; k + 4 * lanes <= floats; k += 4 * lanes) {
        const Lanes a = hn::LoadU(d, from + k), b = hn::LoadU(d, from + k + lanes),
                    c = hn::LoadU(d, from + k + 2 * lanes), e = hn::LoadU(d, from + k + 3 * lanes);
        hn::StoreU(a, d, to + k);
        hn::StoreU(b, d, to + k + lanes);
        hn::StoreU(c, d, to + k + 2 * lanes);
        hn::StoreU(e, d, to + k + 3 * lanes);
    }
}

constexpr int kChains = 10;  // enough to hide a latency of four to five cycles on two units

HWY_INLINE float sum_of(const Lanes (&chain)[kChains]) {
    const D d;
    Lanes sum = chain[0];
    for (int k = 1; k < kChains; ++k) sum = hn::Add(sum, chain[k]);
    return hn::GetLane(hn::SumOfLanes(d, sum));
}

/// Products and sums in chains of their own, as many of one as of the other: nothing waits for its neighbour.
std::int64_t separate(std::int64_t rounds, float* sink) {
    const D d;
    const Lanes factor = hn::Set(d, 1.000001f), term = hn::Set(d, 1e-6f);
    Lanes product[kChains], sum[kChains];
    for (int k = 0; k < kChains; ++k) product[k] = sum[k] = hn::Set(d, 1.0f);
    for (std::int64_t round = 0; round < rounds; ++round)
        for (int k = 0; k < kChains; ++k) {
            product[k] = hn::Mul(product[k], factor);
            sum[k] = hn::Add(sum[k], term);
        }
    *sink = sum_of(product) + sum_of(sum);
    return rounds * 2 * kChains * static_cast<std::int64_t>(hn::Lanes(d));
}

std::int64_t fused(std::int64_t rounds, float* sink) {
    const D d;
    const Lanes factor = hn::Set(d, 0.999f), term = hn::Set(d, 1e-3f);
    Lanes chain[kChains];
    for (int k = 0; k < kChains; ++k) chain[k] = hn::Set(d, 1.0f);
    for (std::int64_t round = 0; round < rounds; ++round)
        for (int k = 0; k < kChains; ++k) chain[k] = hn::MulAdd(chain[k], factor, term);
    *sink = sum_of(chain);
    return rounds * 2 * kChains * static_cast<std::int64_t>(hn::Lanes(d));
}

}  // namespace HWY_NAMESPACE
}  // namespace calot::app
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace calot::app {

HWY_EXPORT(read_floats);
HWY_EXPORT(copy_floats);
HWY_EXPORT(separate);
HWY_EXPORT(fused);

float read_all(const float* from, std::int64_t floats) {
    return HWY_DYNAMIC_DISPATCH(read_floats)(from, floats);
}
void copy_all(const float* from, float* to, std::int64_t floats) {
    HWY_DYNAMIC_DISPATCH(copy_floats)(from, to, floats);
}
std::int64_t multiply_and_add(std::int64_t rounds, float* sink) {
    return HWY_DYNAMIC_DISPATCH(separate)(rounds, sink);
}
std::int64_t multiply_add_fused(std::int64_t rounds, float* sink) {
    return HWY_DYNAMIC_DISPATCH(fused)(rounds, sink);
}

}  // namespace calot::app
#endif

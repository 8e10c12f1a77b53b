// Up to sixteen points or edges at a time; see vertex_batch.h and the reference in vertex_batch.cpp.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "calot/surface/vertex_batch_simd.cpp"
#include <hwy/foreach_target.h>

#include "calot/base/simd.h"
#include "calot/surface/vertex_batch.h"

HWY_BEFORE_NAMESPACE();
namespace calot::surface {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
namespace simd = calot::HWY_NAMESPACE::simd;

void evaluate_points(PointBatch& points) {
    const simd::Floats d;
    const auto half = hn::Set(d, 0.5f), least = hn::Set(d, kLeastValue),
               full = hn::Set(d, static_cast<float>(kFullFieldWeight));
    const auto per_full = hn::Set(d, 2.0f / static_cast<float>(kFullFieldWeight)), one = hn::Set(d, 1.0f);
    for (std::size_t k = 0; k < points.count; k += hn::Lanes(d)) {
        const auto weight = hn::Load(d, &points.weight[k]);
        const auto x = hn::Load(d, &points.mean[0][k]), y = hn::Load(d, &points.mean[1][k]),
                   z = hn::Load(d, &points.mean[2][k]);
        const auto present = hn::Gt(hn::Load(d, &points.present[k]), hn::Zero(d));
        const auto length = hn::Sqrt(hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), hn::Mul(z, z)));
        const auto share = hn::Sub(one, hn::Mul(per_full, weight));
        const auto off = hn::Div(length, hn::IfThenElse(present, weight, hn::Sub(full, weight)));
        const auto inside = hn::Min(hn::Min(share, hn::Sub(off, half)), hn::Neg(least));
        const auto outside = hn::Max(hn::Max(share, hn::Sub(half, off)), least);
        hn::Store(hn::IfThenElse(present, inside, outside), d, &points.value[k]);
    }
}

void evaluate_edges(EdgeBatch& edges) {
    const simd::Floats d;
    const auto zero = hn::Zero(d), one = hn::Set(d, 1.0f);
    for (std::size_t k = 0; k < edges.count; k += hn::Lanes(d)) {
        const auto a = hn::Load(d, &edges.lower_value[k]), b = hn::Load(d, &edges.upper_value[k]);
        const auto t = hn::Div(a, hn::Sub(a, b)), rest = hn::Sub(one, t);
        const auto outward = hn::IfThenElse(hn::Lt(a, zero), one, hn::Neg(one));
        auto blend = [&](std::size_t c) HWY_ATTR {
            return hn::Neg(hn::Add(hn::Mul(rest, hn::Load(d, &edges.lower_slope[c][k])),
                                   hn::Mul(t, hn::Load(d, &edges.upper_slope[c][k]))));
        };
        const auto along = hn::Mul(outward, hn::Max(hn::Mul(outward, blend(0)), zero));
        const auto y = blend(1), z = blend(2);
        const auto squares = hn::Add(hn::Add(hn::Mul(along, along), hn::Mul(y, y)), hn::Mul(z, z));
        const auto some = hn::Gt(squares, zero);
        const auto per_length = hn::IfThenElseZero(some, hn::Div(one, hn::Sqrt(squares)));
        hn::Store(t, d, &edges.share[k]);
        hn::Store(hn::IfThenElse(some, hn::Mul(along, per_length), outward), d, &edges.normal[0][k]);
        hn::Store(hn::Mul(y, per_length), d, &edges.normal[1][k]);
        hn::Store(hn::Mul(z, per_length), d, &edges.normal[2][k]);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace calot::surface
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace calot::surface {

HWY_EXPORT(evaluate_points);
HWY_EXPORT(evaluate_edges);

void evaluate(PointBatch& points) {
    // What runs past the end is worked out, too, and thrown away; it must be something.
    for (std::size_t k = points.count; k < points.count + kBatchPadding; ++k) {
        points.weight[k] = points.present[k] = 1.0f;
        for (auto& lane : points.mean) lane[k] = 0.0f;
    }
    HWY_DYNAMIC_DISPATCH(evaluate_points)(points);
}

void evaluate(EdgeBatch& edges) {
    for (std::size_t k = edges.count; k < edges.count + kBatchPadding; ++k) {
        edges.lower_value[k] = -1.0f;
        edges.upper_value[k] = 1.0f;
        for (std::size_t c = 0; c < 3; ++c) edges.lower_slope[c][k] = edges.upper_slope[c][k] = 0.0f;
    }
    HWY_DYNAMIC_DISPATCH(evaluate_edges)(edges);
}

}  // namespace calot::surface
#endif

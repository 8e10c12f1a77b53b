// psi a row at a time (contact_spread.h). Each share is a sum over carriers in their order, whatever the vector's
// width.

#include <array>

#include "calot/deformation/contact_spread.h"
#include "calot/deformation/links.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "calot/deformation/contact_spread_simd.cpp"
#include <hwy/foreach_target.h>

#include "calot/base/simd.h"

#ifndef CALOT_DEFORMATION_ROW_WEIGHTS
#define CALOT_DEFORMATION_ROW_WEIGHTS
namespace calot::deformation {

/// Link weights of three neighbours in a row of x, where the bits of a link word say that they live, at their places in
/// the row; other lanes are 0. The row beside the carrier has edges, faces, edges (1 f 1), the carrier's own two faces
/// (f . f), a diagonal one a single edge (. 1 .).
struct RowWeights {
    using Row = std::array<float, 8>;
    alignas(64) std::array<std::array<std::array<Row, 8>, 3>, 3> of{};  ///< [x of the first][|dy| + |dz|][bits]
    alignas(64) std::array<Row, 3> step{}, centre{};                    ///< [x of the first] -1, 0, 1; 1 at the carrier
};
inline constexpr RowWeights kRowWeights = [] {
    RowWeights weights;
    constexpr float kFace = static_cast<float>(kFaceWeight), kEdge = static_cast<float>(kEdgeWeight);
    constexpr float kWeight[3][3] = {{kFace, 0.0f, kFace}, {kEdge, kFace, kEdge}, {0.0f, kEdge, 0.0f}};
    for (std::size_t first = 0; first < 3; ++first) {
        for (std::size_t kind = 0; kind < 3; ++kind)
            for (std::size_t bits = 0; bits < 8; ++bits)
                for (std::size_t x = 0; x < 3; ++x)
                    weights.of[first][kind][bits][first + x] = (bits >> x) & 1u ? kWeight[kind][x] : 0.0f;
        for (std::size_t x = 0; x < 3; ++x) weights.step[first][first + x] = static_cast<float>(x) - 1.0f;
        weights.centre[first][first + 1] = 1.0f;
    }
    return weights;
}();

}  // namespace calot::deformation
#endif

HWY_BEFORE_NAMESPACE();
namespace calot::deformation {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, 8>;
constexpr std::size_t kLanes = hn::MaxLanes(D());

HWY_INLINE void add_carrier(const CarrierShare& carrier, float* share) {
    const D d;
    const std::size_t first = carrier.first;
    float* middle = share + carrier.at;
    alignas(32) float totals[8];
    for (std::size_t o = 0; o < 8; o += kLanes) {
        const auto along = hn::Mul(hn::Set(d, carrier.lever.x), hn::Load(d, kRowWeights.step[first].data() + o));
        auto total = hn::Zero(d);
        std::uint32_t links = carrier.links;
        for (int z = -1; z <= 1; ++z)
            for (int y = -1; y <= 1; ++y, links >>= 3) {
                const auto& weights = kRowWeights.of[first][static_cast<std::size_t>((y & 1) + (z & 1))][links & 7u];
                const float across = carrier.lever.y * static_cast<float>(y) + carrier.lever.z * static_cast<float>(z);
                const auto more = hn::Mul(hn::Load(d, weights.data() + o), hn::Add(hn::Set(d, across), along));
                total = hn::Add(total, more);
                float* row = middle + (8 * y + 40 * z) + o;
                hn::Store(hn::Add(hn::Load(d, row), more), d, row);
            }
        hn::Store(total, d, totals + o);
    }
    const float own = carrier.phi - ((totals[first] + totals[first + 1]) + totals[first + 2]);
    for (std::size_t o = 0; o < 8; o += kLanes)
        hn::Store(hn::Add(hn::Load(d, middle + o),
                          hn::Mul(hn::Set(d, own), hn::Load(d, kRowWeights.centre[first].data() + o))),
                  d, middle + o);
}

void add_all(const CarrierShare* carriers, std::size_t count, LocalShares& out) {
    const D d;
    for (std::size_t i = 0; i < out.share.size(); i += kLanes) hn::Store(hn::Zero(d), d, out.share.data() + i);
    for (std::size_t n = 0; n < count; ++n) add_carrier(carriers[n], out.share.data());
    out.there = {};
    for (std::size_t i = 0; i < out.share.size(); i += kLanes) {
        std::uint8_t bits[8] = {};
        hn::StoreMaskBits(d, hn::Ne(hn::Load(d, out.share.data() + i), hn::Zero(d)), bits);
        out.there[i / 64] |= std::uint64_t{bits[0]} << (i % 64);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace calot::deformation
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace calot::deformation {

HWY_EXPORT(add_all);

void add_carriers(const CarrierShare* carriers, std::size_t count, LocalShares& out) {
    HWY_DYNAMIC_DISPATCH(add_all)(carriers, count, out);
}

}  // namespace calot::deformation
#endif

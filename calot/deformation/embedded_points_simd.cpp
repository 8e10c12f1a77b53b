// Sixteen points at a time; see embedded_points.h.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "calot/deformation/embedded_points_simd.cpp"
#include <hwy/foreach_target.h>

#include "calot/base/simd.h"
#include "calot/deformation/embedded_points.h"

HWY_BEFORE_NAMESPACE();
namespace calot::deformation {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
namespace simd = calot::HWY_NAMESPACE::simd;

void move_blocks(const EmbeddedPoints::View& view, std::int64_t begin, std::int64_t end) {
    constexpr int kLanes = EmbeddedPoints::kLanes;
    const simd::Floats d;
    const auto lanes = static_cast<int>(hn::Lanes(d));
    for (std::int64_t b = begin; b < end; ++b) {
        const EmbeddedPoints::Block& block = view.blocks[b];
        const std::int32_t* phyxel = view.carrier_phyxel + block.first_carrier;
        const float* weights = view.weight + std::ptrdiff_t{kLanes} * block.first_carrier;
        alignas(64) float out[12][kLanes];
        for (int lane = 0; lane < block.points; lane += lanes) {
            // a and G, summed over the carriers. Products and sums are separate, so that every target rounds alike.
            auto s0 = hn::Zero(d), s1 = s0, s2 = s0, s3 = s0, s4 = s0, s5 = s0, s6 = s0, s7 = s0, s8 = s0, s9 = s0,
                 s10 = s0, s11 = s0;
            for (int n = 0; n < block.carriers; ++n) {
                const auto w = hn::Load(d, weights + kLanes * n + lane);
                const std::int32_t p = phyxel[n];
                s0 = hn::Add(s0, hn::Mul(w, hn::Set(d, view.field[0][p])));
                s1 = hn::Add(s1, hn::Mul(w, hn::Set(d, view.field[1][p])));
                s2 = hn::Add(s2, hn::Mul(w, hn::Set(d, view.field[2][p])));
                s3 = hn::Add(s3, hn::Mul(w, hn::Set(d, view.field[3][p])));
                s4 = hn::Add(s4, hn::Mul(w, hn::Set(d, view.field[4][p])));
                s5 = hn::Add(s5, hn::Mul(w, hn::Set(d, view.field[5][p])));
                s6 = hn::Add(s6, hn::Mul(w, hn::Set(d, view.field[6][p])));
                s7 = hn::Add(s7, hn::Mul(w, hn::Set(d, view.field[7][p])));
                s8 = hn::Add(s8, hn::Mul(w, hn::Set(d, view.field[8][p])));
                s9 = hn::Add(s9, hn::Mul(w, hn::Set(d, view.field[9][p])));
                s10 = hn::Add(s10, hn::Mul(w, hn::Set(d, view.field[10][p])));
                s11 = hn::Add(s11, hn::Mul(w, hn::Set(d, view.field[11][p])));
            }
            const auto x = hn::Load(d, block.rest_m[0].data() + lane), y = hn::Load(d, block.rest_m[1].data() + lane),
                       z = hn::Load(d, block.rest_m[2].data() + lane);
            auto place = [&](auto rest, auto a, auto gx, auto gy, auto gz) HWY_ATTR {
                const auto gr = hn::Add(hn::Add(hn::Mul(gx, x), hn::Mul(gy, y)), hn::Mul(gz, z));
                return hn::Add(rest, hn::Add(a, gr));
            };
            const auto one = hn::Set(d, 1.0f);
            hn::Store(place(x, s0, s3, s4, s5), d, out[0] + lane);
            hn::Store(place(y, s1, s6, s7, s8), d, out[1] + lane);
            hn::Store(place(z, s2, s9, s10, s11), d, out[2] + lane);
            hn::Store(hn::Add(s3, one), d, out[3] + lane);
            hn::Store(s4, d, out[4] + lane);
            hn::Store(s5, d, out[5] + lane);
            hn::Store(s6, d, out[6] + lane);
            hn::Store(hn::Add(s7, one), d, out[7] + lane);
            hn::Store(s8, d, out[8] + lane);
            hn::Store(s9, d, out[9] + lane);
            hn::Store(s10, d, out[10] + lane);
            hn::Store(hn::Add(s11, one), d, out[11] + lane);
        }
        for (int lane = 0; lane < block.points; ++lane)
            view.world_m[block.point[static_cast<std::size_t>(lane)]] = Vec3f(out[0][lane], out[1][lane], out[2][lane]);
        if (view.deformation_gradient == nullptr) continue;
        for (int k = 0; k < block.points; ++k)
            view.deformation_gradient[block.point[static_cast<std::size_t>(k)]] = Mat3f(
                out[3][k], out[6][k], out[9][k], out[4][k], out[7][k], out[10][k], out[5][k], out[8][k], out[11][k]);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace calot::deformation
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace calot::deformation {
HWY_EXPORT(move_blocks);
void move_blocks(const EmbeddedPoints::View& view, std::int64_t begin, std::int64_t end) {
    HWY_DYNAMIC_DISPATCH(move_blocks)(view, begin, end);
}
}  // namespace calot::deformation
#endif

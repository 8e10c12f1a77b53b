// The distance of a vector of phyxels to the capsules (near_kernel.h). Most are far from all of them: a box about the
// instruments says so first.

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

HWY_INLINE V dot(V x, V y, V z, const Vec3f& b) {
    const D d;
    return hn::Add(hn::Add(hn::Mul(x, hn::Set(d, b.x)), hn::Mul(y, hn::Set(d, b.y))), hn::Mul(z, hn::Set(d, b.z)));
}

HWY_INLINE std::uint32_t bits_of(hn::Mask<D> mask) {
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(D(), mask, bytes);
    return bytes[0] | static_cast<std::uint32_t>(bytes[1]) << 8;
}

/// Lanes at most `further_m` beyond a capsule's reach: |p - a - t ab|^2 <= (radius + reach)^2 at the nearest t in
/// [0, 1].
HWY_INLINE hn::Mask<D> within(const CapsuleF& capsule, V px, V py, V pz, float further_m) {
    const D d;
    const V x = hn::Sub(px, hn::Set(d, capsule.a.x)), y = hn::Sub(py, hn::Set(d, capsule.a.y)),
            z = hn::Sub(pz, hn::Set(d, capsule.a.z));
    V t = hn::Mul(dot(x, y, z, capsule.ab), hn::Set(d, capsule.inverse_length2));
    t = hn::Min(hn::Max(t, hn::Zero(d)), hn::Set(d, 1.0f));
    const V dx = hn::Sub(x, hn::Mul(t, hn::Set(d, capsule.ab.x))),
            dy = hn::Sub(y, hn::Mul(t, hn::Set(d, capsule.ab.y))),
            dz = hn::Sub(z, hn::Mul(t, hn::Set(d, capsule.ab.z)));
    const V squared = hn::Add(hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)), hn::Mul(dz, dz));
    const float most = capsule.radius + (capsule.reach + further_m);
    return hn::Le(squared, hn::Set(d, most * most));
}

void near_phyxels(const PlaceView& view, std::span<const Group> groups, const Capsules& capsules, float further_m,
                  const Vec3f& low, const Vec3f& high, std::uint16_t* near) {
    const D d;
    constexpr int kLanes = static_cast<int>(hn::MaxLanes(d));
    for (std::size_t g = 0; g < groups.size(); ++g) {
        std::uint32_t bits = 0;
        for (int lane = 0; lane < kGroupCells; lane += kLanes) {
            const std::int64_t i = groups[g].first + lane;
            const auto at = [&](std::size_t r) HWY_ATTR {
                return hn::Add(hn::LoadU(d, view.rest_m[r] + i), hn::LoadU(d, view.displacement_m[r] + i));
            };
            const V x = at(0), y = at(1), z = at(2);
            hn::Mask<D> inside = hn::And(hn::Ge(x, hn::Set(d, low.x)), hn::Le(x, hn::Set(d, high.x)));
            inside = hn::And(inside, hn::And(hn::Ge(y, hn::Set(d, low.y)), hn::Le(y, hn::Set(d, high.y))));
            inside = hn::And(inside, hn::And(hn::Ge(z, hn::Set(d, low.z)), hn::Le(z, hn::Set(d, high.z))));
            if (hn::AllFalse(d, inside)) continue;
            for (std::size_t k = 0; k < capsules.count; ++k)
                bits |= bits_of(within(capsules.item[k], x, y, z, further_m)) << lane;
        }
        near[g] = static_cast<std::uint16_t>(bits);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace calot::deformation
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace calot::deformation {

HWY_EXPORT(near_phyxels);

void find_near_phyxels(const PlaceView& view, std::span<const Group> groups, const Capsules& capsules, float further_m,
                       std::vector<std::uint16_t>& near) {
    Vec3f low(1e9f), high(-1e9f);
    for (std::size_t k = 0; k < capsules.count; ++k) {
        const CapsuleF& capsule = capsules.item[k];
        const Vec3f b = capsule.a + capsule.ab, most(capsule.radius + (capsule.reach + further_m));
        low = glm::min(low, glm::min(capsule.a, b) - most);
        high = glm::max(high, glm::max(capsule.a, b) + most);
    }
    near.resize(groups.size());
    HWY_DYNAMIC_DISPATCH(near_phyxels)(view, groups, capsules, further_m, low, high, near.data());
}

}  // namespace calot::deformation
#endif

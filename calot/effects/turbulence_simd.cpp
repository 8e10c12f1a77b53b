// Up to sixteen places at a time. Multiplication and addition stay separate, so that all instruction sets give the same
// bytes.

#include "calot/effects/turbulence.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "calot/effects/turbulence_simd.cpp"
#include <hwy/foreach_target.h>

#include "calot/base/simd.h"

HWY_BEFORE_NAMESPACE();
namespace calot::effects {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
namespace simd = calot::HWY_NAMESPACE::simd;

using D = simd::Floats;
using DU = hn::RebindToUnsigned<D>;
using DI = hn::RebindToSigned<D>;
using F = hn::Vec<D>;
using U = hn::Vec<DU>;

HWY_INLINE F number(float value) {
    return hn::Set(D(), value);
}
HWY_INLINE U whole(std::uint32_t value) {
    return hn::Set(DU(), value);
}

/// A number in [-1, 1) from random bits.
HWY_INLINE F spread(U bits) {
    const auto top = hn::ShiftRight<8>(hn::BitCast(DI(), bits));  // 24 of them, with sign: exact as floats
    return hn::Mul(hn::ConvertTo(D(), top), number(0x1p-23f));
}

/// The potential at lattice points: pcg3d (Jarzynski & Olano 2020), a hash of three integers to three.
HWY_INLINE void potential_at(U x, U y, U z, F& px, F& py, F& pz) {
    const U factor = whole(1664525), more = whole(1013904223);
    x = hn::Add(hn::Mul(x, factor), more);
    y = hn::Add(hn::Mul(y, factor), more);
    z = hn::Add(hn::Mul(z, factor), more);
    const auto mix = [&]() HWY_ATTR {
        x = hn::Add(x, hn::Mul(y, z));
        y = hn::Add(y, hn::Mul(z, x));
        z = hn::Add(z, hn::Mul(x, y));
    };
    mix();
    x = hn::Xor(x, hn::ShiftRight<16>(x));
    y = hn::Xor(y, hn::ShiftRight<16>(y));
    z = hn::Xor(z, hn::ShiftRight<16>(z));
    mix();
    px = spread(x);
    py = spread(y);
    pz = spread(z);
}

/// An axis of the cubes that places lie in: their low corner, and weights of both sides with their slopes.
struct Axis {
    U low;
    F weight[2], slope[2];
    HWY_INLINE explicit Axis(F place) {
        const F floor = hn::Floor(place), t = hn::Sub(place, floor);
        low = hn::BitCast(DU(), hn::ConvertTo(DI(), floor));
        // Quintic fade (Perlin 2002) and its slope: the potential has continuous second derivatives, the velocity is
        // smooth.
        const F inner = hn::Add(hn::Mul(t, hn::Sub(hn::Mul(t, number(6.0f)), number(15.0f))), number(10.0f));
        weight[1] = hn::Mul(hn::Mul(hn::Mul(t, t), t), inner);
        weight[0] = hn::Sub(number(1.0f), weight[1]);
        const F back = hn::Sub(t, number(1.0f));
        slope[1] = hn::Mul(number(30.0f), hn::Mul(hn::Mul(t, t), hn::Mul(back, back)));
        slope[0] = hn::Neg(slope[1]);
    }
};

void curl(SwirlBatch& batch) {
    const D d;
    for (std::size_t k = 0; k < batch.count; k += hn::Lanes(d)) {
        const Axis x(hn::Load(d, &batch.place[0][k])), y(hn::Load(d, &batch.place[1][k])),
            z(hn::Load(d, &batch.place[2][k]));
        F vx = number(0.0f), vy = vx, vz = vx;
        for (std::uint32_t corner = 0; corner < 8; ++corner) {
            const std::uint32_t a = corner & 1, b = corner >> 1 & 1, c = corner >> 2;
            F px, py, pz;
            potential_at(hn::Add(x.low, whole(a)), hn::Add(y.low, whole(b)), hn::Add(z.low, whole(c)), px, py, pz);
            const F along_x = hn::Mul(hn::Mul(x.slope[a], y.weight[b]), z.weight[c]);
            const F along_y = hn::Mul(hn::Mul(x.weight[a], y.slope[b]), z.weight[c]);
            const F along_z = hn::Mul(hn::Mul(x.weight[a], y.weight[b]), z.slope[c]);
            vx = hn::Add(vx, hn::Sub(hn::Mul(along_y, pz), hn::Mul(along_z, py)));
            vy = hn::Add(vy, hn::Sub(hn::Mul(along_z, px), hn::Mul(along_x, pz)));
            vz = hn::Add(vz, hn::Sub(hn::Mul(along_x, py), hn::Mul(along_y, px)));
        }
        hn::Store(vx, d, &batch.velocity[0][k]);
        hn::Store(vy, d, &batch.velocity[1][k]);
        hn::Store(vz, d, &batch.velocity[2][k]);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace calot::effects
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace calot::effects {

HWY_EXPORT(curl);

void curl_noise(SwirlBatch& batch) {
    HWY_DYNAMIC_DISPATCH(curl)(batch);
}

Vec3f curl_noise(const Vec3f& place) {
    SwirlBatch batch;
    batch.count = 1;
    for (int k = 0; k < 3; ++k) batch.place[static_cast<std::size_t>(k)][0] = place[k];
    curl_noise(batch);
    return {batch.velocity[0][0], batch.velocity[1][0], batch.velocity[2][0]};
}

}  // namespace calot::effects
#endif

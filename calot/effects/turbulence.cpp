#include "calot/effects/turbulence.h"

#include <cmath>

#include "calot/base/random.h"

namespace calot::effects {

namespace {

/// Three numbers in [-1, 1) that belong to a lattice point.
Vec3f potential_at(const Int3& point) {
    const auto x = static_cast<std::uint64_t>(static_cast<std::uint32_t>(point.x));
    const auto y = static_cast<std::uint64_t>(static_cast<std::uint32_t>(point.y));
    const auto z = static_cast<std::uint64_t>(static_cast<std::uint32_t>(point.z));
    const std::uint64_t bits = mix64(x * 0x9e3779b97f4a7c15ull + mix64(y << 32 | z));
    auto number = [&](int shift) {
        return static_cast<float>(static_cast<std::int32_t>((bits >> shift) & 0x1fffff) - 0x100000) * 0x1p-20f;
    };
    return {number(0), number(21), number(42)};
}

}  // namespace

Vec3f curl_noise(const Vec3f& place) {
    const Vec3f floor = glm::floor(place), t = place - floor;
    // Quintic fade (Perlin 2002) and its slope: the potential has continuous second derivatives, the velocity is
    // smooth.
    const Vec3f fade = t * t * t * (t * (t * 6.0f - 15.0f) + 10.0f);
    const Vec3f slope = 30.0f * t * t * (t * (t - 2.0f) + 1.0f);
    Mat3f gradient(0.0f);  // gradient[axis] = d potential / d axis
    for (int corner = 0; corner < 8; ++corner) {
        const Int3 step(corner & 1, corner >> 1 & 1, corner >> 2);
        const Vec3f potential = potential_at(Int3(floor) + step);
        Vec3f weight, change;
        for (int k = 0; k < 3; ++k) {
            weight[k] = step[k] ? fade[k] : 1.0f - fade[k];
            change[k] = step[k] ? slope[k] : -slope[k];
        }
        gradient[0] += change.x * weight.y * weight.z * potential;
        gradient[1] += weight.x * change.y * weight.z * potential;
        gradient[2] += weight.x * weight.y * change.z * potential;
    }
    return {gradient[1].z - gradient[2].y, gradient[2].x - gradient[0].z, gradient[0].y - gradient[1].x};
}

}  // namespace calot::effects

#include "calot/effects/turbulence.h"

#include <array>
#include <cmath>
#include <cstdint>

#include "calot/base/random.h"

namespace calot::effects {

namespace {

/// A number for each corner of a cube of the lattice, the first axis changing fastest.
using Corners = std::array<float, 8>;

/// Three numbers in [-1, 1) that belong to a lattice point, for each corner of the cube from `low` on.
std::array<Corners, 3> potentials(const Int3& low) {
    std::array<Corners, 3> potential;
    for (std::uint32_t corner = 0; corner < 8; ++corner) {
        const std::uint64_t x = static_cast<std::uint32_t>(low.x) + (corner & 1u),
                            y = static_cast<std::uint32_t>(low.y) + (corner >> 1 & 1u),
                            z = static_cast<std::uint32_t>(low.z) + (corner >> 2);
        const std::uint64_t bits = mix64((x & 0xffffffffu) * 0x9e3779b97f4a7c15ull + mix64(y << 32 | (z & 0xffffffffu)));
        for (std::size_t k = 0; k < 3; ++k)
            potential[k][corner] =
                static_cast<float>(static_cast<std::int32_t>((bits >> 21 * k) & 0x1fffff) - 0x100000) * 0x1p-20f;
    }
    return potential;
}

/// The product of a number for each side along each axis.
Corners products(const std::array<float, 2>& x, const std::array<float, 2>& y, const std::array<float, 2>& z) {
    Corners corners;
    for (std::size_t corner = 0; corner < 8; ++corner) corners[corner] = x[corner & 1] * y[corner >> 1 & 1] * z[corner >> 2];
    return corners;
}

/// a . b - c . d
float difference(const Corners& a, const Corners& b, const Corners& c, const Corners& d) {
    float sum = 0.0f;
    for (std::size_t corner = 0; corner < 8; ++corner) sum += a[corner] * b[corner] - c[corner] * d[corner];
    return sum;
}

}  // namespace

Vec3f curl_noise(const Vec3f& place) {
    // Quintic fade (Perlin 2002) and its slope: the potential has continuous second derivatives, the velocity is
    // smooth.
    Int3 low;
    std::array<std::array<float, 2>, 3> weight, change;
    for (int k = 0; k < 3; ++k) {
        const float floor = std::floor(place[k]), t = place[k] - floor;
        const float fade = t * t * t * (t * (t * 6.0f - 15.0f) + 10.0f), slope = 30.0f * t * t * (t * (t - 2.0f) + 1.0f);
        low[k] = static_cast<int>(floor);
        weight[static_cast<std::size_t>(k)] = {1.0f - fade, fade};
        change[static_cast<std::size_t>(k)] = {-slope, slope};
    }
    const std::array<Corners, 3> potential = potentials(low);
    // The potential's slopes along the axes are sums over the corners with these.
    const Corners along_x = products(change[0], weight[1], weight[2]), along_y = products(weight[0], change[1], weight[2]),
                  along_z = products(weight[0], weight[1], change[2]);
    return {difference(along_y, potential[2], along_z, potential[1]),
            difference(along_z, potential[0], along_x, potential[2]),
            difference(along_x, potential[1], along_y, potential[0])};
}

}  // namespace calot::effects

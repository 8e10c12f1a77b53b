#include "calot/anatomy/noise.h"

#include <algorithm>
#include <cmath>

namespace calot::anatomy {

namespace {

/// A 32-bit mix of lattice coordinates (constants of MurmurHash3's finaliser).
std::uint32_t hash_cell(int x, int y, int z, std::uint32_t seed) {
    std::uint32_t h = seed + static_cast<std::uint32_t>(x) * 0x8da6b343u + static_cast<std::uint32_t>(y) * 0xd8163841u +
                      static_cast<std::uint32_t>(z) * 0xcb1ab31fu;
    h ^= h >> 16;
    h *= 0x85ebca6bu;
    h ^= h >> 13;
    h *= 0xc2b2ae35u;
    return h ^ (h >> 16);
}

/// Dot product with one of the twelve directions to the edges of a cube (Perlin 2002).
double edge_gradient(std::uint32_t hash, double x, double y, double z) {
    const std::uint32_t h = hash & 15u;
    const double u = h < 8 ? x : y;
    const double v = h < 4 ? y : (h == 12 || h == 14 ? x : z);
    return ((h & 1u) ? -u : u) + ((h & 2u) ? -v : v);
}

double fade(double t) {
    return t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
}
double mix(double a, double b, double t) {
    return a + (b - a) * t;
}

}  // namespace

double gradient_noise(const Vec3& p, std::uint32_t seed) {
    const Vec3 cell = glm::floor(p);
    const Vec3 f = p - cell;
    const int x = static_cast<int>(cell.x), y = static_cast<int>(cell.y), z = static_cast<int>(cell.z);
    auto corner = [&](int i, int j, int k) {
        return edge_gradient(hash_cell(x + i, y + j, z + k, seed), f.x - i, f.y - j, f.z - k);
    };
    const double u = fade(f.x), v = fade(f.y), w = fade(f.z);
    const double near = mix(mix(corner(0, 0, 0), corner(1, 0, 0), u), mix(corner(0, 1, 0), corner(1, 1, 0), u), v);
    const double far = mix(mix(corner(0, 0, 1), corner(1, 0, 1), u), mix(corner(0, 1, 1), corner(1, 1, 1), u), v);
    return mix(near, far, w);
}

double lobule_noise(const Vec3& p, std::uint32_t seed) {
    constexpr double kJitter = 0.8;  // 1 = anywhere in the cell; less keeps lobules of similar size
    const Vec3 cell = glm::floor(p);
    const Vec3 f = p - cell;
    const int x = static_cast<int>(cell.x), y = static_cast<int>(cell.y), z = static_cast<int>(cell.z);
    double first = 1e9, second = 1e9;  // squares of the two smallest distances
    for (int k = -1; k <= 1; ++k)
        for (int j = -1; j <= 1; ++j)
            for (int i = -1; i <= 1; ++i) {
                const std::uint32_t h = hash_cell(x + i, y + j, z + k, seed);
                auto offset = [&](std::uint32_t bits) { return 0.5 + kJitter * (bits * (1.0 / 1024.0) - 0.5); };
                const double dx = i + offset(h & 1023u) - f.x;
                const double dy = j + offset((h >> 10) & 1023u) - f.y;
                const double dz = k + offset((h >> 20) & 1023u) - f.z;
                const double square = dx * dx + dy * dy + dz * dz;
                second = std::min(second, std::max(first, square));
                first = std::min(first, square);
            }
    constexpr double kCrease = 0.22;  // width of the rounding of creases, in squared distance
    const double h = std::max(kCrease - (second - first), 0.0) / kCrease;
    return std::clamp(1.0 - (first - 0.25 * kCrease * h * h), 0.0, 1.0);
}

}  // namespace calot::anatomy

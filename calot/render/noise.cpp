#include "calot/render/noise.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "calot/base/parallel.h"
#include "calot/base/random.h"
#include "calot/base/vec.h"

namespace calot::render {

namespace {

constexpr int kCoarseCells = 6;
constexpr int kFineCells = 15;

int wrap(int value, int period) {
    return ((value % period) + period) % period;
}

std::uint64_t hash_cell(int x, int y, int z, int period, std::uint64_t seed) {
    const auto cell =
        static_cast<std::uint64_t>((wrap(z, period) * period + wrap(y, period)) * period + wrap(x, period));
    return mix64(seed * 0x9e37u + cell);
}

float unit(std::uint64_t bits, int part) {
    return static_cast<float>((bits >> (21 * part)) & 0x1fffff) * (1.0f / 0x1fffff);
}

float fade(float t) {
    return t * t * t * (t * (6.0f * t - 15.0f) + 10.0f);
}

/// Perlin's gradient noise (2002) of a given period, in about [-0.7, 0.7]. `at` in tiles.
float gradient_noise(const Vec3f& at, int period, std::uint64_t seed) {
    const Vec3f p = at * static_cast<float>(period);
    const Vec3f base = glm::floor(p);
    const Vec3f f = p - base;
    const Int3 cell(base);
    const Vec3f w(fade(f.x), fade(f.y), fade(f.z));
    float corner[8];
    for (int k = 0; k < 8; ++k) {
        const Int3 d(k & 1, (k >> 1) & 1, k >> 2);
        const std::uint64_t bits = hash_cell(cell.x + d.x, cell.y + d.y, cell.z + d.z, period, seed);
        const Vec3f gradient(2.0f * unit(bits, 0) - 1.0f, 2.0f * unit(bits, 1) - 1.0f, 2.0f * unit(bits, 2) - 1.0f);
        corner[k] = glm::dot(gradient, f - Vec3f(d));
    }
    auto mix = [](float a, float b, float t) { return a + (b - a) * t; };
    const float y0 = mix(mix(corner[0], corner[1], w.x), mix(corner[2], corner[3], w.x), w.y);
    const float y1 = mix(mix(corner[4], corner[5], w.x), mix(corner[6], corner[7], w.x), w.y);
    return mix(y0, y1, w.z);
}

float fractal_noise(const Vec3f& at, int period, int octaves, std::uint64_t seed) {
    float sum = 0.0f, amplitude = 1.0f;
    for (int k = 0; k < octaves; ++k) {
        sum += amplitude * gradient_noise(at, period << k, seed + static_cast<std::uint64_t>(k));
        amplitude *= 0.5f;
    }
    return sum;
}

/// Distance to the bisecting plane between the two nearest of a jittered lattice of seeds, in cells.
float cell_border(const Vec3f& at, int period, std::uint64_t seed) {
    const Vec3f p = at * static_cast<float>(period);
    const Int3 cell(glm::floor(p));
    float first = 1e9f, second = 1e9f;
    Vec3f first_at(0.0f), second_at(0.0f);
    for (int z = -1; z <= 1; ++z)
        for (int y = -1; y <= 1; ++y)
            for (int x = -1; x <= 1; ++x) {
                const std::uint64_t bits = hash_cell(cell.x + x, cell.y + y, cell.z + z, period, seed);
                const Vec3f seed_at =
                    Vec3f(cell + Int3(x, y, z)) + 0.1f + 0.8f * Vec3f(unit(bits, 0), unit(bits, 1), unit(bits, 2));
                const float d2 = glm::dot(seed_at - p, seed_at - p);
                if (d2 < first) {
                    second = first;
                    second_at = first_at;
                    first = d2;
                    first_at = seed_at;
                } else if (d2 < second) {
                    second = d2;
                    second_at = seed_at;
                }
            }
    return 0.5f * (second - first) / std::max(1e-3f, glm::length(second_at - first_at));
}

std::uint8_t byte(float value) {
    return static_cast<std::uint8_t>(std::lround(255.0f * std::clamp(value, 0.0f, 1.0f)));
}

/// RGB = gradient of `height` / slope about 0.5, A = `last`.
std::vector<std::uint8_t> with_gradient(const std::vector<float>& height, float slope, const std::vector<float>& last) {
    const int n = kNoiseSize;
    std::vector<std::uint8_t> texels(4 * height.size());
    auto place = [&](int x, int y, int z) {
        return static_cast<std::size_t>((wrap(z, n) * n + wrap(y, n)) * n + wrap(x, n));
    };
    auto at = [&](int x, int y, int z) { return height[place(x, y, z)]; };
    parallel_for("render.noise", 0, n, 8, [&](std::int64_t low, std::int64_t high) {
        for (int z = static_cast<int>(low); z < high; ++z)
            for (int y = 0; y < n; ++y)
                for (int x = 0; x < n; ++x) {
                    const Vec3f gradient = 0.5f * static_cast<float>(n) *
                                           Vec3f(at(x + 1, y, z) - at(x - 1, y, z), at(x, y + 1, z) - at(x, y - 1, z),
                                                 at(x, y, z + 1) - at(x, y, z - 1));
                    std::uint8_t* texel = &texels[4 * place(x, y, z)];
                    for (int axis = 0; axis < 3; ++axis) texel[axis] = byte(0.5f + 0.5f * gradient[axis] / slope);
                    texel[3] = byte(last[place(x, y, z)]);
                }
    });
    return texels;
}

}  // namespace

NoiseTextures make_noise() {
    const int n = kNoiseSize;
    const std::size_t count = static_cast<std::size_t>(n) * n * n;
    NoiseTextures textures;
    textures.smooth.resize(4 * count);
    std::vector<float> pillow(count), border(count), bump(count), fine_border(count);
    parallel_for("render.noise", 0, n, 4, [&](std::int64_t low, std::int64_t high) {
        for (std::int64_t z = low; z < high; ++z)
            for (int y = 0; y < n; ++y)
                for (int x = 0; x < n; ++x) {
                    const std::size_t texel = static_cast<std::size_t>((z * n + y) * n + x);
                    const Vec3f at =
                        (Vec3f(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)) + 0.5f) /
                        static_cast<float>(n);
                    const float coarse = cell_border(at, kCoarseCells, 11);
                    border[texel] = 2.0f * coarse;
                    const float inward = std::min(1.0f, coarse / kPillowWidth);
                    pillow[texel] = 1.0f - (1.0f - inward) * (1.0f - inward);
                    fine_border[texel] = 2.0f * cell_border(at, kFineCells, 12);
                    bump[texel] = 0.5f * fractal_noise(at, 8, 3, 51);
                    std::uint8_t* smooth = &textures.smooth[4 * texel];
                    smooth[0] = byte(0.5f + 0.6f * fractal_noise(at, 4, 4, 21));
                    smooth[1] = byte(0.5f + 0.7f * gradient_noise(at, 5, 31));
                    smooth[2] = byte(0.5f + 0.7f * gradient_noise(at, 5, 32));
                    smooth[3] = byte(0.5f + 0.6f * fractal_noise(at, 16, 2, 41));
                }
    });
    textures.lobules = with_gradient(pillow, kPillowSlope, border);
    textures.bump = with_gradient(bump, kBumpSlope, fine_border);
    return textures;
}

}  // namespace calot::render

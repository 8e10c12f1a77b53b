#pragma once

#include <cstdint>
#include <functional>

#include "calot/render/renderer.h"
#include "render/demo_scene.h"

namespace calot::render::test {

inline Vec3 pixel(const Image& image, int x, int y) {
    const auto at =
        3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x));
    return Vec3(image.rgb[at], image.rgb[at + 1], image.rgb[at + 2]) / 255.0;
}

inline double luma(const Vec3& colour) {
    return 0.30 * colour.r + 0.59 * colour.g + 0.11 * colour.b;
}

/// Mean colour of the square of 2 half + 1 pixels about a pixel.
inline Vec3 mean_about(const Image& image, int x, int y, int half) {
    Vec3 sum(0.0);
    for (int dy = -half; dy <= half; ++dy)
        for (int dx = -half; dx <= half; ++dx) sum += pixel(image, x + dx, y + dy);
    return sum / static_cast<double>((2 * half + 1) * (2 * half + 1));
}

/// Mean over the pixels for which `wanted` holds.
inline Vec3 mean_where(const Image& image, const std::function<bool(int, int)>& wanted) {
    Vec3 sum(0.0);
    double count = 0.0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            if (wanted(x, y)) {
                sum += pixel(image, x, y);
                count += 1.0;
            }
    return count > 0.0 ? sum / count : sum;
}

/// Largest difference of a channel, 0 to 255, between equal sizes.
inline int largest_difference(const Image& a, const Image& b) {
    int most = 0;
    for (std::size_t k = 0; k < a.rgb.size(); ++k) most = std::max(most, std::abs(a.rgb[k] - b.rgb[k]));
    return most;
}

/// The size that tests draw at: enough to see, quick without a GPU.
inline constexpr int kWidth = 320;
inline constexpr int kHeight = 180;

inline Image picture(Renderer& renderer, const View& view) {
    renderer.draw(view);
    return renderer.read();
}

inline effects::SmokeParticle puff(const Vec3f& position_m, float radius_m, float steam_kg, float smoke_kg,
                                   std::uint32_t seed = 1) {
    effects::SmokeParticle particle;
    particle.position_m = position_m;
    particle.velocity_m_per_s = Vec3f(0.0f, 0.01f, 0.0f);
    particle.radius_m = radius_m;
    particle.steam = steam_kg;
    particle.smoke = smoke_kg;
    particle.age_s = 0.4f;
    particle.seed = seed;
    return particle;
}

/// A flat sheet of one look facing the camera at 60 mm: what a colour test looks at.
inline View sheet(const float (&weights)[4], float peak_K = 310.15f, float exposure = 0.0f) {
    View view;
    constexpr int kCells = 24;
    constexpr float kHalf_m = 0.05f;
    for (int y = 0; y <= kCells; ++y)
        for (int x = 0; x <= kCells; ++x) {
            TissueVertex vertex{};
            vertex.world_m = Vec3f(kHalf_m * (2.0f * static_cast<float>(x) / kCells - 1.0f),
                                   kHalf_m * (2.0f * static_cast<float>(y) / kCells - 1.0f), 0.0f);
            vertex.rest_m = vertex.world_m;
            vertex.normal = Vec3f(0.0f, 0.0f, 1.0f);
            vertex.temperature_K = 310.15f;
            vertex.peak_temperature_K = peak_K;
            vertex.exposure = exposure;
            for (int k = 0; k < 4; ++k) vertex.look_weights[k] = weights[k];
            view.tissue.push_back(vertex);
        }
    for (std::uint32_t y = 0; y < kCells; ++y)
        for (std::uint32_t x = 0; x < kCells; ++x) {
            const std::uint32_t a = y * (kCells + 1) + x, b = a + 1, c = a + kCells + 1, d = c + 1;
            view.tissue_index.insert(view.tissue_index.end(), {a, b, c, b, d, c});
        }
    view.camera.eye_m = Vec3(0.0, 0.0, 0.06);
    view.camera.target_m = Vec3(0.0);
    return view;
}

inline constexpr float kFatOnly[4] = {1, 0, 0, 0};
inline constexpr float kDuctOnly[4] = {0, 1, 0, 0};
inline constexpr float kArteryOnly[4] = {0, 0, 1, 0};
inline constexpr float kGallbladderOnly[4] = {0, 0, 0, 1};

/// Mean colour of the middle half of the picture.
inline Vec3 middle(const Image& image) {
    return mean_where(image, [&](int x, int y) {
        return std::abs(x - image.width / 2) < image.height / 4 && std::abs(y - image.height / 2) < image.height / 4;
    });
}

}  // namespace calot::render::test

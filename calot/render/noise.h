#pragma once
// Tileable 3D textures made at start, so that shaders look noise up instead of computing it. All are kNoiseSize^3
// RGBA8, addressed by rest position, which is why texture sticks to tissue and needs no coordinates of its own.

#include <cstdint>
#include <vector>

namespace calot::render {

inline constexpr int kNoiseSize = 64;

struct NoiseTextures {
    /// Worley cells, 6 across (lobules): R distance to the nearest seed, G to the border between cells (0 there), B the
    /// cell's own random number; A distance to the border of finer cells, 15 across (froth, cracks).
    std::vector<std::uint8_t> cells;
    /// Pillows over the coarse cells: RGB gradient of their height (0.5 = flat, kPillowSlope = 1), A height.
    std::vector<std::uint8_t> pillow;
    /// R fractal noise (4 octaves from 4 across), G and B smooth noise (5 across) whose level lines make vessels, A
    /// fine fractal noise (from 16 across).
    std::vector<std::uint8_t> smooth;
    /// Gradient (RGB, 0.5 = flat, kBumpSlope = 1) and height (A) of fractal bumps from 8 across.
    std::vector<std::uint8_t> bump;
};

inline constexpr float kPillowSlope = 30.0f;  ///< height per tile that a full channel means
inline constexpr float kBumpSlope = 24.0f;

/// The same bytes on every machine.
NoiseTextures make_noise();

}  // namespace calot::render

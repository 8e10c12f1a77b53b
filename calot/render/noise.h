#pragma once
// Tileable 3D textures made at start, so that shaders look noise up instead of computing it. All are kNoiseSize^3
// RGBA8, addressed by rest position, which is why texture sticks to tissue and needs no coordinates of its own.

#include <cstdint>
#include <vector>

namespace calot::render {

inline constexpr int kNoiseSize = 64;

struct NoiseTextures {
    /// Lobules, 6 Worley cells across: RGB gradient of pillows over them (0.5 = flat, 0 and 1 = kPillowSlope), A
    /// distance to the border between cells (0 there, 1 half a cell away).
    std::vector<std::uint8_t> lobules;
    /// R fractal noise (4 octaves from 4 across), G and B smooth noise (5 across) whose level lines make vessels, A
    /// fine fractal noise (from 16 across).
    std::vector<std::uint8_t> smooth;
    /// Bumps: RGB gradient of fractal noise from 8 across (0 and 1 = kBumpSlope), A distance to the border of finer
    /// cells, 15 across (froth, cracks).
    std::vector<std::uint8_t> bump;
};

inline constexpr float kPillowSlope = 30.0f;  ///< height per tile that a full channel means
inline constexpr float kBumpSlope = 24.0f;
inline constexpr float kPillowWidth = 0.42f;  ///< from a border to where a pillow is flat, in cells

/// The same bytes on every machine.
NoiseTextures make_noise();

}  // namespace calot::render

#pragma once
// What all shaders know of a picture: camera, lights, spark, the instrument's capsules.

#include <array>
#include <cstdint>

#include "calot/render/view.h"

namespace calot::render {

/// Capsules of an instrument that cast shadows, the first ones: foot, two parts of the heel, shaft. A constant, so that
/// shaders unroll the loop over them; llvmpipe takes four times as long otherwise.
inline constexpr int kMaxCapsules = 4;
inline constexpr double kNear_m = 0.004;
inline constexpr double kFar_m = 0.6;
inline constexpr double kRoundOverHeight = 1.26;  ///< diameter of the round image over the picture's height
inline constexpr double kBarrel = 0.10;           ///< how much more the middle is magnified than the edge

/// Uniform block "Frame" (std140), see shaders_common.cpp.
struct FrameUniforms {
    glm::mat4 view_projection;
    glm::mat4 view;
    glm::vec4 eye;
    glm::vec4 axis;
    std::array<glm::vec4, 2> light;
    glm::vec4 spark;
    glm::vec4 projection;
    glm::vec4 round;
    glm::vec4 pixels;
    std::array<glm::vec4, kMaxCapsules> capsule_a;
    std::array<glm::vec4, kMaxCapsules> capsule_b;
    glm::vec4 lens;
    glm::ivec4 counts;
};
static_assert(sizeof(FrameUniforms) == 4 * (32 + 4 * 10 + 8 * kMaxCapsules));

/// A pure function of the view and the size of the scene's target.
FrameUniforms make_frame(const View& view, int width, int height);

}  // namespace calot::render

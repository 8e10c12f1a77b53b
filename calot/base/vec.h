#pragma once
// Small vectors and matrices: GLM's, under the project's names. Matrices are column-major: m[column][row].

#include <cstdint>

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

namespace calot {

using Vec3 = glm::dvec3;   ///< geometry and set-up, double
using Vec3f = glm::vec3;   ///< state and kernels, single
using Mat3 = glm::dmat3;
using Mat3f = glm::mat3;
using Quat = glm::dquat;
using Int3 = glm::ivec3;   ///< lattice coordinates

/// An axis-aligned box.
struct Box {
    Vec3 low{0.0};
    Vec3 high{0.0};
};

}  // namespace calot

#pragma once
// Noise for surfaces of tissue: pure functions of position and seed, the same on every machine (sums, products, floor
// only).

#include <cstdint>

#include "calot/base/vec.h"

namespace calot::anatomy {

/// Gradient noise (Perlin 2002, quintic fade) on a unit lattice: smooth, within [-1, 1], mean 0.
double gradient_noise(const Vec3& p, std::uint32_t seed);

/// Slope that gradient_noise never exceeds (measured maximum 3.41 over 4 million points).
inline constexpr double kGradientNoiseSlope = 3.6;

/// Domes, one per cell of the unit lattice about a jittered centre, meeting in creases as lobules of fat do: 1 on top
/// of a dome, 0 in the deepest creases. Cellular noise (Worley 1996): 1 - F1^2 with creases rounded by F2.
double lobule_noise(const Vec3& p, std::uint32_t seed);

/// Slope that lobule_noise never exceeds (measured maximum 2.02 over 4 million points).
inline constexpr double kLobuleNoiseSlope = 2.2;

}  // namespace calot::anatomy

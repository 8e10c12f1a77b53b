#pragma once
// A swirling velocity field without sources, the same on every machine and at every call.

#include <array>
#include <cstddef>

#include "calot/base/vec.h"

namespace calot::effects {

/// Some places, x y z, and the field there.
struct SwirlBatch {
    static constexpr std::size_t kPlaces = 64;
    alignas(64) std::array<std::array<float, kPlaces>, 3> place{};  ///< lanes beyond `count` are read
    alignas(64) std::array<std::array<float, kPlaces>, 3> velocity{};
    std::size_t count = 0;
};

/// Curl of a smooth random vector potential (Bridson, Hourihan & Nordenstam 2007): divergence-free. About unit size,
/// varies over about one unit of `place`.
void curl_noise(SwirlBatch& batch);
Vec3f curl_noise(const Vec3f& place);

}  // namespace calot::effects

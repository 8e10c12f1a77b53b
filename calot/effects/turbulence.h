#pragma once
// A swirling velocity field without sources, the same on every machine and at every call.

#include "calot/base/vec.h"

namespace calot::effects {

/// Curl of a smooth random vector potential (Bridson, Hourihan & Nordenstam 2007): divergence-free. About unit size,
/// varies over about one unit of `place`.
Vec3f curl_noise(const Vec3f& place);

}  // namespace calot::effects

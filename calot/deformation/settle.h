#pragma once
// Tissue that has come to rest is at rest.
//
// Damped motion never ends: it halves, and halves again, until displacements and velocities are subnormal numbers, with
// which processors calculate more than ten times as slowly. What is far below anything that moves is zero.

#include "calot/tissue/state.h"

namespace calot::deformation {

inline constexpr float kStill_m = 1e-15f, kStill_m_per_s = 1e-12f;

/// Before advance(), which works out from the displacements all that depends on them.
void settle(tissue::State& state);

}  // namespace calot::deformation

#include "calot/deformation/settle.h"

#include <cmath>

namespace calot::deformation {

namespace {

void settle(Array<float>& values, float least) {
    for (float& value : values) value = std::fabs(value) < least ? 0.0f : value;
}

}  // namespace

void settle(tissue::State& state) {
    for (Array<float>& u : state.displacement_m) settle(u, kStill_m);
    for (Array<float>& v : state.velocity_m_per_s) settle(v, kStill_m_per_s);
}

}  // namespace calot::deformation

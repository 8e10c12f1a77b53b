#pragma once
// How well each hexel conducts (docs/physics.md section 5).

#include "calot/base/array.h"
#include "calot/electric/kernels.h"
#include "calot/tissue/state.h"

namespace calot::electric {

/// [hexels.cells] at body temperature: tissue by its material; cells inside organs that hold tissue by the organ's, so
/// that current leaves the tissue through them; elsewhere 0.
Array<float> conductivity_at_rest_S_per_m(const tissue::Model& model);

/// What depends on materials alone.
Conductivity conductivity_of_materials(const tissue::Model& model);

/// Points to the present tissue.
void look_at(const tissue::Model& model, const tissue::State& state, const Array<float>& rest_S_per_m,
             Conductivity& conductivity);

}  // namespace calot::electric

#pragma once
// Electric conductivity of tissue: the one place that says how well a hexel conducts.

#include "calot/base/array.h"
#include "calot/tissue/model.h"

namespace calot::electric {

/// Conductivity of what fills each hexel's cell at body temperature [S/m], [hexels.cells]: the tissue's, or inside
/// organs that hold tissue (Model::hexel_held) the organ's. 0 = gas. A hexel conducts while State::hexel_present has
/// it; held cells always do, so that current leaves the tissue through the organs it grows on.
Array<float> conductivity_at_rest_S_per_m(const tissue::Model& model);

}  // namespace calot::electric

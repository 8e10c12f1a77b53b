#pragma once
// Triangle mesh of any anatomy::Shape inside a box, for drawing rigid organs.

#include "calot/anatomy/shape.h"
#include "calot/surface/mesh.h"

namespace calot::surface {

/// Marching cubes on a grid of `spacing_m`; vertices moved onto the surface by linear interpolation, normals from the
/// distance's gradient. The mesh is clipped (left open) at `box`.
Mesh mesh_of_shape(const anatomy::Shape& shape, const Box& box, double spacing_m);

}  // namespace calot::surface

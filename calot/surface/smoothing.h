#pragma once
// A smoother look for drawing: the vertices of a closed mesh drift towards the middle of their neighbours and part of
// the way back (as Taubin 1995, so that the body hardly shrinks), never further than a bound. Triangles stay as they
// are. The defaults were chosen by eye on burnt lobules, close up: two passes take away what is left of the lattice,
// more begin to round off what was cut.

#include "calot/base/array.h"
#include "calot/surface/mesh.h"

namespace calot::surface {

struct SmoothingParameters {
    int position_passes = 2;
    int normal_passes = 4;
    float inward = 0.6f;   ///< share of the way to the neighbours' middle
    float outward = 0.3f;  ///< and back
    float bound = 0.5f;    ///< a vertex moves at most so many spacings along each axis
};

/// Scratch, kept between calls.
struct SmoothingWork {
    Array<glm::vec4> value, sum;  ///< per vertex
};

/// `result` may not be `mesh`. Every line of the mesh must belong to two triangles, in opposite directions.
void smooth(const Mesh& mesh, float spacing_m, const SmoothingParameters& parameters, Mesh& result,
            SmoothingWork& work);

}  // namespace calot::surface

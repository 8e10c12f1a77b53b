#pragma once
// A smoother look for drawing: the vertices of a closed mesh drift towards the middle of their neighbours and back
// (Taubin 1995, so that the body does not shrink), never further than a bound. Triangles stay as they are.

#include "calot/surface/mesh.h"

namespace calot::surface {

struct SmoothingParameters {
    int position_passes = 2;
    int normal_passes = 2;
    float inward = 0.5f;    ///< share of the way to the neighbours' middle
    float outward = 0.53f;  ///< and back
    float bound = 0.5f;     ///< a vertex moves at most so many spacings along each axis
};

/// Scratch, kept between calls.
struct SmoothingWork {
    std::vector<Vec3f> sum;
    std::vector<float> share;  ///< 1 / number of neighbours
};

/// `result` may not be `mesh`. Every line of the mesh must belong to two triangles, in opposite directions.
void smooth(const Mesh& mesh, float spacing_m, const SmoothingParameters& parameters, Mesh& result,
            SmoothingWork& work);

}  // namespace calot::surface

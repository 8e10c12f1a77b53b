#include "calot/surface/vertex_batch.h"

#include <algorithm>
#include <cmath>

namespace calot::surface {

void evaluate_reference(PointBatch& points) {
    for (std::size_t k = 0; k < points.count; ++k) {
        const Moments m{static_cast<int>(points.weight[k]),
                        Int3(points.mean[0][k], points.mean[1][k], points.mean[2][k]), Int3(0)};
        points.value[k] = field_value(m, points.present[k] > 0.0f);
    }
}

void evaluate_reference(EdgeBatch& edges) {
    for (std::size_t k = 0; k < edges.count; ++k) {
        const float a = edges.lower_value[k], b = edges.upper_value[k];
        const float t = a / (a - b);
        const float outward = a < 0.0f ? 1.0f : -1.0f;
        std::array<float, 3> n{};
        for (std::size_t c = 0; c < 3; ++c)
            n[c] = -((1.0f - t) * edges.lower_slope[c][k] + t * edges.upper_slope[c][k]);
        n[0] = outward * std::max(outward * n[0], 0.0f);
        const float squares = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
        const float per_length = squares > 0.0f ? 1.0f / std::sqrt(squares) : 0.0f;
        edges.share[k] = t;
        edges.normal[0][k] = squares > 0.0f ? n[0] * per_length : outward;
        edges.normal[1][k] = n[1] * per_length;
        edges.normal[2][k] = n[2] * per_length;
    }
}

}  // namespace calot::surface

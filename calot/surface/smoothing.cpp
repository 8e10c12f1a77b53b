#include "calot/surface/smoothing.h"

#include <algorithm>

namespace calot::surface {

namespace {

/// sum[a] = sum of value over the neighbours of a. In a closed mesh every neighbour follows a in exactly one triangle.
void add_neighbours(const std::vector<std::uint32_t>& index, const std::vector<Vec3f>& value, std::vector<Vec3f>& sum) {
    for (std::size_t t = 0; t < index.size(); t += 3) {
        const std::uint32_t a = index[t], b = index[t + 1], c = index[t + 2];
        sum[a] += value[b];
        sum[b] += value[c];
        sum[c] += value[a];
    }
}

}  // namespace

void smooth(const Mesh& mesh, float spacing_m, const SmoothingParameters& parameters, Mesh& result,
            SmoothingWork& work) {
    result = mesh;
    const std::size_t vertices = mesh.position_m.size();
    work.share.assign(vertices, 0.0f);
    for (std::uint32_t v : mesh.index) work.share[v] += 1.0f;
    for (float& share : work.share) share = 1.0f / share;

    const Vec3f bound(parameters.bound * spacing_m);
    for (int pass = 0; pass < 2 * parameters.position_passes; ++pass) {
        const float step = pass % 2 == 0 ? parameters.inward : -parameters.outward;
        work.sum.assign(vertices, Vec3f(0.0f));
        add_neighbours(mesh.index, result.position_m, work.sum);
        for (std::size_t v = 0; v < vertices; ++v) {
            const Vec3f moved = result.position_m[v] + step * (work.share[v] * work.sum[v] - result.position_m[v]);
            result.position_m[v] = glm::clamp(moved, mesh.position_m[v] - bound, mesh.position_m[v] + bound);
        }
    }
    for (int pass = 0; pass < parameters.normal_passes; ++pass) {
        work.sum = result.normal;
        add_neighbours(mesh.index, result.normal, work.sum);
        for (std::size_t v = 0; v < vertices; ++v) {
            const float length = glm::length(work.sum[v]);
            if (length > 1e-3f) result.normal[v] = work.sum[v] / length;
        }
    }
}

}  // namespace calot::surface

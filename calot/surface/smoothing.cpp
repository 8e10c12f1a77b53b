#include "calot/surface/smoothing.h"

#include <algorithm>
#include <cmath>

namespace calot::surface {

namespace {

/// sum[a] = sum of value over the neighbours of a. In a closed mesh every neighbour follows a in exactly one triangle.
void add_neighbours(const std::vector<std::uint32_t>& index, const Array<glm::vec4>& value, Array<glm::vec4>& sum) {
    for (std::size_t t = 0; t < index.size(); t += 3) {
        const std::uint32_t a = index[t], b = index[t + 1], c = index[t + 2];
        sum[a] += value[b];
        sum[b] += value[c];
        sum[c] += value[a];
    }
}

void smooth_positions(const Mesh& mesh, float bound_m, const SmoothingParameters& parameters, Mesh& result,
                      SmoothingWork& work) {
    const std::size_t vertices = mesh.position_m.size();
    // The fourth component counts neighbours.
    for (std::size_t v = 0; v < vertices; ++v) work.value[v] = glm::vec4(mesh.position_m[v], 1.0f);
    for (int pass = 0; pass < 2 * parameters.position_passes; ++pass) {
        const float step = pass % 2 == 0 ? parameters.inward : -parameters.outward;
        if (step == 0.0f) continue;
        std::fill(work.sum.begin(), work.sum.end(), glm::vec4(0.0f));
        add_neighbours(mesh.index, work.value, work.sum);
        for (std::size_t v = 0; v < vertices; ++v) {
            const Vec3f here(work.value[v]), middle = Vec3f(work.sum[v]) * (1.0f / work.sum[v].w);
            const Vec3f moved = here + step * (middle - here);
            work.value[v] =
                glm::vec4(glm::clamp(moved, mesh.position_m[v] - bound_m, mesh.position_m[v] + bound_m), 1.0f);
        }
    }
    for (std::size_t v = 0; v < vertices; ++v) result.position_m[v] = Vec3f(work.value[v]);
}

void smooth_normals(const Mesh& mesh, int passes, Mesh& result, SmoothingWork& work) {
    const std::size_t vertices = mesh.normal.size();
    for (std::size_t v = 0; v < vertices; ++v) work.value[v] = glm::vec4(mesh.normal[v], 0.0f);
    for (int pass = 0; pass < passes; ++pass) {
        work.sum = work.value;
        add_neighbours(mesh.index, work.value, work.sum);
        for (std::size_t v = 0; v < vertices; ++v) {
            const glm::vec4 n = work.sum[v];
            const float squares = glm::dot(n, n);
            if (squares > 1e-6f) work.value[v] = n * (1.0f / std::sqrt(squares));
        }
    }
    for (std::size_t v = 0; v < vertices; ++v) result.normal[v] = Vec3f(work.value[v]);
}

}  // namespace

void smooth(const Mesh& mesh, float spacing_m, const SmoothingParameters& parameters, Mesh& result,
            SmoothingWork& work) {
    const std::size_t vertices = mesh.position_m.size();
    result.index = mesh.index;
    result.position_m.resize(vertices);
    result.normal.resize(vertices);
    work.value.resize(vertices);
    work.sum.resize(vertices);
    smooth_positions(mesh, parameters.bound * spacing_m, parameters, result, work);
    smooth_normals(mesh, parameters.normal_passes, result, work);
}

}  // namespace calot::surface

#include "calot/surface/shape_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "calot/base/parallel.h"
#include "calot/surface/cubes.h"

namespace calot::surface {

namespace {

/// Distances at the points of a grid, x fastest.
struct DistanceGrid {
    Vec3 low;
    Vec3 step;
    Int3 points;
    std::vector<float> distance;

    std::size_t at(int x, int y, int z) const {
        return (static_cast<std::size_t>(z) * static_cast<std::size_t>(points.y) + static_cast<std::size_t>(y)) *
                   static_cast<std::size_t>(points.x) +
               static_cast<std::size_t>(x);
    }
    Vec3 place(const Vec3& p) const { return low + p * step; }
};

/// Cells of the grid fit `box`, but where the solid ends inside it.
DistanceGrid make_grid(const anatomy::Shape& shape, const Box& box, double spacing_m) {
    const Box bounds = shape.bounds_m();
    const Vec3 low = glm::max(box.low, bounds.low - 2.0 * spacing_m),
               high = glm::min(box.high, bounds.high + 2.0 * spacing_m);
    DistanceGrid grid;
    grid.low = low;
    if (glm::any(glm::lessThanEqual(high, low))) {
        grid.points = Int3(0);
        return grid;
    }
    const Int3 cells = glm::max(Int3(glm::ceil((high - low) / spacing_m - 1e-9)), Int3(1));
    grid.step = (high - low) / Vec3(cells);
    grid.points = cells + 1;
    grid.distance.resize(static_cast<std::size_t>(grid.points.x) * static_cast<std::size_t>(grid.points.y) *
                         static_cast<std::size_t>(grid.points.z));
    return grid;
}

/// Distances never overestimate: one look at the middle of a block tells that the surface passes it by. The margin
/// of a half is for shapes that keep that promise loosely.
void sample_distances(const anatomy::Shape& shape, DistanceGrid& grid) {
    constexpr int kBlockPoints = 8;
    const Vec3 half =
        0.5 * (kBlockPoints + 1) * grid.step;  // with a cell all round, so that no edge leads into the unknown
    const double far_m = 1.5 * glm::length(half);
    const int slabs = (grid.points.z + kBlockPoints - 1) / kBlockPoints;
    parallel_for("surface.shape_distances", 0, slabs, 1, [&](std::int64_t slab_low, std::int64_t slab_high) {
        for (int z0 = static_cast<int>(slab_low) * kBlockPoints; z0 < static_cast<int>(slab_high) * kBlockPoints;
             z0 += kBlockPoints)
            for (int y0 = 0; y0 < grid.points.y; y0 += kBlockPoints)
                for (int x0 = 0; x0 < grid.points.x; x0 += kBlockPoints) {
                    const double middle_m = shape.distance_m(grid.place(Vec3(x0, y0, z0) + 0.5 * (kBlockPoints - 1)));
                    const bool passed_by = std::abs(middle_m) > far_m;
                    for (int z = z0; z < std::min(z0 + kBlockPoints, grid.points.z); ++z)
                        for (int y = y0; y < std::min(y0 + kBlockPoints, grid.points.y); ++y)
                            for (int x = x0; x < std::min(x0 + kBlockPoints, grid.points.x); ++x)
                                grid.distance[grid.at(x, y, z)] = static_cast<float>(
                                    passed_by ? middle_m : shape.distance_m(grid.place(Vec3(x, y, z))));
                }
    });
}

/// Gradient of the distance by four evaluations at the corners of a tetrahedron.
Vec3 gradient(const anatomy::Shape& shape, const Vec3& p, double h_m) {
    Vec3 sum(0.0);
    for (const Vec3& d : {Vec3(1, -1, -1), Vec3(-1, -1, 1), Vec3(-1, 1, -1), Vec3(1, 1, 1)})
        sum += d * shape.distance_m(p + h_m * d);
    return sum / (4.0 * h_m);
}

/// Where the surface meets the line between two grid points, and its normal. Two Newton steps along the gradient make
/// up for distances that are not linear; they stay within half a cell.
void place_vertex(const anatomy::Shape& shape, const DistanceGrid& grid, const Int3& p, int axis, Vec3f& position_m,
                  Vec3f& normal) {
    Int3 q = p;
    ++q[axis];
    const double a = grid.distance[grid.at(p.x, p.y, p.z)], b = grid.distance[grid.at(q.x, q.y, q.z)];
    Vec3 start(p);
    start[axis] += std::clamp(a / (a - b), 0.01, 0.99);
    const double cell_m = std::min({grid.step.x, grid.step.y, grid.step.z}), h_m = 0.1 * cell_m;
    const Vec3 first = grid.place(start);
    Vec3 x = first;
    Vec3 g = gradient(shape, x, h_m);
    if (glm::dot(g, g) > 1e-6)
        for (int step = 0; step < 2; ++step) {
            const Vec3 next = x - shape.distance_m(x) / glm::dot(g, g) * g;
            if (glm::length(next - first) > 0.5 * cell_m) break;
            x = next;
        }
    g = gradient(shape, x, h_m);
    Vec3 outward(0.0);
    outward[axis] = a < b ? 1.0 : -1.0;
    position_m = Vec3f(x);
    normal = Vec3f(glm::dot(g, g) > 1e-6 ? glm::normalize(g) : outward);
}

}  // namespace

Mesh mesh_of_shape(const anatomy::Shape& shape, const Box& box, double spacing_m) {
    DistanceGrid grid = make_grid(shape, box, spacing_m);
    Mesh mesh;
    if (grid.distance.empty()) return mesh;
    sample_distances(shape, grid);
    const Int3 n = grid.points;
    auto inside = [&](int x, int y, int z) { return grid.distance[grid.at(x, y, z)] < 0.0f; };
    auto case_at = [&](int x, int y, int z) {
        std::size_t c = 0;
        for (int k = 0; k < 8; ++k)
            c |= static_cast<std::size_t>(inside(x + (k & 1), y + ((k >> 1) & 1), z + (k >> 2))) << k;
        return c;
    };
    auto for_each_cut_edge = [&](int z, const auto& visit) {
        for (int y = 0; y < n.y; ++y)
            for (int x = 0; x < n.x; ++x) {
                const bool here = inside(x, y, z);
                if (x + 1 < n.x && here != inside(x + 1, y, z)) visit(Int3(x, y, z), 0);
                if (y + 1 < n.y && here != inside(x, y + 1, z)) visit(Int3(x, y, z), 1);
                if (z + 1 < n.z && here != inside(x, y, z + 1)) visit(Int3(x, y, z), 2);
            }
    };
    // Count by slab, so that slabs know where to write; then write in parallel.
    std::vector<std::uint32_t> first_vertex(static_cast<std::size_t>(n.z) + 1, 0),
        first_triangle(static_cast<std::size_t>(n.z) + 1, 0);
    parallel_for("surface.shape_count", 0, n.z, 1, [&](std::int64_t low, std::int64_t) {
        const int z = static_cast<int>(low);
        std::uint32_t vertices = 0, triangles = 0;
        for_each_cut_edge(z, [&](const Int3&, int) { ++vertices; });
        if (z + 1 < n.z)
            for (int y = 0; y + 1 < n.y; ++y)
                for (int x = 0; x + 1 < n.x; ++x) triangles += cube_cases()[case_at(x, y, z)].triangles;
        first_vertex[static_cast<std::size_t>(z) + 1] = vertices;
        first_triangle[static_cast<std::size_t>(z) + 1] = triangles;
    });
    for (std::size_t z = 0; z < static_cast<std::size_t>(n.z); ++z) {
        first_vertex[z + 1] += first_vertex[z];
        first_triangle[z + 1] += first_triangle[z];
    }
    mesh.position_m.resize(first_vertex.back());
    mesh.normal.resize(first_vertex.back());
    mesh.index.resize(3 * std::size_t{first_triangle.back()});
    std::vector<std::uint32_t> vertex_of(3 * grid.distance.size());  // by point and axis
    parallel_for("surface.shape_vertices", 0, n.z, 1, [&](std::int64_t low, std::int64_t) {
        std::uint32_t vertex = first_vertex[static_cast<std::size_t>(low)];
        for_each_cut_edge(static_cast<int>(low), [&](const Int3& p, int axis) {
            place_vertex(shape, grid, p, axis, mesh.position_m[vertex], mesh.normal[vertex]);
            vertex_of[3 * grid.at(p.x, p.y, p.z) + static_cast<std::size_t>(axis)] = vertex++;
        });
    });
    parallel_for("surface.shape_triangles", 0, n.z - 1, 1, [&](std::int64_t low, std::int64_t) {
        const int z = static_cast<int>(low);
        std::uint32_t* index = mesh.index.data() + 3 * std::size_t{first_triangle[static_cast<std::size_t>(z)]};
        for (int y = 0; y + 1 < n.y; ++y)
            for (int x = 0; x + 1 < n.x; ++x) {
                const CubeCase& c = cube_cases()[case_at(x, y, z)];
                for (std::size_t k = 0; k < 3u * c.triangles; ++k) {
                    const Int3 p = Int3(x, y, z) + edge_corner(c.edge[k]);
                    *index++ = vertex_of[3 * grid.at(p.x, p.y, p.z) + static_cast<std::size_t>(c.edge[k] / 4)];
                }
            }
    });
    return mesh;
}

}  // namespace calot::surface

#pragma once
// Marching cubes: which triangles separate the inside corners of a cube from the outside ones. The tables are made
// at start-up from one rule, not written down, so that every case obeys it.
//
//   - Corner k = x + 2 y + 4 z of the unit cube; bit k of a case says that the corner is inside.
//   - Edge 4 a + b + 2 c runs along axis a; b and c are the corner's coordinates along the next two axes (cyclic).
//   - A face with two inside corners across its diagonal keeps them apart. The rule sees the face alone, so that both
//     cubes that share it cut it alike: the surface is closed.
//   - Polygons are split by diagonals that never join two edges of one face. Such a diagonal would lie in that face,
//     where the neighbour's could meet it: four triangles at one line. Without them the surface is manifold always,
//     as every line of a face belongs to two cubes and every diagonal to one.

#include <array>
#include <cstdint>
#include <vector>

#include "calot/base/vec.h"

namespace calot::surface {

inline constexpr int kMostTriangles = 5;  ///< of one cube

struct CubeCase {
    std::uint8_t triangles = 0;
    std::array<std::uint8_t, 3 * kMostTriangles> edge{};  ///< three a triangle, counter-clockwise seen from outside
};

/// All 256 cases.
const std::array<CubeCase, 256>& cube_cases();

/// Corner of an edge at its lower end.
constexpr Int3 edge_corner(int edge) {
    const int axis = edge / 4, b = edge & 1, c = (edge >> 1) & 1;
    Int3 corner{0};
    corner[(axis + 1) % 3] = b;
    corner[(axis + 2) % 3] = c;
    return corner;
}

/// Closed polygons (edges in order) of a case, before they are split into triangles. For tests.
std::vector<std::vector<int>> cube_polygons(int inside);

/// True when two different edges lie in one face of the cube.
bool share_face(int edge_a, int edge_b);

}  // namespace calot::surface

#include "calot/surface/cubes.h"

#include <cassert>

namespace calot::surface {

namespace {

int corner_at(const Int3& p) {
    return p.x + 2 * p.y + 4 * p.z;
}

/// Edge between two adjacent corners.
int edge_between(const Int3& p, const Int3& q) {
    for (int axis = 0; axis < 3; ++axis)
        if (p[axis] != q[axis]) return 4 * axis + p[(axis + 1) % 3] + 2 * p[(axis + 2) % 3];
    return -1;
}

/// The four corners of a face, counter-clockwise seen from outside the cube.
std::array<Int3, 4> face_corners(int axis, int side) {
    std::array<Int3, 4> corner{};
    constexpr std::array<std::array<int, 2>, 4> kTurn{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    for (std::size_t k = 0; k < 4; ++k) {
        const auto& turn = kTurn[side == 1 ? k : 3 - k];
        corner[k][axis] = side;
        corner[k][(axis + 1) % 3] = turn[0];
        corner[k][(axis + 2) % 3] = turn[1];
    }
    return corner;
}

/// next[e]: where the polygon through edge e goes, -1 when the edge is not cut. On each face every run of inside
/// corners is cut off by a line of its own, from the edge where the run begins to the edge where it ends.
std::array<int, 12> face_lines(int inside) {
    std::array<int, 12> next{};
    next.fill(-1);
    for (int axis = 0; axis < 3; ++axis)
        for (int side = 0; side < 2; ++side) {
            const auto corner = face_corners(axis, side);
            auto is_inside = [&](std::size_t k) { return (inside >> corner_at(corner[k % 4])) & 1; };
            for (std::size_t begin = 0; begin < 4; ++begin) {
                if (is_inside(begin) || !is_inside(begin + 1)) continue;
                std::size_t end = begin + 1;
                while (is_inside(end + 1)) ++end;
                next[static_cast<std::size_t>(edge_between(corner[begin], corner[(begin + 1) % 4]))] =
                    edge_between(corner[end % 4], corner[(end + 1) % 4]);
            }
        }
    return next;
}

/// Twice the middle of an edge, in integers.
Int3 twice_middle(int edge) {
    Int3 p = 2 * edge_corner(edge);
    p[edge / 4] = 1;
    return p;
}

/// Splits polygon[first..last] so that the sum of squared diagonals is least. Returns the sum, or kForbidden.
constexpr int kForbidden = 1 << 20;
int split(const std::vector<int>& polygon, std::size_t first, std::size_t last, std::vector<int>& triangles) {
    triangles.clear();
    if (last - first < 2) return 0;
    int best = kForbidden;
    std::vector<int> left, right;
    for (std::size_t apex = first + 1; apex < last; ++apex) {
        int sum = 0;
        auto add_diagonal = [&](std::size_t a, std::size_t b) {
            if (b - a < 2 || (a == 0 && b + 1 == polygon.size())) return;  // a side, not a diagonal
            const Int3 d = twice_middle(polygon[a]) - twice_middle(polygon[b]);
            sum += share_face(polygon[a], polygon[b]) ? kForbidden : d.x * d.x + d.y * d.y + d.z * d.z;
        };
        add_diagonal(first, apex);
        add_diagonal(apex, last);
        if (sum >= best) continue;
        sum += split(polygon, first, apex, left);
        if (sum >= best) continue;
        sum += split(polygon, apex, last, right);
        if (sum >= best) continue;
        best = sum;
        triangles = left;
        triangles.insert(triangles.end(), {polygon[first], polygon[apex], polygon[last]});
        triangles.insert(triangles.end(), right.begin(), right.end());
    }
    return best;
}

std::array<CubeCase, 256> make_cases() {
    std::array<CubeCase, 256> cases{};
    std::vector<int> triangles;
    for (int inside = 0; inside < 256; ++inside) {
        CubeCase& c = cases[static_cast<std::size_t>(inside)];
        for (const std::vector<int>& polygon : cube_polygons(inside)) {
            [[maybe_unused]] const int sum = split(polygon, 0, polygon.size() - 1, triangles);
            assert(sum < kForbidden);
            for (std::size_t k = 0; k < triangles.size(); k += 3) {
                assert(c.triangles < kMostTriangles);
                for (std::size_t corner = 0; corner < 3; ++corner)
                    c.edge[3u * c.triangles + corner] = static_cast<std::uint8_t>(triangles[k + corner]);
                ++c.triangles;
            }
        }
    }
    return cases;
}

}  // namespace

bool share_face(int edge_a, int edge_b) {
    const Int3 a = twice_middle(edge_a), b = twice_middle(edge_b);
    for (int axis = 0; axis < 3; ++axis)
        if (a[axis] == b[axis] && a[axis] != 1) return true;
    return false;
}

std::vector<std::vector<int>> cube_polygons(int inside) {
    const std::array<int, 12> next = face_lines(inside);
    std::vector<std::vector<int>> polygons;
    std::array<bool, 12> seen{};
    for (int start = 0; start < 12; ++start) {
        if (next[static_cast<std::size_t>(start)] < 0 || seen[static_cast<std::size_t>(start)]) continue;
        polygons.emplace_back();
        for (int edge = start; !seen[static_cast<std::size_t>(edge)]; edge = next[static_cast<std::size_t>(edge)]) {
            seen[static_cast<std::size_t>(edge)] = true;
            polygons.back().push_back(edge);
        }
    }
    return polygons;
}

const std::array<CubeCase, 256>& cube_cases() {
    static const std::array<CubeCase, 256> cases = make_cases();
    return cases;
}

}  // namespace calot::surface

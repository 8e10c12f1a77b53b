#include "calot/surface/cubes.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

namespace calot::surface {

namespace {

int corner_of(const Int3& p) {
    return p.x + 2 * p.y + 4 * p.z;
}

bool is_cut(int inside, int edge) {
    Int3 end = edge_corner(edge);
    ++end[edge / 4];
    return ((inside >> corner_of(edge_corner(edge))) & 1) != ((inside >> corner_of(end)) & 1);
}

using Lines = std::map<std::pair<int, int>, int>;  ///< directed line between edges -> how often

Lines lines_of(int inside) {
    Lines lines;
    const CubeCase& c = cube_cases()[static_cast<std::size_t>(inside)];
    for (std::size_t t = 0; t < 3u * c.triangles; t += 3)
        for (std::size_t k = 0; k < 3; ++k) ++lines[{c.edge[t + k], c.edge[t + (k + 1) % 3]}];
    return lines;
}

/// Lines that lie in a face and are not met by their opposite.
Lines lines_in_face(int inside, int axis, int side) {
    Lines found;
    for (const auto& [line, count] : lines_of(inside)) {
        const auto in_face = [&](int edge) { return edge / 4 != axis && edge_corner(edge)[axis] == side; };
        if (in_face(line.first) && in_face(line.second)) found[line] = count;
    }
    return found;
}

}  // namespace

TEST(Cubes, PolygonsPassEveryCutEdgeOnce) {
    for (int inside = 0; inside < 256; ++inside) {
        std::multiset<int> passed;
        for (const auto& polygon : cube_polygons(inside)) {
            EXPECT_GE(polygon.size(), 3u);
            passed.insert(polygon.begin(), polygon.end());
        }
        for (int edge = 0; edge < 12; ++edge) EXPECT_EQ(passed.count(edge), is_cut(inside, edge) ? 1u : 0u) << inside;
    }
}

TEST(Cubes, TrianglesFillTheirPolygons) {
    for (int inside = 0; inside < 256; ++inside) {
        std::set<std::pair<int, int>> sides;
        std::size_t triangles = 0;
        for (const auto& polygon : cube_polygons(inside)) {
            triangles += polygon.size() - 2;
            for (std::size_t k = 0; k < polygon.size(); ++k)
                sides.insert({polygon[k], polygon[(k + 1) % polygon.size()]});
        }
        EXPECT_EQ(cube_cases()[static_cast<std::size_t>(inside)].triangles, triangles);
        const Lines lines = lines_of(inside);
        for (const auto& [line, count] : lines) {
            EXPECT_EQ(count, 1) << inside;
            const bool met = lines.count({line.second, line.first}) > 0;
            EXPECT_NE(met, sides.count(line) > 0) << "case " << inside << ": a line is a side or an inner diagonal";
            EXPECT_FALSE(met && share_face(line.first, line.second)) << "case " << inside << ": a diagonal in a face";
        }
        for (const auto& side : sides) EXPECT_EQ(lines.count(side), 1u);
    }
}

TEST(Cubes, NeighboursCutTheirFaceAlike) {
    // Every pair of cubes that share a face: 16 patterns of the face times 16 x 16 of what lies beyond.
    for (int axis = 0; axis < 3; ++axis)
        for (int low = 0; low < 256; ++low)
            for (int high = 0; high < 256; ++high) {
                bool agree = true;  // corners of the upper face of `low` are those of the lower face of `high`
                for (int k = 0; k < 8; ++k)
                    if ((k >> axis) & 1) agree &= ((low >> k) & 1) == ((high >> (k ^ (1 << axis))) & 1);
                if (!agree) continue;
                // An edge's number differs between the two cubes by the bit of `axis`.
                Lines from_high;
                for (const auto& [line, count] : lines_in_face(high, axis, 0)) {
                    const auto moved = [&](int edge) { return edge + ((edge / 4 + 1) % 3 == axis ? 1 : 2); };
                    from_high[{moved(line.second), moved(line.first)}] = count;
                }
                ASSERT_EQ(lines_in_face(low, axis, 1), from_high) << low << " below " << high << " along axis " << axis;
            }
}

TEST(Cubes, TrianglesFaceOutwards) {
    for (int corner = 0; corner < 8; ++corner) {
        const CubeCase& lone = cube_cases()[std::size_t{1} << corner];
        ASSERT_EQ(lone.triangles, 1);
        std::array<Vec3, 3> p;
        for (std::size_t k = 0; k < 3; ++k) {
            p[k] = Vec3(edge_corner(lone.edge[k]));
            p[k][lone.edge[k] / 4] += 0.5;
        }
        const Vec3 away = Vec3(0.5) - Vec3(corner & 1, (corner >> 1) & 1, corner >> 2);
        EXPECT_GT(glm::dot(glm::cross(p[1] - p[0], p[2] - p[0]), away), 0.0);
    }
}

}  // namespace calot::surface

// The surface stays a closed manifold while anything burns, in any order.

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "calot/validation/surface_bodies.h"

namespace calot::surface {

namespace {

/// Every vertex lies in a single fan of triangles.
bool vertices_are_manifold(const Mesh& mesh) {
    std::vector<std::map<std::uint32_t, std::uint32_t>> after(mesh.position_m.size());
    for (std::size_t t = 0; t < mesh.index.size(); t += 3)
        for (std::size_t k = 0; k < 3; ++k) {
            auto& next = after[mesh.index[t + k]];
            if (!next.emplace(mesh.index[t + (k + 1) % 3], mesh.index[t + (k + 2) % 3]).second) return false;
        }
    for (const auto& next : after) {
        if (next.empty()) return false;
        std::size_t turned = 0;
        std::uint32_t v = next.begin()->first;
        do {
            const auto found = next.find(v);
            if (found == next.end()) return false;
            v = found->second;
            ++turned;
        } while (v != next.begin()->first && turned <= next.size());
        if (turned != next.size()) return false;
    }
    return true;
}

void expect_sound(const Body& body, const Surface& surface) {
    const Mesh& mesh = surface.rest_mesh();
    const MeshCheck found = check(mesh);
    ASSERT_TRUE(found.closed) << found.open_edges << " open, " << found.nonmanifold_edges << " non-manifold, "
                              << found.degenerate_triangles << " degenerate";
    ASSERT_EQ(mesh.normal.size(), mesh.position_m.size());
    ASSERT_EQ(surface.owner().size(), mesh.position_m.size());
    for (std::size_t v = 0; v < mesh.position_m.size(); ++v) {
        ASSERT_NEAR(glm::length(mesh.normal[v]), 1.0f, 1e-5f);
        const std::int64_t owner = surface.owner()[v];
        ASSERT_TRUE(body.state.hexel_present.test(owner));
        // The inside end of the vertex's lattice edge is less than a spacing away.
        ASSERT_LT(glm::length(Vec3(mesh.position_m[v]) - body.model.hexels.centre_m(owner)), kTestSpacing_m);
    }
    if (!mesh.position_m.empty()) {
        ASSERT_GT(volume_m3(mesh), 0.0);
    }
}

/// Removes hexels a few at a time until all are gone and looks at the surface after every removal.
void burn(Body body, std::uint64_t seed, std::size_t most_at_once) {
    Surface surface(body.model);
    surface.rebuild(body.model, body.state);
    expect_sound(body, surface);
    Random random(seed);
    std::vector<std::int64_t> left = body.hexels();
    shuffle(left, random);
    for (int round = 0; !left.empty(); ++round) {
        const std::size_t count = std::min<std::size_t>(left.size(), 1 + random.next() % most_at_once);
        const std::vector<std::int64_t> gone(left.end() - static_cast<std::ptrdiff_t>(count), left.end());
        left.resize(left.size() - count);
        body.remove(gone, surface);
        expect_sound(body, surface);
        if (round % 16 == 0) {
            ASSERT_TRUE(vertices_are_manifold(surface.rest_mesh()));
        }
        if (testing::Test::HasFatalFailure()) return;
    }
    EXPECT_EQ(surface.rest_mesh().triangles(), 0u);
}

}  // namespace

TEST(Burn, Ball) {
    burn(ball(17, 7.3), 1, 12);
}
TEST(Burn, Sheet) {
    burn(sheet({3, 21, 19}), 2, 4);
}
TEST(Burn, Checkerboard) {
    burn(checkerboard(11), 3, 6);
}
TEST(Burn, Noise) {
    burn(noise({9, 18, 10}, 0.5, 4), 4, 8);
}
TEST(Burn, DenseNoise) {
    burn(noise({8, 7, 17}, 0.9, 5), 5, 8);
}
TEST(Burn, OneByOne) {
    burn(noise({6, 7, 8}, 0.6, 6), 6, 1);
}

TEST(Burn, EveryPatternOfEightHexels) {
    for (int pattern = 1; pattern < 256; ++pattern) {
        const Body body(Int3(4), [&](const Int3& c) {
            const Int3 d = c - 1;
            return glm::all(glm::greaterThanEqual(d, Int3(0))) && glm::all(glm::lessThan(d, Int3(2))) &&
                   ((pattern >> (d.x + 2 * d.y + 4 * d.z)) & 1);
        });
        Surface surface(body.model);
        surface.rebuild(body.model, body.state);
        expect_sound(body, surface);
        ASSERT_TRUE(vertices_are_manifold(surface.rest_mesh())) << pattern;
    }
}

TEST(Burn, ACutOneHexelWideParts) {
    // Two halves, each closed: every triangle lies on one side of the cut.
    Body body(Int3(20, 12, 12),
              [](const Int3& c) { return c.x > 1 && c.x < 18 && c.y > 1 && c.y < 10 && c.z > 1 && c.z < 10; });
    Surface surface(body.model);
    surface.rebuild(body.model, body.state);
    std::vector<std::int64_t> cut;
    for (std::int64_t h : body.hexels())
        if (body.model.hexels.coordinates(h).x == 9) cut.push_back(h);
    body.remove(cut, surface);
    expect_sound(body, surface);
    const Mesh& mesh = surface.rest_mesh();
    const double middle_m = body.model.hexels.centre_m(Int3(9, 0, 0)).x;
    for (std::size_t t = 0; t < mesh.index.size(); t += 3) {
        int left = 0;
        for (std::size_t k = 0; k < 3; ++k) left += mesh.position_m[mesh.index[t + k]].x < middle_m;
        ASSERT_TRUE(left == 0 || left == 3);
    }
}

TEST(Burn, TissueAtTheEdgeOfTheLatticeIsClosedToo) {
    const Body body(Int3(5, 6, 7), [](const Int3&) { return true; });
    Surface surface(body.model);
    surface.rebuild(body.model, body.state);
    expect_sound(body, surface);
    EXPECT_NEAR(volume_m3(surface.rest_mesh()) / body.volume_m3(), 1.0, 0.2);  // small, and its edges are rounded
}

}  // namespace calot::surface

#include <gtest/gtest.h>

#include "calot/surface/smoothing.h"
#include "calot/surface/surface.h"

namespace calot::surface {

namespace {

Mesh tetrahedron() {
    Mesh mesh;
    mesh.position_m = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    mesh.normal = {{-0.6f, -0.6f, -0.6f}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    mesh.index = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
    return mesh;
}

}  // namespace

TEST(MeshCheck, TellsWhatIsWrong) {
    Mesh mesh = tetrahedron();
    EXPECT_TRUE(check(mesh).closed);
    EXPECT_NEAR(volume_m3(mesh), 1.0 / 6.0, 1e-12);
    EXPECT_TRUE(check(Mesh{}).closed);
    EXPECT_EQ(volume_m3(Mesh{}), 0.0);

    Mesh open = mesh;
    open.index.resize(9);
    EXPECT_EQ(check(open).open_edges, 3);
    EXPECT_FALSE(check(open).closed);

    Mesh turned = mesh;  // one triangle inside out
    std::swap(turned.index[0], turned.index[1]);
    EXPECT_EQ(check(turned).nonmanifold_edges, 3);
    EXPECT_FALSE(check(turned).closed);

    Mesh doubled = mesh;
    doubled.index.insert(doubled.index.end(), mesh.index.begin(), mesh.index.end());
    EXPECT_EQ(check(doubled).nonmanifold_edges, 6 * 2);

    Mesh flat = mesh;
    flat.index.insert(flat.index.end(), {0, 1, 1});
    EXPECT_EQ(check(flat).degenerate_triangles, 1);
    EXPECT_FALSE(check(flat).closed);
}

TEST(Smoothing, StaysWithinItsBound) {
    const Mesh mesh = tetrahedron();
    Mesh smoothed;
    SmoothingWork work;
    smooth(mesh, 0.1f, {.position_passes = 20, .bound = 0.25f}, smoothed, work);
    EXPECT_EQ(smoothed.index, mesh.index);
    for (std::size_t v = 0; v < 4; ++v)
        for (int k = 0; k < 3; ++k)
            EXPECT_LE(std::abs(smoothed.position_m[v][k] - mesh.position_m[v][k]), 0.025f + 1e-6f);
    // No passes: the same mesh.
    smooth(mesh, 0.1f, {.position_passes = 0, .normal_passes = 0}, smoothed, work);
    EXPECT_EQ(smoothed.position_m, mesh.position_m);
    EXPECT_EQ(smoothed.normal, mesh.normal);
}

}  // namespace calot::surface

#include "calot/surface/shape_mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "calot/anatomy/shapes.h"
#include "calot/base/parallel.h"
#include "calot/surface/surface.h"

namespace calot::surface {

namespace {
const Vec3 kCentre(0.003, -0.001, 0.002);
constexpr double kRadius = 0.01;
const Box kRoom{Vec3(-0.03), Vec3(0.03)};
}  // namespace

TEST(ShapeMesh, SphereLiesOnTheSphere) {
    const auto sphere = anatomy::make_sphere(kCentre, kRadius);
    const Mesh mesh = mesh_of_shape(*sphere, kRoom, 1e-3);
    ASSERT_GT(mesh.triangles(), 500u);
    EXPECT_TRUE(check(mesh).closed);
    for (std::size_t v = 0; v < mesh.position_m.size(); ++v) {
        const Vec3 d = Vec3(mesh.position_m[v]) - kCentre;
        ASSERT_NEAR(glm::length(d), kRadius, 1e-8);                                      // float positions, 1 nm
        ASSERT_GT(glm::dot(glm::normalize(d), Vec3(mesh.normal[v])), std::cos(0.5e-2));  // central differences
    }
}

TEST(ShapeMesh, VolumeConvergesWithTheSquareOfTheSpacing) {
    const auto sphere = anatomy::make_sphere(kCentre, kRadius);
    const double exact_m3 = 4.0 / 3.0 * 3.14159265358979 * kRadius * kRadius * kRadius;
    const double coarse = 1.0 - volume_m3(mesh_of_shape(*sphere, kRoom, 1e-3)) / exact_m3;
    const double fine = 1.0 - volume_m3(mesh_of_shape(*sphere, kRoom, 0.5e-3)) / exact_m3;
    EXPECT_LT(coarse, 0.01);
    EXPECT_NEAR(coarse / fine, 4.0, 0.4);
}

TEST(ShapeMesh, BoundsOnDistanceWillDo) {
    // A distance that is too small by half away from the surface, and steeper than 1 nowhere.
    const auto bound = anatomy::make_shape(
        [](const Vec3& p) {
            const double d = glm::length(p - kCentre) - kRadius;
            return d / (1.0 + std::abs(d) / kRadius);
        },
        {kCentre - kRadius, kCentre + kRadius});
    const Mesh mesh = mesh_of_shape(*bound, kRoom, 1e-3);
    EXPECT_TRUE(check(mesh).closed);
    for (const Vec3f& p : mesh.position_m) ASSERT_NEAR(glm::length(Vec3(p) - kCentre), kRadius, 1e-3 * 1e-3);
}

TEST(ShapeMesh, IsOpenWhereTheBoxCutsIt) {
    const auto sphere = anatomy::make_sphere(kCentre, kRadius);
    const Box half{Vec3(-0.03), Vec3(0.03, 0.03, kCentre.z)};
    const Mesh mesh = mesh_of_shape(*sphere, half, 1e-3);
    const MeshCheck found = check(mesh);
    EXPECT_FALSE(found.closed);
    EXPECT_GT(found.open_edges, 0);
    EXPECT_EQ(found.nonmanifold_edges, 0);
    for (const Vec3f& p : mesh.position_m) EXPECT_LE(p.z, kCentre.z + 0.5e-3);
}

TEST(ShapeMesh, NothingOutsideTheBox) {
    const auto sphere = anatomy::make_sphere(Vec3(1.0), kRadius);
    EXPECT_EQ(mesh_of_shape(*sphere, kRoom, 1e-3).triangles(), 0u);
}

TEST(ShapeMesh, SameBytesForAnyNumberOfThreads) {
    const auto box = anatomy::make_box(Vec3(-0.011), Vec3(0.013));
    std::vector<Mesh> meshes;
    for (int threads : {1, 2, 4}) {
        const ThreadLimit limit(threads);
        meshes.push_back(mesh_of_shape(*box, kRoom, 0.8e-3));
        EXPECT_TRUE(check(meshes.back()).closed);
    }
    for (std::size_t k : {1u, 2u}) {
        EXPECT_EQ(meshes[k].index, meshes[0].index);
        EXPECT_EQ(std::memcmp(meshes[k].position_m.data(), meshes[0].position_m.data(),
                              meshes[0].position_m.size() * sizeof(Vec3f)),
                  0);
        EXPECT_EQ(
            std::memcmp(meshes[k].normal.data(), meshes[0].normal.data(), meshes[0].normal.size() * sizeof(Vec3f)), 0);
    }
}

}  // namespace calot::surface

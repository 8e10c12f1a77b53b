// The surface on a device beside the CPU's: field, marching cubes, compaction.

#include <algorithm>
#include <array>
#include <tuple>

#include "calot/base/random.h"
#include "calot/gpu/arrays.h"
#include "calot/gpu/surface.h"
#include "calot/validation/surface_bodies.h"
#include "gpu/rig.h"

namespace calot::gpu {
namespace {

// The field's sums are integers and agree exactly. A device may round roots and quotients otherwise than the CPU:
// places and normals agree to a few units in the last place of values of about 1 (spacings, unit vectors).
constexpr float kTolerance = 4e-6f;
constexpr float kTolerance_m = kTolerance * static_cast<float>(surface::kTestSpacing_m) + 4e-9f;  // + place's own ulp

struct Meshes {
    surface::Mesh cpu, gpu;
    std::vector<std::int64_t> cpu_owner, gpu_owner;
};

Meshes meshes_of(const std::shared_ptr<Device>& device, const surface::Body& body, Surface& on_gpu) {
    Meshes m;
    surface::Surface on_cpu(body.model);
    on_cpu.rebuild(body.model, body.state);
    m.cpu = on_cpu.rest_mesh();
    m.cpu_owner = on_cpu.owner();
    DeviceArray<std::uint32_t> present(*device, words_of(body.model.hexels.cells));
    present.upload(*device, words_of(body.state.hexel_present));
    on_gpu.rebuild(present);
    on_gpu.download(m.gpu, m.gpu_owner);
    return m;
}

/// Triangles by the places of their corners, in whatever order vertices come.
std::vector<std::array<float, 9>> triangle_set(const surface::Mesh& mesh) {
    std::vector<std::array<float, 9>> all;
    for (std::size_t t = 0; t < mesh.triangles(); ++t) {
        std::array<Vec3f, 3> p{};
        for (std::size_t k = 0; k < 3; ++k) p[k] = mesh.position_m[mesh.index[3 * t + k]];
        const auto less = [](const Vec3f& a, const Vec3f& b) {
            return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
        };
        std::rotate(p.begin(), std::min_element(p.begin(), p.end(), less), p.end());  // keeps its orientation
        std::array<float, 9> nine{};
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t c = 0; c < 3; ++c) nine[3 * k + c] = p[k][static_cast<int>(c)];
        all.push_back(nine);
    }
    std::sort(all.begin(), all.end());
    return all;
}

void expect_alike(const Meshes& m) {
    ASSERT_EQ(m.gpu.position_m.size(), m.cpu.position_m.size());
    ASSERT_EQ(m.gpu.triangles(), m.cpu.triangles());
    EXPECT_EQ(m.gpu.index, m.cpu.index) << "the same order, too";
    EXPECT_EQ(m.gpu_owner, m.cpu_owner);
    for (std::size_t v = 0; v < m.cpu.position_m.size(); ++v)
        for (int c = 0; c < 3; ++c) {
            ASSERT_NEAR(m.gpu.position_m[v][c], m.cpu.position_m[v][c], kTolerance_m) << v;
            ASSERT_NEAR(m.gpu.normal[v][c], m.cpu.normal[v][c], kTolerance) << v;
        }
    const surface::MeshCheck check = surface::check(m.gpu);
    EXPECT_TRUE(check.closed) << check.open_edges << " open, " << check.nonmanifold_edges << " non-manifold edges";
    EXPECT_NEAR(surface::volume_m3(m.gpu), surface::volume_m3(m.cpu),
                1e-5 * std::abs(surface::volume_m3(m.cpu)) + 1e-15);
}

void compare(const surface::Body& body) {
    const auto device = test_device();
    Surface on_gpu(device, body.model);
    expect_alike(meshes_of(device, body, on_gpu));
}

}  // namespace

TEST(GpuSurface, EqualsTheCpusOnManyShapes) {
    compare(surface::ball(24, 9.7));
    compare(surface::sheet(Int3(11, 20, 17)));
    compare(surface::checkerboard(9));
    compare(surface::Body(Int3(1), [](const Int3&) { return true; }));
    compare(surface::Body(Int3(40, 3, 9), [](const Int3&) { return true; }));  // touches every side of its lattice
    compare(surface::Body(Int3(6), [](const Int3&) { return false; }));
    for (const double share : {0.02, 0.3, 0.5, 0.9}) compare(surface::noise(Int3(19, 26, 13), share, 5));
}

// Lattices whose fastest axis is each in turn.
TEST(GpuSurface, WhateverAxisIsFastest) {
    for (const Int3& size : {Int3(7, 17, 30), Int3(30, 7, 17), Int3(17, 30, 7), Int3(30, 17, 7)})
        compare(surface::noise(size, 0.6, 3));
}

// Burning: the mesh grows beyond its first room, and shrinks to nothing.
TEST(GpuSurface, FollowsWhatBurns) {
    surface::Body body = surface::ball(22, 10.4);
    const auto device = test_device();
    Surface on_gpu(device, body.model);
    expect_alike(meshes_of(device, body, on_gpu));
    const std::int32_t first = on_gpu.vertices();
    Random random(8);
    std::vector<std::int64_t> left = body.hexels();
    surface::shuffle(left, random);
    std::int32_t most = 0;
    while (!left.empty()) {
        const std::size_t count = std::min<std::size_t>(left.size(), 500);
        for (std::size_t k = 0; k < count; ++k) {
            body.state.hexel_present.clear(left.back());
            left.pop_back();
        }
        expect_alike(meshes_of(device, body, on_gpu));
        if (testing::Test::HasFatalFailure()) return;
        most = std::max(most, on_gpu.vertices());
    }
    EXPECT_GT(most, 2 * first) << "it never had to make room";
    EXPECT_EQ(on_gpu.vertices(), 0);
}

// PoCL rounds as the CPU does: the same bytes.
TEST(GpuSurface, SameBytesWhereDivisionIsExact) {
    const auto device = test_device();
    if (device->info().is_gpu) GTEST_SKIP() << "a matter of the device";
    const surface::Body body = surface::noise(Int3(20, 20, 20), 0.6, 9);
    Surface on_gpu(device, body.model);
    const Meshes m = meshes_of(device, body, on_gpu);
    EXPECT_TRUE(m.gpu.position_m == m.cpu.position_m);
    EXPECT_TRUE(m.gpu.normal == m.cpu.normal);
    EXPECT_TRUE(triangle_set(m.gpu) == triangle_set(m.cpu));
}

}  // namespace calot::gpu

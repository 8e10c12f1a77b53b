// Meshes: sound ones exactly, damaged ones repaired or refused, never silently wrong.

#include "calot/anatomy/mesh_shape.h"

#include <gtest/gtest.h>

#include "calot/anatomy/mesh_check.h"
#include "calot/anatomy/mesh_tree.h"
#include "calot/base/error.h"
#include "calot/base/parallel.h"
#include "tests/anatomy/meshes.h"

namespace calot::anatomy {

using namespace testing;

namespace {

constexpr double kRadius = 0.01;
const Vec3 kCentre(0.002, -0.001, 0.0005);

Vec3 random_direction(Random& random) {
    for (;;) {
        const Vec3 v(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
        if (glm::length(v) > 0.1 && glm::length(v) < 1.0) return glm::normalize(v);
    }
}

/// Signs and distances are those of the sphere, within the faceting: 40 rings sag by r (1 - cos(pi / 80)) = 0.08 % of
/// r.
void expect_sphere(const Shape& shape, double tolerance = 0.002 * kRadius) {
    Random random(21);
    for (int k = 0; k < 300; ++k) {
        const double r = kRadius * random.uniform(0.3, 1.9);
        EXPECT_NEAR(shape.distance_m(kCentre + r * random_direction(random)), r - kRadius, tolerance);
    }
}

/// Lattice volume against a truth: 0.8 mm cells at a 1 cm sphere scatter by 0.5 %, faceting costs 0.2 %.
void expect_volume(const Shape& shape, double truth, double tolerance = 0.01) {
    EXPECT_NEAR(sampled_volume_m3(shape, 0.8e-3) / truth, 1.0, tolerance);
}

struct Loaded {
    MeshReport report;
    ShapePtr shape;
};
Loaded load(const TriangleMesh& mesh) {
    Loaded loaded;
    loaded.report.path = "test";
    loaded.shape = make_mesh_shape(mesh, loaded.report);
    return loaded;
}
std::string refusal(const TriangleMesh& mesh) {
    try {
        load(mesh);
    } catch (const InputError& error) {
        EXPECT_FALSE(error.hint.empty());
        return error.describe();
    }
    return "accepted";
}

}  // namespace

TEST(MeshShape, SoundSphereIsExact) {
    const Loaded sphere = load(sphere_mesh(kCentre, kRadius));
    EXPECT_TRUE(sphere.report.clean());
    EXPECT_EQ(sphere.report.components, 1);
    EXPECT_EQ(sphere.report.unclear_share, 0.0);
    EXPECT_NEAR(sphere.report.volume_m3 / sphere_volume(kRadius), 1.0, 0.003);  // faceting
    expect_sphere(*sphere.shape);
    expect_volume(*sphere.shape, sphere_volume(kRadius));
}

TEST(MeshShape, TriangleSoupIsWelded) {
    // Every triangle with corners of its own, as STL has them, a thousandth of a micrometre off.
    const TriangleMesh sound = sphere_mesh(kCentre, kRadius);
    Random random(4);
    TriangleMesh soup;
    for (const auto& t : sound.triangles) {
        const auto base = static_cast<std::int32_t>(soup.vertices_m.size());
        for (std::int32_t v : t) soup.vertices_m.push_back(sound.vertices_m[v] + 1e-9 * random_direction(random));
        soup.triangles.push_back({base, base + 1, base + 2});
    }
    const Loaded welded = load(soup);
    EXPECT_EQ(welded.report.open_edges, 0);
    EXPECT_EQ(welded.report.components, 1);
    EXPECT_GT(welded.report.welded_vertices, 0);
    expect_sphere(*welded.shape);
}

TEST(MeshShape, SmallHoleIsClosed) {
    // A cap of half angle 20 degrees: 3 % of the surface.
    const TriangleMesh holed = without(sphere_mesh(kCentre, kRadius), [](const Vec3& p) {
        return (p - kCentre).z > std::cos(20 * kPi / 180) * kRadius;
    });
    const Loaded sphere = load(holed);
    EXPECT_GT(sphere.report.open_edges, 10);
    EXPECT_FALSE(sphere.report.clean());
    EXPECT_GT(sphere.report.unclear_share, 0.0);
    // At worst the lid is flat: the cap missing takes 1 % of the volume.
    expect_volume(*sphere.shape, sphere_volume(kRadius), 0.02);
    EXPECT_NEAR(sphere.report.volume_m3 / sphere_volume(kRadius), 1.0,
                0.04);  // of 64000 random points, a quarter in the cap's cells
}

TEST(MeshShape, ScatteredHolesAreClosed) {
    Random random(5);
    const Loaded sphere =
        load(without(sphere_mesh(kCentre, kRadius), [&](const Vec3&) { return random.uniform() < 0.05; }));
    EXPECT_GT(sphere.report.open_edges, 100);
    expect_volume(*sphere.shape, sphere_volume(kRadius), 0.02);
}

TEST(MeshShape, FlippedFacesAreTurned) {
    TriangleMesh mesh = sphere_mesh(kCentre, kRadius);
    Random random(6);
    int flipped = 0;
    for (auto& t : mesh.triangles)
        if (random.uniform() < 0.3) {
            std::swap(t[1], t[2]);
            ++flipped;
        }
    const Loaded sphere = load(mesh);
    EXPECT_EQ(sphere.report.turned_triangles, flipped);
    EXPECT_GT(sphere.report.flipped_edges, 0);
    expect_sphere(*sphere.shape);
    expect_volume(*sphere.shape, sphere_volume(kRadius));
}

TEST(MeshShape, InvertedMeshIsTurned) {
    const Loaded sphere = load(turned(sphere_mesh(kCentre, kRadius)));
    EXPECT_EQ(sphere.report.turned_components, 1);
    EXPECT_FALSE(sphere.report.clean());
    EXPECT_GT(sphere.report.volume_m3, 0.0);
    expect_sphere(*sphere.shape);
}

TEST(MeshShape, OneInvertedComponentIsTurned) {
    const Loaded two =
        load(merged(sphere_mesh(kCentre, kRadius), turned(sphere_mesh(kCentre + Vec3(0.03, 0, 0), 0.005))));
    EXPECT_EQ(two.report.components, 2);
    EXPECT_EQ(two.report.turned_components, 1);
    expect_volume(*two.shape, sphere_volume(kRadius) + sphere_volume(0.005));
}

TEST(MeshShape, CavityStaysEmpty) {
    const Loaded hollow = load(merged(sphere_mesh(kCentre, kRadius), turned(sphere_mesh(kCentre, 0.006))));
    EXPECT_EQ(hollow.report.turned_components, 0);
    EXPECT_GT(hollow.shape->distance_m(kCentre), 0.0);
    EXPECT_LT(hollow.shape->distance_m(kCentre + Vec3(0.008, 0, 0)), 0.0);
    expect_volume(*hollow.shape, sphere_volume(kRadius) - sphere_volume(0.006));
    // The whole inside out is the same solid.
    const Loaded inverted = load(turned(merged(sphere_mesh(kCentre, kRadius), turned(sphere_mesh(kCentre, 0.006)))));
    EXPECT_EQ(inverted.report.turned_components, 2);
    expect_volume(*inverted.shape, sphere_volume(kRadius) - sphere_volume(0.006));
}

TEST(MeshShape, DuplicateShellsCountOnce) {
    const TriangleMesh sphere = sphere_mesh(kCentre, kRadius);
    for (const TriangleMesh& second : {sphere, turned(sphere)}) {
        const Loaded doubled = load(merged(sphere, second));
        EXPECT_EQ(doubled.report.duplicate_triangles, static_cast<std::int64_t>(sphere.triangles.size()));
        expect_sphere(*doubled.shape);
    }
}

TEST(MeshShape, CrossingSpheresAreOneSolid) {
    const Loaded both =
        load(merged(sphere_mesh(kCentre, kRadius), sphere_mesh(kCentre + Vec3(kRadius, 0, 0), kRadius)));
    EXPECT_GT(both.report.self_intersections, 20);
    EXPECT_FALSE(both.report.clean());
    // The lens of two spheres at distance r: V = pi (4r + d)(2r - d)^2 / 12 = 5/12 pi r^3.
    const double truth = 2.0 * sphere_volume(kRadius) - 5.0 / 12.0 * kPi * kRadius * kRadius * kRadius;
    expect_volume(*both.shape, truth);
    EXPECT_NEAR(both.report.volume_m3 / truth, 1.0, 0.04);
}

TEST(MeshShape, DegenerateTrianglesAreLeftOut) {
    TriangleMesh mesh = sphere_mesh(kCentre, kRadius);
    mesh.triangles.push_back({3, 3, 4});
    mesh.triangles.push_back({5, 6, 5});
    const Loaded sphere = load(mesh);
    EXPECT_EQ(sphere.report.degenerate_triangles, 2);
    expect_sphere(*sphere.shape);
}

TEST(MeshShape, RefusesWhatIsNotClear) {
    // Half of a sphere: where its flat side would be is anybody's guess.
    const std::string half =
        refusal(without(sphere_mesh(kCentre, kRadius), [](const Vec3& p) { return p.z > kCentre.z; }));
    EXPECT_NE(half.find("cannot be told apart"), std::string::npos) << half;
    EXPECT_NE(half.find("open edges"), std::string::npos) << half;
    EXPECT_NE(half.find("worst at ("), std::string::npos) << half;
    Random random(8);
    EXPECT_NE(refusal(without(sphere_mesh(kCentre, kRadius), [&](const Vec3&) { return random.uniform() < 0.3; }))
                  .find("cannot be told apart"),
              std::string::npos);
    // One sheet.
    const TriangleMesh sheet{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)}, {{0, 1, 2}, {0, 2, 3}}};
    EXPECT_NE(refusal(sheet).find("cannot be told apart"), std::string::npos);
    // Flat but closed.
    TriangleMesh flat = sphere_mesh(Vec3(0.0), kRadius);
    for (Vec3& p : flat.vertices_m) p.z *= 1e-12;
    EXPECT_NE(refusal(flat).find("no volume"), std::string::npos);
}

TEST(MeshShape, RefusesBrokenNumbers) {
    EXPECT_NE(refusal({}).find("no triangles"), std::string::npos);
    for (const double bad : {std::nan(""), HUGE_VAL, 1e30}) {
        TriangleMesh mesh = sphere_mesh(kCentre, kRadius);
        mesh.vertices_m[7].y = bad;
        const std::string text = refusal(mesh);
        EXPECT_NE(text.find("1 of "), std::string::npos) << text;
        EXPECT_NE(text.find("vertex 7"), std::string::npos) << text;
    }
    EXPECT_NE(refusal({{Vec3(0), Vec3(1), Vec3(2)}, {{0, 0, 1}}}).find("degenerate"), std::string::npos);
}

TEST(MeshShape, TanglesAreRefusedInLittleTime) {
    Random random(10);
    auto corner = [&] { return Vec3(random.uniform(), random.uniform(), random.uniform()); };
    // Loose triangles, small ones.
    TriangleMesh soup;
    for (int k = 0; k < 3000; ++k) {
        const Vec3 at = corner();
        for (int v = 0; v < 3; ++v) soup.vertices_m.push_back(at + 0.01 * corner());
        soup.triangles.push_back({3 * k, 3 * k + 1, 3 * k + 2});
    }
    EXPECT_NE(refusal(soup).find("do not hang together"), std::string::npos) << refusal(soup);
    // A closed mesh whose vertices are anywhere: every triangle crosses a good share of all others.
    TriangleMesh tangle = sphere_mesh(Vec3(0.0), 1.0, 40);
    for (Vec3& p : tangle.vertices_m) p = corner();
    EXPECT_NE(refusal(tangle).find("tangled"), std::string::npos) << refusal(tangle);
}

TEST(MeshShape, SameForAnyNumberOfThreads) {
    auto text = [] {
        const Loaded both =
            load(merged(sphere_mesh(kCentre, kRadius, 60), sphere_mesh(kCentre + Vec3(kRadius, 0, 0), kRadius, 60)));
        std::string all;
        for (const std::string& note : both.report.notes) all += note + "\n";
        append(all, both.report.volume_m3);
        for (const MeshFaultPlace& place : both.report.places) append(all, place.position_m);
        return all;
    };
    const std::string many = text();
    const ThreadLimit one(1);
    EXPECT_EQ(text(), many);
}

TEST(MeshTree, FindsTheNearestTriangle) {
    const auto mesh = std::make_shared<const TriangleMesh>(sphere_mesh(kCentre, kRadius, 12));
    const MeshTree tree(mesh);
    Random random(12);
    for (int k = 0; k < 200; ++k) {
        const Vec3 p = kCentre + kRadius * random.uniform(0.0, 3.0) * random_direction(random);
        double best = 1e9;
        for (const auto& t : mesh->triangles) {  // a tree of one triangle is the plain distance
            const auto one = std::make_shared<const TriangleMesh>(
                TriangleMesh{{mesh->vertices_m[t[0]], mesh->vertices_m[t[1]], mesh->vertices_m[t[2]]}, {{0, 1, 2}}});
            best = std::min(best, MeshTree(one).nearest(p).distance_m);
        }
        EXPECT_DOUBLE_EQ(tree.nearest(p).distance_m, best);
    }
}

TEST(MeshTree, WindingNumberIsWhole) {
    const MeshTree tree(std::make_shared<const TriangleMesh>(sphere_mesh(kCentre, kRadius)));
    Random random(13);
    for (int k = 0; k < 500; ++k) {
        const double r = random.uniform(0.0, 0.995);
        // Groups at 2.2 radii stand for their triangles; what second moments would add is left out.
        EXPECT_NEAR(tree.winding(kCentre + r * kRadius * random_direction(random)), 1.0, 0.06);
        EXPECT_NEAR(tree.winding(kCentre + (1.0 + 3.0 * r) * (kRadius + 1e-5) * random_direction(random)), 0.0, 0.06);
    }
}

TEST(MeshCheck, TrianglesCross) {
    const std::array<Vec3, 3> floor{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
    EXPECT_TRUE(triangles_cross(floor, {Vec3(0.2, 0.2, -1), Vec3(0.2, 0.2, 1), Vec3(2, 2, 1)}));
    EXPECT_FALSE(triangles_cross(floor, {Vec3(0.2, 0.2, 0.1), Vec3(0.2, 0.2, 1), Vec3(2, 2, 1)}));
    EXPECT_FALSE(triangles_cross(floor, {Vec3(0.2, 0.2, 0), Vec3(0.2, 0.2, 1), Vec3(2, 2, 1)}));      // touches
    EXPECT_FALSE(triangles_cross(floor, {Vec3(0.9, 0.9, -1), Vec3(0.9, 0.9, 1), Vec3(2, 2, 1)}));     // beside
    EXPECT_FALSE(triangles_cross(floor, {Vec3(0, 0, 1e-3), Vec3(1, 0, 1e-3), Vec3(0, 1, 1e-3)}));     // above
    EXPECT_FALSE(triangles_cross(floor, {Vec3(0.5, 0.5, 0), Vec3(0.5, 0.5, 0), Vec3(0.5, 0.5, 0)}));  // a point
}

}  // namespace calot::anatomy

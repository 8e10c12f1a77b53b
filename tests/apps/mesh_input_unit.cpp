// Scenes from meshes: what comes out of good ones, what is said about bad ones.

#include <gtest/gtest.h>

#include <functional>
#include <nlohmann/json.hpp>

#include "anatomy/meshes.h"
#include "apps/program.h"

namespace calot::test {
namespace {

using namespace anatomy::testing;
using anatomy::TriangleMesh;

/// A ball of 4 mm radius [mm].
TriangleMesh ball() {
    return sphere_mesh(Vec3(0.0), 4.0, 12);
}
TriangleMesh half_ball() {
    return without(ball(), [](const Vec3& p) { return p.z > 0.0; });
}

std::string scene_of(const std::string& mesh, const std::string& more = "") {
    return "anatomy.kind = \"meshes\"\nsampling.hexel_spacing_mm = 0.4\nrun.duration_s = 0.01\n[[mesh]]\nfile = \"" +
           mesh + "\"\n" + more;
}

TEST(Meshes, ABallHasItsVolume) {
    const Folder folder("ball");
    folder.write("ball.stl", binary_stl(ball()));
    folder.write("ball.obj", obj(ball()));
    for (const char* file : {"ball.stl", "ball.obj"}) {
        const Outcome outcome = run({"inspect", folder.write("scene.toml", scene_of(file)), "--json"});
        ASSERT_EQ(outcome.code, 0) << outcome.output;
        const auto j = nlohmann::json::parse(outcome.output);
        // A ball of 12 rings lacks 3 % of its volume; hexels add or take 1 % at this size.
        constexpr double kFacets = 0.04, kHexels = 0.01;
        const double polyhedron_m3 = j["facts"]["ball_volume_ml"].get<double>() * 1e-6;
        EXPECT_NEAR(polyhedron_m3 / sphere_volume(4e-3), 1.0, kFacets);
        EXPECT_NEAR(j["volume_m3"].get<double>() / polyhedron_m3, 1.0, kHexels);
        EXPECT_TRUE(j["landmarks_m"].contains("ball"));
        EXPECT_NEAR(j["landmarks_m"]["top"][2].get<double>(), 4e-3, 0.2e-3);
    }
}

TEST(Meshes, UnitAndPlaceAreTaken) {
    const Folder folder("placed");
    folder.write("ball.stl", binary_stl(ball()));
    const Outcome outcome =
        run({"inspect", folder.write("scene.toml", scene_of("ball.stl", "unit_mm = 2\ntranslation_mm = [10, 0, 5]\n")),
             "--json"});
    ASSERT_EQ(outcome.code, 0) << outcome.output;
    const auto j = nlohmann::json::parse(outcome.output);
    EXPECT_NEAR(j["volume_m3"].get<double>() / sphere_volume(8e-3), 1.0, 0.04);  // facets, as above
    EXPECT_NEAR(j["landmarks_m"]["centre"][0].get<double>(), 10e-3, 1e-6);
}

TEST(Meshes, ATurnedBallIsMendedAndSaidSo) {
    const Folder folder("turned");
    folder.write("ball.stl", binary_stl(turned(ball())));
    const Outcome outcome = run({"inspect", folder.write("scene.toml", scene_of("ball.stl"))});
    EXPECT_EQ(outcome.code, 0) << outcome.output;
    EXPECT_NE(outcome.output.find("calot: note: "), std::string::npos) << outcome.output;
}

TEST(Meshes, RunRecordAndReplay) {
    const Folder folder("mesh_run");
    folder.write("ball.stl", binary_stl(ball()));
    folder.write("plate.obj", obj(ball()));
    const std::string scene =
        folder.write("scene.toml", scene_of("ball.stl") +
                                       "[[mesh]]\nfile = \"plate.obj\"\nrole = \"organ\"\nmaterial = \"liver\"\n"
                                       "translation_mm = [0, 0, -6]\n[[script.key]]\nt = 0\nat = \"top\"\n"
                                       "offset_mm = [0, 0, 1]\n[[script.key]]\nt = 0.01\nat = \"top\"\n");
    const Outcome outcome = run({"simulate", scene, "--out", folder / "out", "--frames", "none", "--progress", "none"});
    ASSERT_EQ(outcome.code, 0) << outcome.output;
    const std::string recording = folder / "out/recording.calot";
    EXPECT_EQ(run({"replay", recording, "--verify"}).code, 0);
    // The recording knows the mesh that it was made with.
    folder.write("ball.stl", binary_stl(sphere_mesh(Vec3(0.0), 4.1, 12)));
    const Outcome changed = run({"replay", recording, "--verify"});
    EXPECT_EQ(changed.code, 2);
    EXPECT_NE(changed.output.find("is not the one that this scene was made with"), std::string::npos) << changed.output;
}

TEST(Meshes, FaultsOfARefusedOneAreDrawn) {
    const Folder folder("faults");
    folder.write("half.stl", binary_stl(half_ball()));
    const Outcome outcome = run({"inspect", folder.write("scene.toml", scene_of("half.stl"))}, folder.path().string());
    EXPECT_EQ(outcome.code, 2);
    EXPECT_NE(outcome.output.find("half-faults.png shows where"), std::string::npos) << outcome.output;
    EXPECT_EQ(read_file(folder / "half-faults.png").substr(1, 3), "PNG");
}

struct BadMesh {
    const char* name;
    const char* file;
    std::function<std::string()> bytes;
    const char* says;
};

const std::vector<BadMesh> kBadMeshes{
    {"missing", "", [] { return std::string(); }, "does not exist"},
    {"empty", "a.stl", [] { return std::string(); }, "is empty"},
    {"other_format", "a.jpg", [] { return std::string("no mesh"); }, "is not a mesh format"},
    {"no_faces", "a.obj", [] { return std::string("v 0 0 0\nv 1 0 0\nv 0 1 0\n"); }, "no triangles"},
    {"not_numbers", "a.obj", [] { return std::string("v a b c\n"); }, "a vertex needs three numbers"},
    {"missing_vertex", "a.obj", [] { return std::string("v 0 0 0\nf 1 2 3\n"); }, "does not exist"},
    {"nan", "a.obj",
     [] { return std::string("v nan 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 3 4\nf 1 4 2\nf 2 4 3\n"); }, "a.obj"},
    {"cut_off_stl", "a.stl", [] { return binary_stl(ball()).substr(0, 2000); }, "a.stl"},
    {"cut_off_ply", "a.ply", [] { return ascii_ply(ball()).substr(0, 2000); }, "damaged or cut off"},
    {"claims_a_billion", "a.stl",
     [] {
         std::string bytes(80, ' ');
         append(bytes, std::uint32_t{1'000'000'000});
         return bytes + std::string(100, 'x');
     },
     "a.stl"},
    {"half_open", "a.stl", [] { return binary_stl(half_ball()); }, "open edges"},
    {"flat_sheet", "a.obj", [] { return std::string("v 0 0 0\nv 5 0 0\nv 5 5 0\nv 0 5 0\nf 1 2 3\nf 1 3 4\n"); },
     "a.obj"},
    {"collapsed", "a.obj", [] { return std::string("v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\n"); }, "degenerate"},
    {"metres_for_millimetres", "a.stl", [] { return binary_stl(sphere_mesh(Vec3(0.0), 0.004, 12)); }, "check unit_mm"},
    {"a_giant", "a.stl", [] { return binary_stl(sphere_mesh(Vec3(0.0), 4000.0, 12)); }, "check unit_mm"},
};

class BadMeshInput : public ::testing::TestWithParam<BadMesh> {};

TEST_P(BadMeshInput, IsRefused) {
    const BadMesh& bad = GetParam();
    const Folder folder(std::string("mesh_") + bad.name);
    if (*bad.file) folder.write(bad.file, bad.bytes());
    const std::string scene = folder.write("scene.toml", scene_of(*bad.file ? bad.file : "gone.stl"));
    const Outcome outcome =
        run({"simulate", scene, "--out", folder / "out", "--frames", "none"}, folder.path().string());
    EXPECT_EQ(outcome.code, 2) << outcome.output;
    EXPECT_NE(outcome.output.find(bad.says), std::string::npos) << outcome.output;
    EXPECT_NE(outcome.output.find("scene.toml"), std::string::npos) << outcome.output;
    EXPECT_FALSE(std::filesystem::exists(folder / "out"));
}

std::string name_of(const ::testing::TestParamInfo<BadMesh>& info) {
    return info.param.name;
}
INSTANTIATE_TEST_SUITE_P(Table, BadMeshInput, ::testing::ValuesIn(kBadMeshes), name_of);

TEST(Meshes, ThinnerThanAHexelIsRefused) {
    const Folder folder("thin");
    TriangleMesh plate = ball();
    for (Vec3& v : plate.vertices_m) v.z *= 0.002;
    folder.write("plate.stl", binary_stl(plate));
    const Outcome outcome =
        run({"inspect", folder.write("scene.toml", scene_of("plate.stl", "translation_mm = [0, 0, 0.2]\n"))});
    EXPECT_EQ(outcome.code, 2) << outcome.output;
}

}  // namespace
}  // namespace calot::test

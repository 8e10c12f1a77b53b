// Files of others: all formats give the same solid; what is no mesh is refused with a reason.

#include <gtest/gtest.h>

#include "calot/anatomy/mesh_shape.h"
#include "calot/base/error.h"
#include "tests/anatomy/meshes.h"

namespace calot::anatomy {

using namespace testing;

namespace {

/// In the file's unit.
const TriangleMesh& sphere() {
    static const TriangleMesh mesh = sphere_mesh(Vec3(0.0), 10.0, 24);
    return mesh;
}

std::string refusal(const std::string& path) {
    try {
        load_mesh({.path = path});
    } catch (const InputError& error) {
        EXPECT_EQ(error.file, path);
        EXPECT_FALSE(error.hint.empty());
        return error.describe();
    }
    return "accepted";
}

}  // namespace

TEST(MeshFile, AllFormatsGiveTheSameSolid) {
    const Folder folder;
    std::string buffer;
    write_text(folder / "a.stl", binary_stl(sphere()));
    write_text(folder / "a.OBJ", obj(sphere()));
    write_text(folder / "a.ply", ascii_ply(sphere()));
    write_text(folder / "a.gltf", gltf(sphere(), "a.bin", buffer));
    write_text(folder / "a.bin", buffer);
    for (const char* name : {"a.stl", "a.OBJ", "a.ply", "a.gltf"}) {
        SCOPED_TRACE(name);
        MeshReport report;
        const ShapePtr shape = load_mesh({.path = folder / name}, &report);
        EXPECT_TRUE(report.clean()) << (report.notes.empty() ? "" : report.notes[0]);
        EXPECT_EQ(report.triangles, static_cast<std::int64_t>(sphere().triangles.size()));
        EXPECT_EQ(report.vertices, static_cast<std::int64_t>(sphere().vertices_m.size()));
        const Vec3 centre(name == std::string("a.gltf") ? 0.1e-3 : 0.0, 0.0, 0.0);
        EXPECT_NEAR(shape->distance_m(centre), -0.01, 5e-5);
        EXPECT_NEAR(report.volume_m3 / sphere_volume(0.01), 1.0, 0.01);
    }
}

TEST(MeshFile, IsPlacedAsAsked) {
    const Folder folder;
    TriangleMesh box = sphere_mesh(Vec3(0.0), 1.0, 16);
    for (Vec3& p : box.vertices_m) p *= Vec3(3, 2, 1);
    write_text(folder / "a.obj", obj(box));
    // A quarter turn about x, then about z: x -> y, y -> z -> z, z -> -y -> x.
    const ShapePtr shape = load_mesh({.path = folder / "a.obj",
                                      .unit_m = 0.01,
                                      .scale = 2.0,
                                      .rotation_rad = Vec3(kPi / 2, 0, kPi / 2),
                                      .translation_m = Vec3(1, 2, 3)});
    const Vec3 half = 0.5 * (shape->bounds_m().high - shape->bounds_m().low),
               middle = 0.5 * (shape->bounds_m().high + shape->bounds_m().low);
    EXPECT_NEAR(glm::length(middle - Vec3(1, 2, 3)), 0.0, 1e-6);
    EXPECT_NEAR(glm::length(half - 0.02 * Vec3(1, 3, 2)), 0.0, 1e-6);
    EXPECT_THROW(load_mesh({.path = folder / "a.obj", .unit_m = 0.0}), InputError);
}

TEST(MeshFile, RefusesWhatIsNoMesh) {
    const Folder folder;
    EXPECT_NE(refusal(folder / "missing.stl").find("does not exist"), std::string::npos);
    EXPECT_NE(refusal(folder / ".").find("not a file"), std::string::npos);
    write_text(folder / "empty.stl", "");
    EXPECT_NE(refusal(folder / "empty.stl").find("empty"), std::string::npos);
    write_text(folder / "a.jpg", "no mesh");
    EXPECT_NE(refusal(folder / "a.jpg").find("not a mesh format"), std::string::npos);
    write_text(folder / "points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n");
    EXPECT_NE(refusal(folder / "points.obj"), "accepted");
    write_text(folder / "nan.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 3 4\nf 1 4 2\nf 2 4 3\n");
    EXPECT_NE(refusal(folder / "nan.obj"), "accepted");
    // A header that promises four thousand million vertices must not cost memory.
    write_text(folder / "bomb.ply",
               "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty float x\nproperty float y\n"
               "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\nxxxx");
    EXPECT_NE(refusal(folder / "bomb.ply").find("promises more"), std::string::npos);
    write_text(folder / "concave.obj", "v 0 0 0\nv 2 0 0\nv 0.5 0.5 0\nv 0 2 0\nf 1 2 4\nf 2 3 4 1\nf 2 3 \\\n 4\n");
    EXPECT_NE(refusal(folder / "concave.obj").find(":6: a face is a concave polygon"), std::string::npos)
        << refusal(folder / "concave.obj");
    write_text(folder / "index.obj", "v 0 0 0\nv 2 0 0\nv 0.5 0.5 0\nf 1 2 4\n");
    EXPECT_NE(refusal(folder / "index.obj").find(":4: vertex 4"), std::string::npos);
    std::string stl(80, ' ');
    append(stl, std::uint32_t{0xffffffff});
    write_text(folder / "bomb.stl", stl + std::string(200, 'x'));
    EXPECT_NE(refusal(folder / "bomb.stl"), "accepted");
}

TEST(MeshFile, DamagedFilesNeverCrash) {
    const Folder folder;
    std::string buffer;
    const TriangleMesh small = sphere_mesh(Vec3(0.0), 10.0, 5);
    const std::string scene = gltf(small, "good.bin", buffer);
    write_text(folder / "good.bin", buffer);
    const std::pair<const char*, std::string> files[] = {
        {"a.stl", binary_stl(small)}, {"a.obj", obj(small)}, {"a.ply", ascii_ply(small)}, {"a.gltf", scene}};
    Random random(31);
    int accepted = 0, refused = 0;
    for (const auto& [name, good] : files)
        for (int round = 0; round < 36; ++round) {
            std::string bad = good;
            if (round % 3 == 0)
                bad.resize(static_cast<std::size_t>(random.uniform() * static_cast<double>(bad.size())) + 1);
            for (int k = 0; k < 1 + round / 3; ++k)
                bad[static_cast<std::size_t>(random.uniform() * static_cast<double>(bad.size()))] =
                    static_cast<char>(random.next() & 255);
            write_text(folder / name, bad);
            try {
                const ShapePtr shape = load_mesh({.path = folder / name});
                EXPECT_TRUE(std::isfinite(shape->distance_m(Vec3(0.0))));
                ++accepted;
            } catch (const InputError& error) {
                EXPECT_FALSE(error.describe().empty());
                ++refused;
            }
        }
    EXPECT_GT(accepted, 0);
    EXPECT_GT(refused, 30);
}

TEST(MeshFile, PictureShowsTheFaults) {
    const Folder folder;
    const TriangleMesh half = without(sphere(), [](const Vec3& p) { return p.x > 0.0; });
    write_text(folder / "half.obj", obj(half));
    MeshReport report;
    EXPECT_THROW(load_mesh({.path = folder / "half.obj"}, &report), InputError);
    EXPECT_GT(report.places.size(), 50u);
    write_fault_picture(folder / "half.png", report);
    std::ifstream file(folder / "half.png", std::ios::binary);
    std::string signature(8, ' ');
    file.read(signature.data(), 8);
    EXPECT_EQ(signature, std::string("\x89PNG\r\n\x1a\n", 8));
    EXPECT_FALSE(std::filesystem::exists(folder / "half.png.part"));
    EXPECT_THROW(write_fault_picture(folder / "no/such/folder/half.png", report), InputError);
    EXPECT_THROW(write_fault_picture(folder / "none.png", MeshReport{}), InputError);
}

}  // namespace calot::anatomy

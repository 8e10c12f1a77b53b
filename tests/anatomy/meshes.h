#pragma once
// Meshes made, damaged and written for tests.

#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>

#include <unistd.h>

#include "calot/anatomy/mesh_shape.h"
#include "calot/base/random.h"

namespace calot::anatomy::testing {

constexpr double kPi = 3.14159265358979323846;

/// A closed sphere of `rings` by 2 rings facets, wound outwards.
inline TriangleMesh sphere_mesh(const Vec3& centre, double radius, int rings = 40) {
    TriangleMesh mesh;
    const int columns = 2 * rings;
    mesh.vertices_m.push_back(centre + Vec3(0, 0, radius));
    for (int i = 1; i < rings; ++i)
        for (int k = 0; k < columns; ++k) {
            const double theta = kPi * i / rings, phi = 2.0 * kPi * k / columns;
            mesh.vertices_m.push_back(centre + radius * Vec3(std::sin(theta) * std::cos(phi),
                                                             std::sin(theta) * std::sin(phi), std::cos(theta)));
        }
    mesh.vertices_m.push_back(centre - Vec3(0, 0, radius));
    const int last = static_cast<int>(mesh.vertices_m.size()) - 1;
    auto at = [&](int i, int k) { return 1 + (i - 1) * columns + k % columns; };
    for (int k = 0; k < columns; ++k) {
        mesh.triangles.push_back({0, at(1, k), at(1, k + 1)});
        mesh.triangles.push_back({last, at(rings - 1, k + 1), at(rings - 1, k)});
        for (int i = 1; i + 1 < rings; ++i) {
            mesh.triangles.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1)});
            mesh.triangles.push_back({at(i, k), at(i + 1, k + 1), at(i, k + 1)});
        }
    }
    return mesh;
}

/// Both meshes in one.
inline TriangleMesh merged(TriangleMesh a, const TriangleMesh& b) {
    const auto base = static_cast<std::int32_t>(a.vertices_m.size());
    a.vertices_m.insert(a.vertices_m.end(), b.vertices_m.begin(), b.vertices_m.end());
    for (const auto& t : b.triangles) a.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
    return a;
}

inline TriangleMesh turned(TriangleMesh mesh) {
    for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
    return mesh;
}

/// Without the triangles whose centroid `gone` holds for.
template <class Gone>
TriangleMesh without(TriangleMesh mesh, const Gone& gone) {
    std::size_t kept = 0;
    for (const auto& t : mesh.triangles) {
        const Vec3 centroid = (mesh.vertices_m[t[0]] + mesh.vertices_m[t[1]] + mesh.vertices_m[t[2]]) / 3.0;
        if (!gone(centroid)) mesh.triangles[kept++] = t;
    }
    mesh.triangles.resize(kept);
    return mesh;
}

/// Volume of the cells of a lattice whose centres are inside.
inline double sampled_volume_m3(const Shape& shape, double spacing) {
    const Box box = shape.bounds_m();
    std::int64_t inside = 0;
    for (double z = box.low.z + 0.37 * spacing; z < box.high.z; z += spacing)
        for (double y = box.low.y + 0.41 * spacing; y < box.high.y; y += spacing)
            for (double x = box.low.x + 0.53 * spacing; x < box.high.x; x += spacing)
                inside += shape.distance_m(Vec3(x, y, z)) < 0.0;
    return static_cast<double>(inside) * spacing * spacing * spacing;
}

inline double sphere_volume(double radius) {
    return 4.0 / 3.0 * kPi * radius * radius * radius;
}

/// A folder of its own, removed at the end.
class Folder {
  public:
    Folder() {
        static int number = 0;
        path_ = std::filesystem::temp_directory_path() /
                ("calot_mesh_" + std::to_string(::getpid()) + "_" + std::to_string(number++));
        std::filesystem::create_directories(path_);
    }
    ~Folder() { std::filesystem::remove_all(path_); }
    std::string operator/(const std::string& name) const { return (path_ / name).string(); }

  private:
    std::filesystem::path path_;
};

inline void write_text(const std::string& path, const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
}

template <class T>
void append(std::string& bytes, const T& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof(T));
}

inline std::string binary_stl(const TriangleMesh& mesh) {
    std::string bytes(80, ' ');
    append(bytes, static_cast<std::uint32_t>(mesh.triangles.size()));
    for (const auto& t : mesh.triangles) {
        append(bytes, Vec3f(0.0f));
        for (std::int32_t v : t) append(bytes, Vec3f(mesh.vertices_m[v]));
        append(bytes, std::uint16_t{0});
    }
    return bytes;
}

inline std::string number(double value) {
    char text[40];
    std::snprintf(text, sizeof(text), "%.9g", value);
    return text;
}

inline std::string obj(const TriangleMesh& mesh) {
    std::string text = "# test\n";
    for (const Vec3& p : mesh.vertices_m) text += "v " + number(p.x) + " " + number(p.y) + " " + number(p.z) + "\n";
    for (const auto& t : mesh.triangles)
        text +=
            "f " + std::to_string(t[0] + 1) + " " + std::to_string(t[1] + 1) + " " + std::to_string(t[2] + 1) + "\n";
    return text;
}

inline std::string ascii_ply(const TriangleMesh& mesh) {
    std::string text = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(mesh.vertices_m.size()) +
                       "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
                       std::to_string(mesh.triangles.size()) + "\nproperty list uchar int vertex_indices\nend_header\n";
    for (const Vec3& p : mesh.vertices_m) text += number(p.x) + " " + number(p.y) + " " + number(p.z) + "\n";
    for (const auto& t : mesh.triangles)
        text += "3 " + std::to_string(t[0]) + " " + std::to_string(t[1]) + " " + std::to_string(t[2]) + "\n";
    return text;
}

/// glTF with one node that moves its mesh by (0.1, 0, 0) of its units; the buffer beside it in `buffer_name`.
inline std::string gltf(const TriangleMesh& mesh, const std::string& buffer_name, std::string& buffer) {
    buffer.clear();
    for (const Vec3& p : mesh.vertices_m) append(buffer, Vec3f(p));
    const std::size_t positions = buffer.size();
    for (const auto& t : mesh.triangles)
        for (std::int32_t v : t) append(buffer, static_cast<std::uint32_t>(v));
    auto text = [](std::size_t n) { return std::to_string(n); };
    return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"translation":[0.1,0,0]}],)"
           R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],"buffers":[{"uri":")" +
           buffer_name + R"(","byteLength":)" + text(buffer.size()) +
           R"(}],"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":)" + text(positions) +
           R"(},{"buffer":0,"byteOffset":)" + text(positions) + R"(,"byteLength":)" + text(buffer.size() - positions) +
           R"(}],"accessors":[{"bufferView":0,"componentType":5126,"count":)" + text(mesh.vertices_m.size()) +
           R"(,"type":"VEC3","min":[-1,-1,-1],"max":[1,1,1]},{"bufferView":1,"componentType":5125,"count":)" +
           text(3 * mesh.triangles.size()) + R"(,"type":"SCALAR"}]})";
}

}  // namespace calot::anatomy::testing

// Triangles out of a file: STL and glTF through assimp, OBJ and PLY through readers of our own (mesh_text.h).

#include <fmt/format.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include "calot/anatomy/mesh_shape.h"
#include "calot/anatomy/mesh_text.h"
#include "calot/base/error.h"

namespace calot::anatomy {

namespace {

constexpr std::int64_t kMostTriangles = 50'000'000;
constexpr std::uintmax_t kMostBytes = std::uintmax_t{4} << 30;

std::string extension_of(const std::string& path) {
    std::string extension = std::filesystem::path(path).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
    return extension;
}

void check_file(const std::string& path) {
    std::error_code error;
    const auto status = std::filesystem::status(path, error);
    if (error || !std::filesystem::exists(status))
        throw InputError(path, 0, 0, "the mesh file does not exist", "paths are relative to the scene file");
    if (!std::filesystem::is_regular_file(status))
        throw InputError(path, 0, 0, "the mesh is not a file", "give the path of an STL, OBJ, PLY or glTF file");
    const std::uintmax_t bytes = std::filesystem::file_size(path, error);
    if (error || !std::ifstream(path, std::ios::binary))
        throw InputError(path, 0, 0, "the mesh file cannot be read", "check its permissions");
    if (bytes == 0) throw InputError(path, 0, 0, "the mesh file is empty", "export it again");
    if (bytes > kMostBytes) throw InputError(path, 0, 0, "the mesh file is larger than 4 GiB", "reduce the mesh first");
    const std::string extension = extension_of(path);
    for (const char* known : {".stl", ".obj", ".ply", ".gltf", ".glb"})
        if (extension == known) return;
    throw InputError(path, 0, 0, "'" + extension + "' is not a mesh format that is read here",
                     "convert it to STL, OBJ, PLY or glTF");
}

[[noreturn]] void refuse_size(const std::string& path) {
    throw InputError(path, 0, 0, fmt::format("the mesh has more than {} million triangles", kMostTriangles / 1'000'000),
                     "reduce the mesh first");
}

/// Adds the meshes of a node and of all below it.
void add_node(const aiScene& scene, const aiNode& node, const aiMatrix4x4& above, int depth, TriangleMesh& mesh,
              const std::string& path) {
    if (depth > 256)
        throw InputError(path, 0, 0, "the scene graph is nested more than 256 deep", "export a single flat mesh");
    const aiMatrix4x4 transform = above * node.mTransformation;
    for (unsigned m = 0; m < node.mNumMeshes; ++m) {
        if (node.mMeshes[m] >= scene.mNumMeshes) continue;
        const aiMesh& part = *scene.mMeshes[node.mMeshes[m]];
        const std::size_t base = mesh.vertices_m.size();
        if (static_cast<std::int64_t>(base + part.mNumVertices) > 3 * kMostTriangles ||
            static_cast<std::int64_t>(mesh.triangles.size() + part.mNumFaces) > kMostTriangles)
            refuse_size(path);
        for (unsigned v = 0; v < part.mNumVertices; ++v) {
            const aiVector3D p = transform * part.mVertices[v];
            mesh.vertices_m.emplace_back(p.x, p.y, p.z);
        }
        for (unsigned f = 0; f < part.mNumFaces; ++f) {
            const aiFace& face = part.mFaces[f];
            if (face.mNumIndices != 3) continue;  // points and lines
            std::array<std::int32_t, 3> triangle;
            bool valid = true;
            for (unsigned k = 0; k < 3; ++k) {
                valid = valid && face.mIndices[k] < part.mNumVertices;
                triangle[k] = static_cast<std::int32_t>(base + face.mIndices[k]);
            }
            if (!valid)
                throw InputError(path, 0, 0, "a triangle refers to a vertex that does not exist",
                                 "the file is damaged; export it again");
            mesh.triangles.push_back(triangle);
        }
    }
    for (unsigned c = 0; c < node.mNumChildren; ++c)
        add_node(scene, *node.mChildren[c], transform, depth + 1, mesh, path);
}

TriangleMesh read_with_assimp(const std::string& path) {
    TriangleMesh mesh;
    try {
        Assimp::Importer importer;
        // Positions only: normals, colours, textures, bones and materials are none of our business.
        importer.SetPropertyInteger(AI_CONFIG_PP_RVC_FLAGS, aiComponent_NORMALS | aiComponent_TANGENTS_AND_BITANGENTS |
                                                                aiComponent_COLORS | aiComponent_TEXCOORDS |
                                                                aiComponent_BONEWEIGHTS | aiComponent_ANIMATIONS |
                                                                aiComponent_TEXTURES | aiComponent_LIGHTS |
                                                                aiComponent_CAMERAS | aiComponent_MATERIALS);
        const aiScene* scene = importer.ReadFile(path, aiProcess_RemoveComponent | aiProcess_Triangulate);
        if (scene == nullptr || scene->mRootNode == nullptr)
            throw InputError(path, 0, 0, std::string("the mesh cannot be read: ") + importer.GetErrorString(),
                             "the file is damaged or not what its name says; export it again");
        add_node(*scene, *scene->mRootNode, aiMatrix4x4(), 0, mesh, path);
    } catch (const InputError&) {
        throw;
    } catch (const std::exception& error) {
        throw InputError(path, 0, 0, std::string("the mesh cannot be read: ") + error.what(),
                         "the file is damaged; export it again");
    }
    return mesh;
}

std::string bytes_of(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream bytes;
    bytes << file.rdbuf();
    return bytes.str();
}

Mat3 rotation_of(const Vec3& angle) {
    const Vec3 c = glm::cos(angle), s = glm::sin(angle);
    const Mat3 x(1, 0, 0, 0, c.x, s.x, 0, -s.x, c.x), y(c.y, 0, -s.y, 0, 1, 0, s.y, 0, c.y),
        z(c.z, s.z, 0, -s.z, c.z, 0, 0, 0, 1);
    return z * y * x;
}

}  // namespace

TriangleMesh read_mesh(const MeshImport& import) {
    const double factor = import.scale * import.unit_m;
    if (!(factor > 0.0) || !std::isfinite(factor))
        throw InputError(import.path, 0, 0, "unit and scale must be positive");
    check_file(import.path);
    const std::string extension = extension_of(import.path);
    TriangleMesh mesh = extension == ".obj"   ? parse_obj(bytes_of(import.path), import.path)
                        : extension == ".ply" ? parse_ply(bytes_of(import.path), import.path)
                                              : read_with_assimp(import.path);
    if (static_cast<std::int64_t>(mesh.triangles.size()) > kMostTriangles) refuse_size(import.path);
    const Mat3 turn = factor * rotation_of(import.rotation_rad);
    for (Vec3& p : mesh.vertices_m) p = import.translation_m + turn * p;
    return mesh;
}

}  // namespace calot::anatomy

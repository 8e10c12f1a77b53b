#pragma once
// Solids from triangle meshes of others: STL, OBJ, PLY, glTF. Meshes are checked, repaired where it is clear what they
// mean, refused with counts and places where it is not. Never silently wrong.

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "calot/anatomy/shape.h"

namespace calot::anatomy {

/// A file and how it comes into the world: p = translation + rotation * (scale * unit_m * file).
struct MeshImport {
    std::string path;
    double unit_m = 1e-3;  ///< of the file's coordinates; 1e-3 = millimetres
    double scale = 1.0;
    Vec3 rotation_rad{0.0};  ///< about x, then y, then z
    Vec3 translation_m{0.0};
};

struct TriangleMesh {
    std::vector<Vec3> vertices_m;
    std::vector<std::array<std::int32_t, 3>> triangles;
};

enum class MeshFault : std::uint8_t {
    open_edge,          ///< one triangle only: a hole
    nonmanifold_edge,   ///< three triangles or more
    flipped_edge,       ///< two triangles with opposite windings
    self_intersection,  ///< triangles that cross without sharing a corner
    unclear             ///< the winding number does not tell inside from outside
};

struct MeshFaultPlace {
    MeshFault kind;
    Vec3 position_m;
};

/// What was found, and what was done about it.
struct MeshReport {
    std::string path;
    std::int64_t vertices = 0, triangles = 0;  ///< after welding, duplicates and degenerate triangles left out
    std::int64_t components = 0;               ///< connected pieces
    std::int64_t degenerate_triangles = 0, duplicate_triangles = 0, welded_vertices = 0;
    std::int64_t open_edges = 0, nonmanifold_edges = 0, flipped_edges = 0, turned_triangles = 0, turned_components = 0;
    std::int64_t self_intersections = 0;
    bool self_intersections_complete = true;  ///< false: counting was cut short (and the mesh refused)
    double unclear_share = 0.0;               ///< of the points along the surface; 0 = closed everywhere
    double volume_m3 = 0.0;
    Box bounds_m;
    std::vector<std::string> notes;            ///< for people: each fault, and how it was handled
    std::vector<MeshFaultPlace> places;        ///< at most kPlaces of each kind
    std::shared_ptr<const TriangleMesh> mesh;  ///< in world space, as repaired

    static constexpr std::size_t kPlaces = 2000;
    bool clean() const { return notes.empty(); }
};

/// Reads, checks, repairs. Throws InputError (missing or unreadable file, no triangles, NaN, no volume, inside and
/// outside not clear). `report` is filled as far as it got, also when this throws. Distances are exact and cost
/// microseconds; wrap organs that instruments touch in make_cached.
ShapePtr load_mesh(const MeshImport& import, MeshReport* report = nullptr);

/// The file's triangles in world space, all meshes of it merged, nothing repaired.
TriangleMesh read_mesh(const MeshImport& import);

/// Checks and repairs a mesh that is in memory; `report.path` is what messages call it.
ShapePtr make_mesh_shape(TriangleMesh mesh, MeshReport& report);

/// Three views of the mesh (front, side, top) with its faults in red, as PNG. Throws InputError when it cannot be
/// written.
void write_fault_picture(const std::string& path, const MeshReport& report);

}  // namespace calot::anatomy

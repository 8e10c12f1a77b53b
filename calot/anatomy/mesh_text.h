#pragma once
// Readers of our own for OBJ and PLY: assimp 5.2 never returns from some damaged files of these (a backslash at the
// end of an OBJ, a broken header of a PLY).

#include "calot/anatomy/mesh_shape.h"

namespace calot::anatomy {

/// Positions ("v") and faces ("f"); all else is passed over. Errors carry their line.
TriangleMesh parse_obj(const std::string& bytes, const std::string& path);

/// ASCII and binary of both byte orders; "vertex" x, y, z and "face" vertex_indices or vertex_index.
TriangleMesh parse_ply(const std::string& bytes, const std::string& path);

/// Adds a polygon as a fan of triangles. Throws InputError where it is concave (a fan would leave it) or refers to a
/// vertex that does not exist. Indices count from 0.
void add_polygon(TriangleMesh& mesh, const std::vector<std::int64_t>& corners, const std::string& path, int line);

}  // namespace calot::anatomy

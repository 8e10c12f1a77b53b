#pragma once
// Faults of a triangle mesh, and the mending of those that have only one meaning. Steps in the order in which they
// build on one another; see make_mesh_shape.

#include "calot/anatomy/mesh_shape.h"
#include "calot/anatomy/mesh_tree.h"

namespace calot::anatomy {

/// Refuses NaN, infinities and empty meshes. Merges equal vertices, then vertices along open edges within 1e-5 of the
/// mesh's size; drops degenerate and duplicate triangles.
void weld(TriangleMesh& mesh, MeshReport& report);

/// Counts open, non-manifold and flipped edges. Turns triangles so that neighbours agree; in each patch the larger
/// share of the area keeps its winding.
void check_edges(TriangleMesh& mesh, MeshReport& report);

/// Connected component of each triangle; sets report.components.
std::vector<std::int32_t> find_components(const TriangleMesh& mesh, MeshReport& report);

/// Counts pairs of triangles that cross without sharing a corner.
void count_self_intersections(const MeshTree& tree, MeshReport& report);

/// Do two triangles cross? Touching within rounding is no crossing; neither are coplanar overlaps.
bool triangles_cross(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b);

/// Volume of the cone from `origin` to a triangle; over a closed mesh these add up to its volume, negative when wound
/// inwards.
double signed_cone_m3(const TriangleMesh& mesh, std::size_t triangle, const Vec3& origin);

inline void add_place(MeshReport& report, MeshFault kind, const Vec3& p, std::int64_t count) {
    if (count <= static_cast<std::int64_t>(MeshReport::kPlaces)) report.places.push_back({kind, p});
}

}  // namespace calot::anatomy

#pragma once
// The tissue's surface: a volume field at hexel centres and marching cubes, redone near what burnt (docs/physics.md
// section 7). The field lives in rest space; vertices are moved by deformation::embed_points.

#include <cstdint>
#include <memory>
#include <vector>

#include "calot/surface/mesh.h"
#include "calot/tissue/exchange.h"
#include "calot/tissue/state.h"

namespace calot::surface {

/// The surface at rest. Vertices and triangles are compact arrays (no holes) whose order is a function of State alone,
/// whatever the order of updates that led there.
class Surface {
  public:
    explicit Surface(const tissue::Model& model);
    ~Surface();
    Surface(Surface&&) noexcept;
    Surface& operator=(Surface&&) noexcept;

    /// Rebuilds everything from State::hexel_present.
    void rebuild(const tissue::Model& model, const tissue::State& state);
    /// Takes Exchange::removed_hexels away. The blocks near them are redone by redo_dirty_blocks(), or when the mesh is
    /// asked for.
    void remove(const tissue::Exchange& exchange);
    /// Redoes the blocks near what was removed, or as much of that as leaves equal parts for further calls: `turns` of
    /// them do it all, this one included. No allocation beyond the reserve made at set-up.
    void redo_dirty_blocks(int turns = 1);

    /// Takes over a mesh of State::hexel_present that somebody else made, with its owners. What comes next may be another
    /// such mesh or rebuild(), not remove().
    void adopt(Mesh mesh, std::vector<std::int64_t> owner);

    /// Rest mesh. Gathered from the blocks when something changed since the last call.
    const Mesh& rest_mesh() const;
    /// For every vertex of rest_mesh(): a hexel nearby (present), for attributes and for the side of a cut it is on.
    const std::vector<std::int64_t>& owner() const;
    /// The same, copied.
    void copy_rest_mesh(Mesh& mesh, std::vector<std::int64_t>& owner) const;
    /// rest_mesh() smoothed for drawing (smoothing.h): same triangles and owners. Worked out when something changed
    /// since the last call.
    const Mesh& smooth_mesh() const;
    /// Counts up whenever rest_mesh() changed; no two surfaces ever have the same.
    std::uint64_t version() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// Closed and manifold: every edge belongs to exactly two triangles, in opposite directions.
struct MeshCheck {
    bool closed = false;
    std::int64_t open_edges = 0;
    std::int64_t nonmanifold_edges = 0;
    std::int64_t degenerate_triangles = 0;
};
MeshCheck check(const Mesh& mesh);

/// Signed volume enclosed [m^3].
double volume_m3(const Mesh& mesh);

}  // namespace calot::surface

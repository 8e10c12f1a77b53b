#pragma once
// The tissue's surface on a device: volume field and marching cubes with compaction by prefix sums
// (kernels/surface.cl).
//
// Always the whole of it. On the CPU, redoing the blocks near what burnt takes a thousandth of the work; on a device
// the work is small beside launching it (some ten kernels either way, of a few microseconds each), while a local update
// would have to find, compact and move what stays, in more kernels, and would need the number of blocks on the host
// before it can launch. And it is done when somebody wants to see it, not every tick: the mesh is a function of the
// present hexels.

#include "calot/gpu/device.h"
#include "calot/gpu/kernels/surface_types.h"
#include "calot/gpu/scan.h"
#include "calot/surface/mesh.h"
#include "calot/tissue/model.h"

namespace calot::gpu {

class Surface {
  public:
    Surface(std::shared_ptr<Device> device, const tissue::Model& model);

    /// Makes the mesh of these hexels; waits for its size.
    void rebuild(const DeviceArray<std::uint32_t>& hexel_present);

    std::int32_t vertices() const { return vertices_; }
    std::int32_t triangles() const { return triangles_; }
    /// Vertices and triangles in the order of surface::Surface::rest_mesh(), and each vertex's owner.
    void download(surface::Mesh& mesh, std::vector<std::int64_t>& owner) const;

    // On the device, of so many vertices and triangles as there are now; there may be room for more.
    const DeviceArray<float>& position_m() const { return position_m_; }  ///< [3 vertices], at rest
    const DeviceArray<float>& normal() const { return normal_; }          ///< [3 vertices], unit
    const DeviceArray<std::int32_t>& owner() const { return owner_; }     ///< [vertices] hexel
    const DeviceArray<std::int32_t>& index() const { return index_; }     ///< [3 triangles]

    std::uint64_t bytes() const;

  private:
    void make_room(std::int32_t vertices, std::int32_t triangles);

    std::shared_ptr<Device> device_;
    GpuBlocks grid_{};
    std::int32_t blocks_ = 0;
    Scan scan_;
    Kernel edges_, list_, make_vertices_, make_triangles_;

    DeviceArray<std::uint8_t> cases_;                          ///< [256][16] triangles of a cube
    DeviceArray<std::int32_t> row_sums_;                       ///< [8][128][4]
    DeviceArray<float> coordinate_m_;                          ///< of points along the three axes
    DeviceArray<std::uint32_t> cut_, before_;                  ///< [64 blocks]
    DeviceArray<std::int32_t> first_vertex_, first_triangle_;  ///< [blocks]
    DeviceArray<std::int32_t> vertex_total_, triangle_total_;

    std::int32_t vertices_ = 0, triangles_ = 0;
    DeviceArray<std::int32_t> edge_of_vertex_, owner_, index_;
    DeviceArray<float> position_m_, normal_;
};

}  // namespace calot::gpu

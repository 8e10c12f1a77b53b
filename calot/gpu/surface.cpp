#include "calot/gpu/surface.h"

#include <array>

#include "calot/surface/block_grid.h"
#include "calot/surface/cubes.h"
#include "calot/surface/field.h"

namespace calot::gpu {

namespace {

constexpr int kRows = 64;   // ROWS of kernels/surface.cl
constexpr int kGroup = 64;  // of everything but scans
constexpr std::size_t kCaseBytes = 16;

GpuBlocks grid_of(const Lattice& lattice) {
    const surface::BlockGrid grid(lattice);
    GpuBlocks out{};
    int coordinates = 0;
    for (int k = 0; k < 3; ++k) {
        out.blocks[k] = grid.blocks()[k];
        out.axis[k] = grid.axis(k);
        out.size[k] = lattice.size[grid.axis(k)];
        out.stride[k] = lattice.stride[grid.axis(k)];
        out.coordinate[k] = coordinates;
        coordinates += surface::kBlock * out.blocks[k];
    }
    out.first = static_cast<std::int32_t>(lattice.first);
    out.spacing_m = static_cast<float>(lattice.spacing_m);
    return out;
}

std::vector<float> coordinates_m(const Lattice& lattice, const GpuBlocks& grid) {
    std::vector<float> all;
    for (int k = 0; k < 3; ++k) {
        const double origin_m = lattice.origin_m[grid.axis[k]] - lattice.spacing_m;
        for (int point = 0; point < surface::kBlock * grid.blocks[k]; ++point)
            all.push_back(static_cast<float>(origin_m + lattice.spacing_m * point));
    }
    return all;
}

std::vector<std::uint8_t> cube_bytes() {
    std::vector<std::uint8_t> bytes(256 * kCaseBytes, 0);
    for (std::size_t k = 0; k < 256; ++k) {
        const surface::CubeCase& cube = surface::cube_cases()[k];
        bytes[kCaseBytes * k] = cube.triangles;
        for (std::size_t e = 0; e < cube.edge.size(); ++e) bytes[kCaseBytes * k + 1 + e] = cube.edge[e];
    }
    return bytes;
}

/// Sums over a row of seven points at a squared distance, for every pattern of presence.
std::vector<std::int32_t> row_sums() {
    constexpr std::array<int, 8> kDistances{0, 1, 2, 4, 5, 8, 9, 10};  // kTableOf of kernels/surface.cl
    std::vector<std::int32_t> sums(kDistances.size() * 128 * 4, 0);
    for (std::size_t k = 0; k < kDistances.size(); ++k)
        for (std::size_t bits = 0; bits < 128; ++bits)
            for (int dx = -surface::kReach; dx <= surface::kReach; ++dx) {
                if (((bits >> (dx + surface::kReach)) & 1u) == 0) continue;
                const int d2 = kDistances[k] + dx * dx;
                std::int32_t* to = &sums[4 * (128 * k + bits)];
                to[0] += surface::slope_weight(d2);
                to[1] += surface::field_weight(d2);
                to[2] += surface::slope_weight(d2) * dx;
                to[3] += surface::field_weight(d2) * dx;
            }
    return sums;
}

template <class T>
DeviceArray<T> uploaded(Device& device, const std::vector<T>& data) {
    DeviceArray<T> array(device, static_cast<std::int64_t>(data.size()));
    array.upload(device, std::span<const T>(data));
    return array;
}

}  // namespace

Surface::Surface(std::shared_ptr<Device> device, const tissue::Model& model)
    : device_(std::move(device)),
      grid_(grid_of(model.hexels)),
      blocks_(grid_.blocks[0] * grid_.blocks[1] * grid_.blocks[2]),
      scan_(device_, blocks_),
      edges_(device_->kernel("surface", "surface_edges")),
      list_(device_->kernel("surface", "surface_list")),
      make_vertices_(device_->kernel("surface", "surface_vertices")),
      make_triangles_(device_->kernel("surface", "surface_triangles")),
      cases_(uploaded(*device_, cube_bytes())),
      row_sums_(uploaded(*device_, row_sums())),
      coordinate_m_(uploaded(*device_, coordinates_m(model.hexels, grid_))),
      cut_(*device_, std::int64_t{kRows} * blocks_),
      before_(*device_, std::int64_t{kRows} * blocks_),
      first_vertex_(*device_, blocks_),
      first_triangle_(*device_, blocks_),
      vertex_total_(*device_, 1),
      triangle_total_(*device_, 1) {
    if (std::int64_t{blocks_} * kRows * 32 >= std::int64_t{1} << 31)
        throw DeviceError("the scene has more cells than a device counts in 32 bits");
}

void Surface::rebuild(const DeviceArray<std::uint32_t>& hexel_present) {
    Device& device = *device_;
    const std::int32_t rows = kRows * blocks_;
    device.launch(edges_, rows, kGroup, hexel_present, grid_, cases_, cut_, before_, first_vertex_, first_triangle_);
    scan_.exclusive(first_vertex_, blocks_, vertex_total_);
    scan_.exclusive(first_triangle_, blocks_, triangle_total_);
    vertices_ = vertex_total_.download(device)[0];
    triangles_ = triangle_total_.download(device)[0];
    if (vertices_ == 0) return;
    make_room(vertices_, triangles_);
    device.launch(list_, rows, kGroup, cut_, before_, first_vertex_, rows, edge_of_vertex_);
    device.launch(make_vertices_, vertices_, kGroup, hexel_present, grid_, row_sums_, coordinate_m_, edge_of_vertex_,
                  vertices_, position_m_, normal_, owner_);
    device.launch(make_triangles_, rows, kGroup, hexel_present, grid_, cases_, cut_, before_, first_vertex_,
                  first_triangle_, rows, index_);
}

/// Room for burning: as much again as is needed.
void Surface::make_room(std::int32_t vertices, std::int32_t triangles) {
    if (vertices > owner_.size()) {
        const std::int64_t room = 2 * std::int64_t{vertices};
        edge_of_vertex_ = DeviceArray<std::int32_t>(*device_, room);
        owner_ = DeviceArray<std::int32_t>(*device_, room);
        position_m_ = DeviceArray<float>(*device_, 3 * room);
        normal_ = DeviceArray<float>(*device_, 3 * room);
    }
    if (3 * std::int64_t{triangles} > index_.size())
        index_ = DeviceArray<std::int32_t>(*device_, 6 * std::int64_t{triangles});
}

void Surface::download(surface::Mesh& mesh, std::vector<std::int64_t>& owner) const {
    Device& device = *device_;
    const auto count = static_cast<std::size_t>(vertices_);
    mesh.position_m.resize(count);
    mesh.normal.resize(count);
    mesh.index.resize(3 * static_cast<std::size_t>(triangles_));
    owner.resize(count);
    std::vector<std::int32_t> hexels(count);
    if (count == 0) return;
    static_assert(sizeof(Vec3f) == 3 * sizeof(float));
    device.read(position_m_.buffer(), mesh.position_m.data(), count * sizeof(Vec3f));
    device.read(normal_.buffer(), mesh.normal.data(), count * sizeof(Vec3f));
    device.read(index_.buffer(), mesh.index.data(), mesh.index.size() * sizeof(std::uint32_t));
    device.read(owner_.buffer(), hexels.data(), count * sizeof(std::int32_t));
    std::copy(hexels.begin(), hexels.end(), owner.begin());
}

std::uint64_t Surface::bytes() const {
    std::uint64_t total = 0;
    for (const Buffer* buffer :
         {&cases_.buffer(), &row_sums_.buffer(), &coordinate_m_.buffer(), &cut_.buffer(), &before_.buffer(),
          &first_vertex_.buffer(), &first_triangle_.buffer(), &edge_of_vertex_.buffer(), &owner_.buffer(),
          &index_.buffer(), &position_m_.buffer(), &normal_.buffer()})
        total += buffer->bytes();
    return total;
}

}  // namespace calot::gpu

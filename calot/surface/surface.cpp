#include "calot/surface/surface.h"

#include <algorithm>
#include <atomic>
#include <cassert>

#include "calot/base/array.h"
#include "calot/base/parallel.h"
#include "calot/surface/block_grid.h"
#include "calot/surface/block_points.h"
#include "calot/surface/pool.h"
#include "calot/surface/smoothing.h"

namespace calot::surface {

namespace {

// What is to be redone in a block.
constexpr std::uint8_t kVertices = 1;   ///< its edges are cut anew, or the field at an end of them changed
constexpr std::uint8_t kTriangles = 2;  ///< its cubes changed, or the places of the vertices that they refer to
constexpr std::uint8_t kWrite = 4;      ///< its triangles, once the edges of all blocks are known

/// Arrays that grow with a pool, never shrink.
template <class T>
void grow(std::vector<T>& array, std::size_t size) {
    if (array.size() < size) array.resize(size);
}

/// Of the whole program, so that whoever draws several surfaces in turn takes none for another.
std::uint64_t next_version() {
    static std::atomic<std::uint64_t> last{0};
    return ++last;
}

/// What a block had before it is redone.
struct OldBlock {
    BlockEdges edges;
    std::array<Vec3f, 3 * kBlock * kBlock * kBlock> position_m, normal;
    std::array<std::int32_t, 3 * kBlock * kBlock * kBlock> owner;
};

}  // namespace

struct Surface::Impl {
    BlockGrid grid;
    double spacing_m;
    std::array<std::vector<float>, 3> coordinate_m;  ///< of points along the inner axes

    Pool vertex_pool, triangle_pool;
    std::vector<Range> vertex_range, triangle_range;  ///< per block
    std::vector<Vec3f> position_m, normal;            ///< by vertex_range
    std::vector<std::int32_t> owner;                  ///< hexels
    std::vector<std::uint16_t> corner;                ///< three a triangle, by triangle_range; CornerCode

    OldBlock old;
    std::vector<Int3> removed;               ///< points, since redo_blocks was last empty
    std::vector<std::uint8_t> redo;          ///< per block
    std::vector<std::int32_t> redo_blocks;   ///< those with kVertices or kTriangles
    std::vector<std::int32_t> write_blocks;  ///< those with kWrite

    std::uint64_t version = 0;
    // Gathered when asked for
    bool gathered = false, smoothed = false;
    Mesh mesh, smooth;
    std::vector<std::int64_t> mesh_owner;
    std::vector<std::uint32_t> first_vertex;  ///< per block
    SmoothingWork smoothing;

    explicit Impl(const tissue::Model& model);
    void rebuild();
    void mark(const Int3& low, const Int3& high, std::uint8_t what);
    void redo_marked(std::size_t turns);
    void redo_edges(std::int64_t block);
    void redo_triangles(std::int64_t block);
    void fit_ranges(std::int64_t block);
    void redo_vertices(std::int64_t block);
    void write_vertices(std::int64_t block, const ChangedPoints* changed, const OldBlock* before);
    void gather();
    void gather_into(Mesh& mesh, std::vector<std::int64_t>& mesh_owner);
};

Surface::Impl::Impl(const tissue::Model& model) : grid(model.hexels), spacing_m(model.hexels.spacing_m) {
    for (int k = 0; k < 3; ++k) {
        const double origin_m = model.hexels.origin_m[grid.axis(k)] - spacing_m;
        auto& coordinate = coordinate_m[static_cast<std::size_t>(k)];
        for (int point = 0; point < kBlock * grid.blocks()[k]; ++point)
            coordinate.push_back(static_cast<float>(origin_m + spacing_m * point));
    }
    assert(model.hexels.cells < std::int64_t{1} << 31);  // owners are kept in 32 bits
    const auto blocks = static_cast<std::size_t>(grid.count());
    vertex_range.resize(blocks);
    triangle_range.resize(blocks);
    redo.assign(blocks, 0);
    redo_blocks.reserve(blocks);
    write_blocks.reserve(blocks);
    removed.reserve(static_cast<std::size_t>(std::min<std::int64_t>(model.hexel_initial.count(), 16384)));
    first_vertex.resize(blocks);
}

void Surface::Impl::rebuild() {
    const std::int64_t blocks = grid.count();
    std::fill(redo.begin(), redo.end(), std::uint8_t{0});
    redo_blocks.clear();
    write_blocks.clear();
    removed.clear();
    parallel_for("surface.edges", 0, blocks, 16, [&](std::int64_t low, std::int64_t high) {
        for (std::int64_t block = low; block < high; ++block) grid.find_edges(block);
    });
    vertex_pool.clear(static_cast<std::size_t>(blocks));
    triangle_pool.clear(static_cast<std::size_t>(blocks));
    std::fill(vertex_range.begin(), vertex_range.end(), Range{});
    std::fill(triangle_range.begin(), triangle_range.end(), Range{});
    for (std::int64_t block = 0; block < blocks; ++block) fit_ranges(block);
    // Room for burning: as much again as the surface of the start, and some for small ones. (The standard dissection
    // adds a tenth.)
    const std::size_t vertices = 2 * std::size_t{vertex_pool.end()} + 8192,
                      triangles = 2 * std::size_t{triangle_pool.end()} + 16384;
    grow(position_m, vertices);
    grow(normal, vertices);
    grow(owner, vertices);
    grow(corner, 3 * triangles);
    parallel_for("surface.rebuild", 0, blocks, 4, [&](std::int64_t low, std::int64_t high) {
        for (std::int64_t block = low; block < high; ++block) {
            write_vertices(block, nullptr, nullptr);
            if (grid.edges(block).triangles > 0)
                grid.write_triangles(block,
                                     &corner[3 * std::size_t{triangle_range[static_cast<std::size_t>(block)].offset}]);
        }
    });
    version = next_version();
    gathered = false;
}

void Surface::Impl::fit_ranges(std::int64_t block) {
    vertex_pool.fit(vertex_range[static_cast<std::size_t>(block)], grid.edges(block).vertices);
    triangle_pool.fit(triangle_range[static_cast<std::size_t>(block)], grid.edges(block).triangles);
}

/// Marks the blocks that own points of a box.
void Surface::Impl::mark(const Int3& low, const Int3& high, std::uint8_t what) {
    const Int3 first = glm::max(low, Int3(0)) / kBlock, last = glm::min(high / kBlock, grid.blocks() - 1);
    for (int z = first.z; z <= last.z; ++z)
        for (int y = first.y; y <= last.y; ++y)
            for (int x = first.x; x <= last.x; ++x) {
                const std::int64_t block = grid.block_at({x, y, z});
                std::uint8_t& marks = redo[static_cast<std::size_t>(block)];
                if ((marks & (kVertices | kTriangles)) == 0) redo_blocks.push_back(static_cast<std::int32_t>(block));
                marks |= what;
            }
}

/// One thread: some ten blocks of a few microseconds each, and tasks would be allocated. A block's triangles refer to
/// places of vertices in the blocks about it, so they come when all edges are known. What is removed in between marks
/// its blocks anew.
void Surface::Impl::redo_marked(std::size_t turns) {
    constexpr std::size_t kEdgesCost = 2;  // in blocks of triangles
    std::size_t left = ((kEdgesCost + 1) * redo_blocks.size() + write_blocks.size() + turns - 1) / turns;
    for (; left > 0 && !redo_blocks.empty(); left -= std::min(left, kEdgesCost)) {
        const std::int32_t block = redo_blocks.back();
        redo_blocks.pop_back();
        redo_edges(block);
        if (redo_blocks.empty()) removed.clear();
    }
    if (!redo_blocks.empty()) return;
    for (; left > 0 && !write_blocks.empty(); --left) {
        redo_triangles(write_blocks.back());
        write_blocks.pop_back();
    }
}

void Surface::Impl::redo_edges(std::int64_t block) {
    std::uint8_t& marks = redo[static_cast<std::size_t>(block)];
    if (marks & kVertices) {
        redo_vertices(block);
    } else {
        grid.find_edges(block);
        fit_ranges(block);
    }
    if ((marks & (kTriangles | kWrite)) == kTriangles) {
        write_blocks.push_back(static_cast<std::int32_t>(block));
        marks |= kWrite;
    }
    marks &= kWrite;
}

void Surface::Impl::redo_triangles(std::int64_t block) {
    const auto b = static_cast<std::size_t>(block);
    redo[b] = 0;
    if (grid.edges(block).triangles == 0) return;
    grow(corner, 3 * std::size_t{triangle_pool.end()});
    grid.write_triangles(block, &corner[3 * std::size_t{triangle_range[b].offset}]);
}

/// Only vertices with a changed end are worked out anew; the others stay, or move up where edges came or went.
void Surface::Impl::redo_vertices(std::int64_t block) {
    ChangedPoints changed;
    const Int3 low = kBlock * grid.block_coordinates(block);
    for (const Int3& p : removed) changed.add(p - low);
    if (!(redo[static_cast<std::size_t>(block)] & kTriangles)) {
        write_vertices(block, &changed, nullptr);
        return;
    }
    old.edges = grid.edges(block);
    const auto from = static_cast<std::ptrdiff_t>(vertex_range[static_cast<std::size_t>(block)].offset);
    std::copy_n(position_m.begin() + from, old.edges.vertices, old.position_m.begin());
    std::copy_n(normal.begin() + from, old.edges.vertices, old.normal.begin());
    std::copy_n(owner.begin() + from, old.edges.vertices, old.owner.begin());
    grid.find_edges(block);
    fit_ranges(block);
    grow(position_m, vertex_pool.end());
    grow(normal, vertex_pool.end());
    grow(owner, vertex_pool.end());
    write_vertices(block, &changed, &old);
}

/// Without `changed` all vertices, otherwise those with a changed end; the others are taken over from `before`, or are
/// in place already.
void Surface::Impl::write_vertices(std::int64_t block, const ChangedPoints* changed, const OldBlock* before) {
    const BlockEdges& edges = grid.edges(block);
    if (edges.vertices == 0) return;
    const std::size_t first = vertex_range[static_cast<std::size_t>(block)].offset;
    std::array<EdgeList, 3> lists;
    EndPoints ends;
    int place = 0;
    for (int row = 0; row < kBlock * kBlock; ++row)
        for (int axis = 0; axis < 3 && edges.cut[static_cast<std::size_t>(row)] != 0; ++axis) {
            const std::uint32_t line = edges.cut[static_cast<std::size_t>(row)] >> (8 * axis) & 0xffu;
            const std::uint32_t kept = changed ? line & ~changed->edges(row, axis) : 0u;
            ends.add(row, axis, line & ~kept);
            EdgeList& list = lists[static_cast<std::size_t>(axis)];
            for (std::uint32_t cut = line; cut != 0; cut &= cut - 1, ++place) {
                const int x = __builtin_ctz(cut);
                if ((kept >> x) & 1u) {
                    if (!before) continue;
                    const auto from = static_cast<std::size_t>(before->edges.place(row, 8 * axis + x));
                    const std::size_t to = first + static_cast<std::size_t>(place);
                    position_m[to] = before->position_m[from];
                    normal[to] = before->normal[from];
                    owner[to] = before->owner[from];
                } else {
                    list.edges[list.count++] = {static_cast<std::uint16_t>(place), static_cast<std::uint8_t>(x),
                                                static_cast<std::uint8_t>(row & 7),
                                                static_cast<std::uint8_t>(row >> 3)};
                }
            }
        }
    if (lists[0].count + lists[1].count + lists[2].count == 0) return;
    Window window;
    grid.load(block, window);
    PointBatch points;
    ends.evaluate_all(window, points);

    const Int3 low = kBlock * grid.block_coordinates(block);
    const auto step_m = static_cast<float>(spacing_m);
    const std::array<const float*, 3> here_m{&coordinate_m[0][static_cast<std::size_t>(low.x)],
                                             &coordinate_m[1][static_cast<std::size_t>(low.y)],
                                             &coordinate_m[2][static_cast<std::size_t>(low.z)]};
    for (int axis = 0; axis < 3; ++axis) {
        const EdgeList& list = lists[static_cast<std::size_t>(axis)];
        const std::size_t to_upper = axis == 0 ? 1 : axis == 1 ? 9 : 81;
        EdgeBatch batch;
        for (std::size_t k = 0; k < list.count; ++k) {
            const std::size_t lower = EndPoints::at(list.edges[k].x, list.edges[k].y, list.edges[k].z);
            batch.add(points, ends.place[lower], ends.place[lower + to_upper], axis);
        }
        evaluate(batch);
        // Component k of the batch is inner axis (axis + k) % 3.
        const int outer[3] = {grid.axis(axis), grid.axis((axis + 1) % 3), grid.axis((axis + 2) % 3)};
        const auto hexel = static_cast<std::int32_t>(grid.hexel_of(low));
        const int to_upper_hexel = grid.stride()[axis];
        for (std::size_t k = 0; k < list.count; ++k) {
            const EdgeList::Edge& edge = list.edges[k];
            const std::size_t vertex = first + edge.place;
            float* position = &position_m[vertex].x;
            position[grid.axis(0)] = here_m[0][edge.x];
            position[grid.axis(1)] = here_m[1][edge.y];
            position[grid.axis(2)] = here_m[2][edge.z];
            position[outer[0]] += step_m * batch.share[k];
            float* n = &normal[vertex].x;
            for (std::size_t c = 0; c < 3; ++c) n[outer[c]] = batch.normal[c][k];
            owner[vertex] = hexel + edge.x + edge.y * grid.stride().y + edge.z * grid.stride().z +
                            (batch.lower_value[k] >= 0.0f ? to_upper_hexel : 0);
        }
    }
}

void Surface::Impl::gather() {
    if (gathered) return;
    gather_into(mesh, mesh_owner);
    gathered = true;
    smoothed = false;
}

void Surface::Impl::gather_into(Mesh& mesh, std::vector<std::int64_t>& mesh_owner) {
    redo_marked(1);
    std::uint32_t vertices = 0, triangles = 0;
    for (std::int64_t block = 0; block < grid.count(); ++block) {
        first_vertex[static_cast<std::size_t>(block)] = vertices;
        vertices += grid.edges(block).vertices;
        triangles += grid.edges(block).triangles;
    }
    resize_with_room(mesh.position_m, vertices);
    resize_with_room(mesh.normal, vertices);
    resize_with_room(mesh_owner, vertices);
    resize_with_room(mesh.index, 3 * std::size_t{triangles});
    std::uint32_t* index = mesh.index.data();
    for (std::int64_t block = 0; block < grid.count(); ++block) {
        const BlockEdges& edges = grid.edges(block);
        const auto b = static_cast<std::size_t>(block);
        if (edges.vertices > 0) {
            const std::size_t from = vertex_range[b].offset, to = first_vertex[b];
            std::copy_n(&position_m[from], edges.vertices, &mesh.position_m[to]);
            std::copy_n(&normal[from], edges.vertices, &mesh.normal[to]);
            std::copy_n(&owner[from], edges.vertices, &mesh_owner[to]);
        }
        if (edges.triangles == 0) continue;
        std::array<std::uint32_t, 8> first{};
        const Int3 c = grid.block_coordinates(block);
        for (int k = 0; k < 8; ++k) {
            const Int3 n = c + Int3(k & 1, (k >> 1) & 1, k >> 2);
            if (n.x < grid.blocks().x && n.y < grid.blocks().y && n.z < grid.blocks().z)
                first[static_cast<std::size_t>(k)] = first_vertex[static_cast<std::size_t>(grid.block_at(n))];
        }
        const std::uint16_t* code = &corner[3 * std::size_t{triangle_range[b].offset}];
        for (std::size_t k = 0; k < 3u * edges.triangles; ++k)
            *index++ = first[static_cast<std::size_t>(CornerCode::owner(code[k]))] +
                       static_cast<std::uint32_t>(CornerCode::place(code[k]));
    }
}

Surface::Surface(const tissue::Model& model) : impl_(std::make_unique<Impl>(model)) {}
Surface::~Surface() = default;
Surface::Surface(Surface&&) noexcept = default;
Surface& Surface::operator=(Surface&&) noexcept = default;

void Surface::rebuild(const tissue::Model&, const tissue::State& state) {
    impl_->grid.copy(state.hexel_present);
    impl_->rebuild();
}

void Surface::remove(const tissue::Exchange& exchange) {
    Impl& s = *impl_;
    for (const std::int64_t hexel : exchange.removed_hexels) {
        const Int3 p = s.grid.point_of(hexel);
        if (!s.grid.test(p)) continue;
        s.grid.clear(p);
        s.removed.push_back(p);
        // Edges that begin in [p - 1, p] are cut anew: places in their blocks change, and with them the triangles of
        // all blocks that refer there. Vertices with an end of their edge within reach move.
        s.mark(p - 1 - kBlock, p, kTriangles);
        s.mark(p - kReach - 1, p + kReach, kVertices);
        s.gathered = false;
        s.version = next_version();
    }
}

void Surface::redo_dirty_blocks(int turns) {
    impl_->redo_marked(static_cast<std::size_t>(turns));
}

void Surface::adopt(Mesh mesh, std::vector<std::int64_t> owner) {
    impl_->mesh = std::move(mesh);
    impl_->mesh_owner = std::move(owner);
    impl_->gathered = true;
    impl_->smoothed = false;
    impl_->version = next_version();
}

const Mesh& Surface::rest_mesh() const {
    impl_->gather();
    return impl_->mesh;
}

const std::vector<std::int64_t>& Surface::owner() const {
    impl_->gather();
    return impl_->mesh_owner;
}

void Surface::copy_rest_mesh(Mesh& mesh, std::vector<std::int64_t>& owner) const {
    if (!impl_->gathered) return impl_->gather_into(mesh, owner);
    mesh = impl_->mesh;
    owner = impl_->mesh_owner;
}

const Mesh& Surface::smooth_mesh() const {
    impl_->gather();
    if (!impl_->smoothed)
        smooth(impl_->mesh, static_cast<float>(impl_->spacing_m), {}, impl_->smooth, impl_->smoothing);
    impl_->smoothed = true;
    return impl_->smooth;
}

std::uint64_t Surface::version() const {
    return impl_->version;
}

}  // namespace calot::surface

#include "calot/surface/block_grid.h"

#include <algorithm>
#include <cassert>
#include <cstring>

#include "calot/surface/cubes.h"

namespace calot::surface {

BlockGrid::BlockGrid(const Lattice& lattice) : first_(lattice.first) {
    const int fast = lattice.stride.x == 1 ? 0 : lattice.stride.y == 1 ? 1 : 2;
    for (int k = 0; k < 3; ++k) {
        axes_[static_cast<std::size_t>(k)] = (fast + k) % 3;
        size_[k] = lattice.size[axis(k)];
        stride_[k] = lattice.stride[axis(k)];
        blocks_[k] = (size_[k] + 2 + kBlock - 1) / kBlock;
    }
    row_bytes_ =
        blocks_.x + 12;  // four bytes are read from the byte of any block, eight written from that of any point
    rows_y_ = blocks_.y * kBlock + 1 + 2 * kReach;
    bits_.assign(static_cast<std::size_t>(row_bytes_ * rows_y_ * (blocks_.z * kBlock + 1 + 2 * kReach)), 0);
    edges_.assign(static_cast<std::size_t>(count()), {});
}

void BlockGrid::copy(const BitArray& present) {
    std::fill(bits_.begin(), bits_.end(), std::uint8_t{0});
    for (int z = 1; z <= size_.z; ++z)
        for (int y = 1; y <= size_.y; ++y) {
            auto* target = const_cast<std::uint8_t*>(row(y, z));
            const std::int64_t source = hexel_of({1, y, z});
            for (int x = 0; x < size_.x; x += 32) {
                std::uint64_t chunk = present.bits32(source + x);
                if (size_.x - x < 32) chunk &= (std::uint64_t{1} << (size_.x - x)) - 1;
                const int bit = x + 1 + kReach;
                std::uint64_t word;
                std::memcpy(&word, target + (bit >> 3), sizeof(word));
                word |= chunk << (bit & 7);
                std::memcpy(target + (bit >> 3), &word, sizeof(word));
            }
        }
}

Int3 BlockGrid::point_of(std::int64_t hexel) const {
    const std::int64_t offset = hexel - first_;
    Int3 point(0);
    if (stride_.y > stride_.z) {
        point.y = static_cast<int>(offset / stride_.y);
        point.z = static_cast<int>(offset % stride_.y / stride_.z);
        point.x = static_cast<int>(offset % stride_.y % stride_.z);
    } else {
        point.z = static_cast<int>(offset / stride_.z);
        point.y = static_cast<int>(offset % stride_.z / stride_.y);
        point.x = static_cast<int>(offset % stride_.z % stride_.y);
    }
    return point + 1;
}

void BlockGrid::clear(const Int3& p) {
    auto* byte = const_cast<std::uint8_t*>(row(p.y, p.z)) + ((p.x + kReach) >> 3);
    *byte = static_cast<std::uint8_t>(*byte & ~(1u << ((p.x + kReach) & 7)));
}

void BlockGrid::load(std::int64_t block, Window& window) const {
    const Int3 b = block_coordinates(block);
    for (int z = -kReach; z < Window::kEdge + kReach; ++z)
        for (int y = -kReach; y < Window::kEdge + kReach; ++y)
            std::memcpy(&window.row(y, z), row(kBlock * b.y + y, kBlock * b.z + z) + b.x, sizeof(std::uint32_t));
}

BlockGrid::CornerRows BlockGrid::corner_rows(const Int3& b) const {
    CornerRows rows;
    for (int z = 0; z <= kBlock; ++z) {
        const std::uint8_t* from = row(kBlock * b.y, kBlock * b.z + z) + b.x;
        for (int y = 0; y <= kBlock; ++y, from += row_bytes_) {
            std::uint16_t bits;
            std::memcpy(&bits, from, sizeof(bits));
            rows[static_cast<std::size_t>(9 * z + y)] = (std::uint32_t{bits} >> kReach) & 0x1ffu;
        }
    }
    return rows;
}

namespace {

/// Corner codes of the edges that a block's cubes may have: those that begin at points 0 .. 8 along each axis.
struct EdgeCodes {
    static constexpr int kEdge = kBlock + 1;
    std::array<std::uint16_t, 3 * kEdge * kEdge * kEdge> code;

    static constexpr int at(int x, int y, int z, int axis) { return 3 * ((z * kEdge + y) * kEdge + x) + axis; }
    /// Takes over a row of a block that is `owner` from here.
    void add_row(const BlockEdges& edges, int owner, int y, int z) {
        const auto row = static_cast<std::size_t>(kBlock * z + y);
        const int y_here = y + kBlock * ((owner >> 1) & 1), z_here = z + kBlock * (owner >> 2);
        if ((owner & 1) == 0) {
            int place = edges.before[row];
            for (std::uint32_t cut = edges.cut[row]; cut != 0; cut &= cut - 1, ++place) {
                const int bit = __builtin_ctz(cut);
                code[static_cast<std::size_t>(at(bit & 7, y_here, z_here, bit >> 3))] = CornerCode::make(owner, place);
            }
            return;
        }
        // Of blocks further along x, the edges at their lowest points.
        for (int axis = 1; axis < 3; ++axis)
            if ((edges.cut[row] >> (8 * axis)) & 1u)
                code[static_cast<std::size_t>(at(kBlock, y_here, z_here, axis))] =
                    CornerCode::make(owner, edges.place(static_cast<int>(row), 8 * axis));
    }
};

/// Where the edges of a cube are in EdgeCodes, from its lowest corner on.
constexpr std::array<int, 12> kEdgeOffsets = [] {
    std::array<int, 12> offsets{};
    for (int edge = 0; edge < 12; ++edge) {
        const int axis = edge / 4, b = edge & 1, c = (edge >> 1) & 1;
        std::array<int, 3> p{};
        p[static_cast<std::size_t>((axis + 1) % 3)] = b;
        p[static_cast<std::size_t>((axis + 2) % 3)] = c;
        offsets[static_cast<std::size_t>(edge)] = EdgeCodes::at(p[0], p[1], p[2], axis);
    }
    return offsets;
}();

/// The cases of cubes with places in EdgeCodes instead of edges.
struct OffsetCase {
    std::uint16_t corners = 0;
    std::array<std::uint16_t, 3 * kMostTriangles> offset{};
};
const std::array<OffsetCase, 256>& offset_cases() {
    static const std::array<OffsetCase, 256> cases = [] {
        std::array<OffsetCase, 256> made{};
        for (std::size_t k = 0; k < made.size(); ++k) {
            const CubeCase& cube = cube_cases()[k];
            made[k].corners = static_cast<std::uint16_t>(3 * cube.triangles);
            // The rest repeats the first: it is read, too.
            for (std::size_t e = 0; cube.triangles > 0 && e < made[k].offset.size(); ++e)
                made[k].offset[e] = static_cast<std::uint16_t>(kEdgeOffsets[cube.edge[e < made[k].corners ? e : 0]]);
        }
        return made;
    }();
    return cases;
}

/// Cubes of a row that the surface cuts, from the nine bits of its four lines of corners.
std::uint32_t cut_cubes(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    const std::uint32_t any = a | b | c | d, all = a & b & c & d;
    return (any | (any >> 1)) & ~(all & (all >> 1)) & 0xffu;
}

/// No surface between the corners of a row of cubes.
bool all_alike(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    return (a | b | c | d) == 0 || (a & b & c & d) == 0x1ffu;
}

/// Case of cube x of the row.
std::size_t case_of(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d, int x) {
    return ((a >> x) & 3u) | (((b >> x) & 3u) << 2) | (((c >> x) & 3u) << 4) | (((d >> x) & 3u) << 6);
}

}  // namespace

void BlockGrid::find_edges(std::int64_t block) {
    BlockEdges& edges = edges_[static_cast<std::size_t>(block)];
    const CornerRows rows = corner_rows(block_coordinates(block));
    std::uint32_t any = 0, all = 0x1ffu;
    for (std::uint32_t r : rows) any |= r, all &= r;
    if (any == 0 || all == 0x1ffu) {
        edges = {};
        return;
    }
    const auto& cases = cube_cases();
    int vertices = 0, triangles = 0;
    for (std::size_t z = 0; z < kBlock; ++z)
        for (std::size_t y = 0; y < kBlock; ++y) {
            const std::uint32_t here = rows[9 * z + y], next = rows[9 * z + y + 1], above = rows[9 * z + y + 9],
                                next_above = rows[9 * z + y + 10];
            const std::size_t r = kBlock * z + y;
            edges.before[r] = static_cast<std::uint16_t>(vertices);
            edges.cut[r] = 0;
            if (all_alike(here, next, above, next_above)) continue;
            edges.cut[r] =
                ((here ^ (here >> 1)) & 0xffu) | (((here ^ next) & 0xffu) << 8) | (((here ^ above) & 0xffu) << 16);
            vertices += count_bits(edges.cut[r]);
            for (std::uint32_t cut = cut_cubes(here, next, above, next_above); cut != 0; cut &= cut - 1)
                triangles += cases[case_of(here, next, above, next_above, __builtin_ctz(cut))].triangles;
        }
    edges.vertices = static_cast<std::uint16_t>(vertices);
    edges.triangles = static_cast<std::uint16_t>(triangles);
}

void BlockGrid::write_triangles(std::int64_t block, std::uint16_t* corner) const {
    const Int3 b = block_coordinates(block);
    const CornerRows rows = corner_rows(b);
    EdgeCodes codes;
    for (int owner = 0; owner < 8; ++owner) {
        const Int3 n = b + Int3(owner & 1, (owner >> 1) & 1, owner >> 2);
        if (n.x == blocks_.x || n.y == blocks_.y || n.z == blocks_.z) continue;
        const BlockEdges& theirs = edges(block_at(n));
        if (theirs.vertices == 0) continue;
        for (int z = 0; z < ((owner & 4) ? 1 : kBlock); ++z)
            for (int y = 0; y < ((owner & 2) ? 1 : kBlock); ++y) codes.add_row(theirs, owner, y, z);
    }
    const auto& cases = offset_cases();
    // Two triangles are written always, the others seldom: lengths that vary cost more than what is overwritten. The
    // end of the last cube may run over, so that all goes into a place of its own first.
    std::array<std::uint16_t, 3 * (kMostTriangles * kBlock * kBlock * kBlock + 2)> written;
    std::uint16_t* to = written.data();
    for (int z = 0; z < kBlock; ++z)
        for (int y = 0; y < kBlock; ++y) {
            const auto r = static_cast<std::size_t>(9 * z + y);
            const std::uint32_t here = rows[r], next = rows[r + 1], above = rows[r + 9], next_above = rows[r + 10];
            for (std::uint32_t cut = cut_cubes(here, next, above, next_above); cut != 0; cut &= cut - 1) {
                const int x = __builtin_ctz(cut);
                const OffsetCase& c = cases[case_of(here, next, above, next_above, x)];
                const std::uint16_t* code = &codes.code[static_cast<std::size_t>(EdgeCodes::at(x, y, z, 0))];
                for (std::size_t k = 0; k < 6; ++k) to[k] = code[c.offset[k]];
                for (std::size_t k = 6; k < c.corners; ++k) to[k] = code[c.offset[k]];
                to += c.corners;
            }
        }
    std::copy(written.data(), to, corner);
}

}  // namespace calot::surface

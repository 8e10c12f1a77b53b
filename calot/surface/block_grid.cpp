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

std::uint32_t BlockGrid::nine_bits(int bx, int y, int z) const {
    std::uint16_t bits;
    std::memcpy(&bits, row(y, z) + bx, sizeof(bits));
    return (static_cast<std::uint32_t>(bits) >> kReach) & 0x1ffu;
}

namespace {

/// Cubes of a row that the surface cuts, from the nine bits of its four lines of corners.
std::uint32_t cut_cubes(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    const std::uint32_t any = a | b | c | d, all = a & b & c & d;
    return (any | (any >> 1)) & ~(all & (all >> 1)) & 0xffu;
}

/// Case of cube x of the row.
std::size_t case_of(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d, int x) {
    return ((a >> x) & 3u) | (((b >> x) & 3u) << 2) | (((c >> x) & 3u) << 4) | (((d >> x) & 3u) << 6);
}

}  // namespace

void BlockGrid::find_edges(std::int64_t block) {
    const Int3 b = block_coordinates(block);
    BlockEdges& edges = edges_[static_cast<std::size_t>(block)];
    const auto& cases = cube_cases();
    int vertices = 0, triangles = 0;
    for (int z = 0; z < kBlock; ++z) {
        std::uint32_t here = nine_bits(b.x, kBlock * b.y, kBlock * b.z + z);
        std::uint32_t above = nine_bits(b.x, kBlock * b.y, kBlock * b.z + z + 1);
        for (int y = 0; y < kBlock; ++y) {
            const std::uint32_t next = nine_bits(b.x, kBlock * b.y + y + 1, kBlock * b.z + z);
            const std::uint32_t next_above = nine_bits(b.x, kBlock * b.y + y + 1, kBlock * b.z + z + 1);
            const auto r = static_cast<std::size_t>(kBlock * z + y);
            edges.cut[r] =
                ((here ^ (here >> 1)) & 0xffu) | (((here ^ next) & 0xffu) << 8) | (((here ^ above) & 0xffu) << 16);
            edges.before[r] = static_cast<std::uint16_t>(vertices);
            vertices += __builtin_popcount(edges.cut[r]);
            for (std::uint32_t cut = cut_cubes(here, next, above, next_above); cut != 0; cut &= cut - 1)
                triangles += cases[case_of(here, next, above, next_above, __builtin_ctz(cut))].triangles;
            here = next;
            above = next_above;
        }
    }
    edges.vertices = static_cast<std::uint16_t>(vertices);
    edges.triangles = static_cast<std::uint16_t>(triangles);
}

void BlockGrid::write_triangles(std::int64_t block, std::uint16_t* corner) const {
    const Int3 b = block_coordinates(block);
    const auto& cases = cube_cases();
    std::array<const BlockEdges*, 8> owners{};
    for (int k = 0; k < 8; ++k) {
        const Int3 n = b + Int3(k & 1, (k >> 1) & 1, k >> 2);
        if (n.x < blocks_.x && n.y < blocks_.y && n.z < blocks_.z)
            owners[static_cast<std::size_t>(k)] = &edges(block_at(n));
    }
    for (int z = 0; z < kBlock; ++z)
        for (int y = 0; y < kBlock; ++y) {
            const std::uint32_t here = nine_bits(b.x, kBlock * b.y + y, kBlock * b.z + z);
            const std::uint32_t next = nine_bits(b.x, kBlock * b.y + y + 1, kBlock * b.z + z);
            const std::uint32_t above = nine_bits(b.x, kBlock * b.y + y, kBlock * b.z + z + 1);
            const std::uint32_t next_above = nine_bits(b.x, kBlock * b.y + y + 1, kBlock * b.z + z + 1);
            for (std::uint32_t cut = cut_cubes(here, next, above, next_above); cut != 0; cut &= cut - 1) {
                const int x = __builtin_ctz(cut);
                const CubeCase& c = cases[case_of(here, next, above, next_above, x)];
                for (std::size_t k = 0; k < 3u * c.triangles; ++k) {
                    const int edge = c.edge[k];
                    const Int3 p = Int3(x, y, z) + edge_corner(edge);
                    const int owner = (p.x >> 3) | ((p.y >> 3) << 1) | ((p.z >> 3) << 2);
                    const int place = owners[static_cast<std::size_t>(owner)]->place(edge / 4, p.x & 7,
                                                                                     kBlock * (p.z & 7) + (p.y & 7));
                    *corner++ = CornerCode::make(owner, place);
                }
            }
        }
}

}  // namespace calot::surface

#pragma once
// Blocks of 8^3 lattice points: presence bits, which lattice edges the surface cuts, and where in a block's vertices
// the one of an edge is.
//
// Points are hexel centres and one ring of empty ones around them; point p is hexel p - 1. Inner axes are the
// lattice's, turned so that its fastest is x (a turn keeps left and right). A block owns its points, the edges that
// begin there and go along +x, +y, +z, and the cubes whose lowest corner is there:
//
//      block b      | block b + 1
//      o---o---o---o|--o---o        a cube's upper edges may belong to any of the seven blocks above its own: a corner
//      |   |   |   ||  |            of a triangle is (which of the eight, place in that block), so that a block's
//      o---o---o---o|--o---o        triangles stay valid when others grow or shrink
//
// A block's vertices are ordered by row (z, then y), axis, x: the place of one is a count of bits.

#include <array>
#include <cstdint>
#include <vector>

#include "calot/base/array.h"
#include "calot/base/lattice.h"
#include "calot/surface/field.h"

namespace calot::surface {

inline constexpr int kBlock = 8;

/// Set bits of a word. (The builtin is a call where the target has no such instruction.)
inline int count_bits(std::uint32_t word) {
    word -= (word >> 1) & 0x55555555u;
    word = (word & 0x33333333u) + ((word >> 2) & 0x33333333u);
    return static_cast<int>((((word + (word >> 4)) & 0x0f0f0f0fu) * 0x01010101u) >> 24);
}

/// Lattice edges that the surface cuts, as bits: per row of points (8 z + y), bit 8 axis + x.
struct BlockEdges {
    std::array<std::uint32_t, 64> cut{};
    std::array<std::uint16_t, 64> before{};  ///< vertices in the rows before
    std::uint16_t vertices = 0;
    std::uint16_t triangles = 0;

    /// Place of the vertex of bit `bit` of a row among the block's.
    int place(int row, int bit) const {
        const auto r = static_cast<std::size_t>(row);
        return before[r] + count_bits(cut[r] & ((1u << bit) - 1u));
    }
};

/// A corner of a triangle in a block: the block that owns the vertex (bit k: one further along axis k), and its place.
struct CornerCode {
    static constexpr int kPlaceBits = 11;  ///< at most 3 * 512 vertices in a block
    static std::uint16_t make(int owner, int place) {
        return static_cast<std::uint16_t>((owner << kPlaceBits) | place);
    }
    static int owner(std::uint16_t code) { return code >> kPlaceBits; }
    static int place(std::uint16_t code) { return code & ((1 << kPlaceBits) - 1); }
};

class BlockGrid {
  public:
    explicit BlockGrid(const Lattice& lattice);

    const Int3& blocks() const { return blocks_; }
    std::int64_t count() const { return std::int64_t{blocks_.x} * blocks_.y * blocks_.z; }
    std::int64_t block_at(const Int3& b) const { return (std::int64_t{b.z} * blocks_.y + b.y) * blocks_.x + b.x; }
    Int3 block_coordinates(std::int64_t block) const {
        const std::int64_t row = block / blocks_.x;
        return {static_cast<int>(block % blocks_.x), static_cast<int>(row % blocks_.y),
                static_cast<int>(row / blocks_.y)};
    }

    /// Takes over all presence bits.
    void copy(const BitArray& present);
    /// Point of a hexel.
    Int3 point_of(std::int64_t hexel) const;
    /// Hexel of a point that is one.
    std::int64_t hexel_of(const Int3& point) const {
        return first_ + std::int64_t{point.x - 1} * stride_.x + std::int64_t{point.y - 1} * stride_.y +
               std::int64_t{point.z - 1} * stride_.z;
    }
    /// Of hexels along the inner axes; the first is 1.
    const Int3& stride() const { return stride_; }
    bool test(const Int3& point) const {
        return (row(point.y, point.z)[(point.x + kReach) >> 3] >> ((point.x + kReach) & 7)) & 1;
    }
    void clear(const Int3& point);

    /// Presence around a block.
    void load(std::int64_t block, Window& window) const;
    /// Finds a block's cut edges and counts its triangles.
    void find_edges(std::int64_t block);
    const BlockEdges& edges(std::int64_t block) const { return edges_[static_cast<std::size_t>(block)]; }
    /// Writes the triangles of a block, BlockEdges::triangles times three corners. Needs the edges of the eight blocks.
    void write_triangles(std::int64_t block, std::uint16_t* corner) const;

    /// Axis of the lattice that is inner axis k.
    int axis(int k) const { return axes_[static_cast<std::size_t>(k)]; }

  private:
    const std::uint8_t* row(int y, int z) const {
        return &bits_[row_bytes_ * (std::int64_t{z + kReach} * rows_y_ + y + kReach)];
    }
    /// Rows of a block's cubes: bits of points 0 .. 8, [9 z + y].
    using CornerRows = std::array<std::uint32_t, 81>;
    CornerRows corner_rows(const Int3& block) const;

    std::array<int, 3> axes_{};
    Int3 size_{0};    ///< hexels along the inner axes
    Int3 stride_{0};  ///< of the lattice along the inner axes
    std::int64_t first_ = 0;
    Int3 blocks_{0};
    std::int64_t row_bytes_ = 0;
    int rows_y_ = 0;
    Array<std::uint8_t> bits_;  ///< rows along x; point x is bit x + kReach, so that a block's window begins at a byte
    Array<BlockEdges> edges_;
};

}  // namespace calot::surface

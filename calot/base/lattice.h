#pragma once
// A box of cells on a cubic lattice. Arrays over it are planar, every neighbour is a constant offset away: no
// neighbour lists, no gathers.
//
//   fastest axis = shortest side of the box, slowest = longest, unless chosen otherwise; each row, and each plane of rows, is followed by one
//   empty border cell (row) that it shares with the next:
//
//       [padding] c c c c . c c c c . c c c c .  . . . . .  [next plane] ... [padding]
//                 row 0   | row 1   | row 2   |  border row
//                         shared border cells, never filled
//
//   Rows may also be further apart, so that all of them begin at the same place within vectors (Rows).
//
//   So index(x, y, z) is valid for x in [-1, size.x], likewise y, z, and all neighbours within one cell of a filled
//   cell can be read without a test. Sweeps run linearly over [first, last) and mask by presence bits.

#include <array>
#include <cstdint>

#include "calot/base/vec.h"

namespace calot {

struct Lattice {
    Vec3 origin_m{0.0};      ///< rest position of the centre of cell (0, 0, 0)
    double spacing_m = 0.0;  ///< edge of a cell
    Int3 size{0};            ///< cells along x, y, z (borders not counted)
    Int3 stride{0};          ///< offset in arrays of one step along x, y, z
    std::int64_t first = 0;  ///< array index of cell (0, 0, 0)
    std::int64_t last = 0;   ///< one past the last cell; [first, last) holds all cells and their borders
    std::int64_t cells = 0;  ///< length of arrays over this lattice, padding at both ends included

    /// A lattice of `size` cells. Requires size >= 1 along each axis.
    static Lattice make(const Vec3& origin_m, double spacing_m, const Int3& size);

    /// Where rows begin in arrays: at multiples of `multiple`, after `shift` < multiple further cells. With a multiple of
    /// a vector's lanes, neighbours in other rows lie in whole vectors as the cells themselves do.
    struct Rows {
        int multiple = 1, shift = 0;
    };
    /// The same with chosen axes, fastest first: for sparse fillings, the axis along which runs are longest.
    static Lattice make(const Vec3& origin_m, double spacing_m, const Int3& size, const std::array<int, 3>& axes,
                        const Rows& rows);

    std::int64_t index(int x, int y, int z) const {
        return first + std::int64_t{x} * stride.x + std::int64_t{y} * stride.y + std::int64_t{z} * stride.z;
    }
    std::int64_t index(const Int3& c) const { return index(c.x, c.y, c.z); }
    /// Offset between neighbours (may be negative).
    std::int64_t offset(const Int3& d) const {
        return std::int64_t{d.x} * stride.x + std::int64_t{d.y} * stride.y + std::int64_t{d.z} * stride.z;
    }
    /// Coordinates of an index in [first, last). A border cell has a coordinate of `size` or more.
    Int3 coordinates(std::int64_t index) const;
    bool contains(const Int3& c) const {
        return c.x >= 0 && c.y >= 0 && c.z >= 0 && c.x < size.x && c.y < size.y && c.z < size.z;
    }
    /// Rest position of a cell's centre [m].
    Vec3 centre_m(const Int3& c) const { return origin_m + spacing_m * Vec3(c); }
    Vec3 centre_m(std::int64_t index) const { return centre_m(coordinates(index)); }
    /// Cell whose box holds a rest position (may lie outside the lattice).
    Int3 cell_at(const Vec3& position_m) const {
        return Int3(glm::floor((position_m - origin_m) / spacing_m + 0.5));
    }
};

}  // namespace calot

#pragma once
// The m^3 hexels of a phyxel's cell as one word: bit x + m (y + m z). Neighbours are shifts, floods are shifts until
// nothing changes.

#include <array>
#include <cstdint>

#include "calot/base/array.h"
#include "calot/base/lattice.h"

namespace calot::deformation {

/// Masks and shifts for cells of m^3 hexels, m in {1, 2, 4}.
struct OccupancyShifts {
    int m;
    std::array<int, 3> shift;           ///< bits between neighbours along x, y, z
    std::array<std::uint64_t, 3> low;   ///< the layer with coordinate 0
    std::array<std::uint64_t, 3> high;  ///< the layer with coordinate m - 1
    std::uint64_t all;

    explicit OccupancyShifts(int hexels_per_edge) : m(hexels_per_edge), shift{1, m, m * m}, low{}, high{}, all(0) {
        for (int bit = 0; bit < m * m * m; ++bit) {
            const std::array<int, 3> c{bit % m, bit / m % m, bit / (m * m)};
            all |= std::uint64_t{1} << bit;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                if (c[axis] == 0) low[axis] |= std::uint64_t{1} << bit;
                if (c[axis] == m - 1) high[axis] |= std::uint64_t{1} << bit;
            }
        }
    }

    // Shifts by m^2 stay below 64: m = 4 gives 16, and a word of one layer (m = 1) has no neighbours inside.
    std::uint64_t up(std::uint64_t w, std::size_t axis) const { return (w & ~high[axis]) << shift[axis]; }
    std::uint64_t down(std::uint64_t w, std::size_t axis) const { return (w & ~low[axis]) >> shift[axis]; }
    /// The high layer of `w`, moved onto the low layer: what a cell shows to the next one along the axis.
    std::uint64_t high_as_low(std::uint64_t w, std::size_t axis) const {
        return (w & high[axis]) >> (shift[axis] * (m - 1));
    }
    std::uint64_t low_as_high(std::uint64_t w, std::size_t axis) const {
        return (w & low[axis]) << (shift[axis] * (m - 1));
    }
    /// Whether `below` and `above`, neighbours along the axis, share a face of hexels.
    bool touch(std::uint64_t below, std::uint64_t above, std::size_t axis) const {
        return (high_as_low(below, axis) & above) != 0;
    }
    /// Everything in `inside` that faces join to `seed`.
    std::uint64_t flood(std::uint64_t seed, std::uint64_t inside) const {
        std::uint64_t filled = seed & inside;
        for (std::uint64_t before = 0; before != filled;) {
            before = filled;
            for (std::size_t axis = 0; axis < 3; ++axis) filled |= (up(filled, axis) | down(filled, axis)) & inside;
        }
        return filled;
    }
    /// The component with most hexels; of equals, the one with the lowest bit.
    std::uint64_t largest_component(std::uint64_t word) const {
        std::uint64_t best = 0;
        for (std::uint64_t rest = word; rest != 0;) {
            const std::uint64_t component = flood(rest & (~rest + 1), rest);
            if (__builtin_popcountll(component) > __builtin_popcountll(best)) best = component;
            rest &= ~component;
        }
        return best;
    }
};

/// The hexels of phyxel cell `phyxel` (coordinates) in a bit array over the hexel lattice.
inline std::uint64_t occupancy_of(const Lattice& hexels, int m, const BitArray& bits, const Int3& phyxel) {
    std::uint64_t word = 0;
    for (int bit = 0; bit < m * m * m; ++bit)
        if (bits.test(hexels.index(phyxel * m + Int3(bit % m, bit / m % m, bit / (m * m)))))
            word |= std::uint64_t{1} << bit;
    return word;
}

/// Local coordinates of a bit.
inline Int3 hexel_of_bit(int m, int bit) {
    return Int3(bit % m, bit / m % m, bit / (m * m));
}

}  // namespace calot::deformation

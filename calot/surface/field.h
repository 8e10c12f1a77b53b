#pragma once
// The volume field at hexel centres (Pan et al. 2019, Eqs. 17-19), from presence bits.
//
//   W(r) = (1 - r^2/R^2)^3 for r < R = 2.5 L                                              (17, as it must read)
//   p_hat = sum W p_j / sum W over present hexels j,    v = |p - p_hat| - L/2              (18), (19)
//
// Departures, each tested in tests/surface/field_unit.cpp and sphere_analytic.cpp:
//   - The sign of the field is the presence of the hexel. As printed, v < 0 in a slot one hexel wide (p_hat = p by
//     symmetry), so that a cut would stay closed to the eye, and v > 0 all over a cluster of 2^3 hexels, which would
//     vanish. With the sign by presence everything burnt is open and everything left is seen, and which cubes are cut
//     is known from bits alone.
//   - Where the surface is smooth, (19) puts it 0.28 L too deep. The share of the neighbourhood that is filled,
//     rho = sum_present W / sum_all W, gives 1 - 2 rho, which is nearly the distance in L from a flat surface
//     and puts it half-way between hexels. (19) still rules where the tissue is thin, and its mirror image (absent for
//     present) where a gap is:
//       v =  min(1 - 2 rho, |p - p_hat| - 1/2)   present,
//            max(1 - 2 rho, 1/2 - |p - q_hat|)   absent,   q_hat = weighted mean of absent positions,
//     and at least kLeastValue away from 0, so that no vertex meets a hexel's centre.
//   - Normals are the gradient of a filled share with R = 3.5 L: sum W d is, but for a factor, the gradient of the
//     same sum with the exponent 4.
//
// Weights are integers, so that sums are exact in any order. A row of seven presence bits is an index into a table of
// its weights and first moments, all four sums in one word: 37 look-ups a point instead of 179 neighbours.

#include <array>
#include <cstdint>

#include "calot/base/vec.h"

namespace calot::surface {

inline constexpr int kReach = 3;             ///< whole offsets within the wider R: 3 along each axis
inline constexpr float kLeastValue = 0.05f;  ///< |v| >= this, in L

/// Weight of the field's kernel (R = 2.5 L) and of the normals' (R = 3.5 L) at a squared distance in L^2. The latter is
/// coarser, so that all sums fit one word; its outermost shells, 0.001 and less, fall away.
constexpr int field_weight(int d2) {
    return d2 <= 6 ? (25 - 4 * d2) * (25 - 4 * d2) * (25 - 4 * d2) : 0;
}
constexpr int slope_weight(int d2) {
    return d2 <= 12 ? (49 - 4 * d2) * (49 - 4 * d2) * (49 - 4 * d2) / 240 : 0;
}
inline constexpr int kFullFieldWeight = 155121;  ///< sum of field_weight over all offsets

/// Weighted sums over the present hexels around a point, in units of L.
struct Moments {
    int weight = 0;  ///< sum of field_weight
    Int3 mean{0};    ///< sum of field_weight * offset
    Int3 slope{0};   ///< sum of slope_weight * offset: points into the tissue
    bool operator==(const Moments&) const = default;
};

/// Presence around a block: rows of bits along x, for points -kReach .. kEdge - 1 + kReach along each axis.
struct Window {
    static constexpr int kEdge = 9;  ///< points along an edge: eight of the block and the next
    static constexpr int kRows = kEdge + 2 * kReach;
    std::array<std::uint32_t, kRows * kRows> rows;

    std::uint32_t& row(int y, int z) { return rows[static_cast<std::size_t>((z + kReach) * kRows + y + kReach)]; }
    std::uint32_t row(int y, int z) const { return rows[static_cast<std::size_t>((z + kReach) * kRows + y + kReach)]; }
    bool test(int x, int y, int z) const { return (row(y, z) >> (x + kReach)) & 1u; }
};

/// The seven bits around x of every row of a window: what all points with this x look up.
struct Slice {
    std::array<std::uint8_t, Window::kRows * Window::kRows> pattern;
};
Slice slice_of(const Window& window, int x);

/// The sums at a point of a window, 0 <= x, y, z < Window::kEdge, from the slice of its x.
Moments moments_at(const Slice& slice, int y, int z);
inline Moments moments_at(const Window& window, int x, int y, int z) {
    return moments_at(slice_of(window, x), y, z);
}
/// The same, neighbour by neighbour: what the other is compared with.
Moments moments_at_reference(const Window& window, int x, int y, int z);

/// The field in units of L: negative where the hexel is present.
float field_value(const Moments& moments, bool present);

}  // namespace calot::surface

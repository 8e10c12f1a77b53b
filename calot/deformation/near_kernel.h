#pragma once
// Which phyxels are near the instruments: the first, wide part of the search for near hexels (near.cpp).

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "calot/deformation/embedding.h"
#include "calot/deformation/work.h"

namespace calot::deformation {

struct CapsuleF {
    Vec3f a, ab;
    float inverse_length2, radius;
    float reach;  ///< hexels within this of its surface are near
    bool bare;
};

/// Capsules in single precision. At most 16: more than any instrument has.
struct Capsules {
    std::array<CapsuleF, 16> item;
    std::size_t count = 0;

    Capsules(const std::vector<tissue::Capsule>& capsules, const NearReach& reach);
    float distance(const Vec3f& p) const;
    /// By how much a point is out of reach of those of the capsules that `which` names; negative within.
    float beyond_reach(const Vec3f& p, std::uint32_t which) const;
    /// Bits of the capsules whose reach a point is at most `further_m` beyond.
    std::uint32_t within(const Vec3f& p, float further_m) const;
    float bare_distance(const Vec3f& p) const;
};

/// Beyond the reach, how far from a capsule a phyxel's centre may be and still own a hexel within reach, in spacings:
/// half a cell's diagonal is 0.87, stretched by up to 1.7.
inline constexpr double kPhyxelMargin = 1.5;

/// What the three cells of a row about a hexel add to its outward direction, by which of them are filled: minus the sum
/// of the directions to these, weighted by their inverse distance squared. Axes: along the row, then the two across.
inline constexpr auto kRowOutward = [] {
    std::array<std::array<std::array<float, 3>, 8>, 9> outward{};
    for (int row = 0; row < 9; ++row)
        for (int bits = 0; bits < 8; ++bits)
            for (int k = 0; k < 3; ++k) {
                if (((bits >> k) & 1) == 0) continue;
                const int step[3] = {k - 1, row % 3 - 1, row / 3 - 1};
                const int square = step[0] * step[0] + step[1] * step[1] + step[2] * step[2];
                for (std::size_t axis = 0; axis < 3; ++axis)
                    outward[static_cast<std::size_t>(row)][static_cast<std::size_t>(bits)][axis] -=
                        static_cast<float>(step[axis]) / static_cast<float>(square > 0 ? square : 1);
            }
    return outward;
}();

/// The nine rows of three cells about a hexel, along the lattice's fastest axis.
struct OutwardRows {
    Int3 axis;                           ///< of the lattice: along, across, across
    std::array<std::int64_t, 9> offset;  ///< of a row's first cell

    explicit OutwardRows(const Lattice& hexels) {
        const int fast = hexels.stride.x == 1 ? 0 : hexels.stride.y == 1 ? 1 : 2;
        axis = {fast, (fast + 1) % 3, (fast + 2) % 3};
        for (int row = 0; row < 9; ++row) {
            Int3 step(0);
            step[axis.x] = -1;
            step[axis.y] = row % 3 - 1;
            step[axis.z] = row / 3 - 1;
            offset[static_cast<std::size_t>(row)] = hexels.offset(step);
        }
    }
};

/// Where phyxels are: centres at rest and displacements, over the phyxel lattice.
struct PlaceView {
    std::array<const float*, 3> rest_m{}, displacement_m{};
};

/// Sets near[k] to the lanes of group k whose centres are at most `further_m` beyond a capsule's reach, in the world.
/// Cells that are not there may have bits too.
void find_near_phyxels(const PlaceView& view, std::span<const Group> groups, const Capsules& capsules, float further_m,
                       std::vector<std::uint16_t>& near);

}  // namespace calot::deformation

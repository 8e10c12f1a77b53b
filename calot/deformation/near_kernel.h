#pragma once
// Which phyxels are near the instruments: the first, wide part of the search for near hexels (near.cpp).

#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "calot/deformation/work.h"

namespace calot::deformation {

struct CapsuleF {
    Vec3f a, ab;
    float inverse_length2, radius;
    bool bare;
};

/// Capsules in single precision. At most 16: more than any instrument has.
struct Capsules {
    std::array<CapsuleF, 16> item;
    std::size_t count = 0;

    explicit Capsules(const std::vector<tissue::Capsule>& capsules);
    float distance(const Vec3f& p, std::uint32_t which = ~0u) const;
    /// Bits of the capsules within `reach_m` of a point.
    std::uint32_t within(const Vec3f& p, float reach_m) const;
    float bare_distance(const Vec3f& p) const;
};

/// Beyond the reach, how far from a capsule a phyxel's centre may be and still own a hexel within reach, in spacings:
/// half a cell's diagonal is 0.87, stretched by up to 1.7.
inline constexpr double kPhyxelMargin = 1.5;

/// The nine rows of three cells about a hexel, along the lattice's fastest axis: where they are, and for each of the
/// eight ways to fill one, minus the sum of the directions to the filled ones, weighted by their inverse distance.
struct OutwardRows {
    std::array<std::int64_t, 9> offset;  ///< of a row's first cell
    std::array<std::array<Vec3f, 8>, 9> outward;

    explicit OutwardRows(const Lattice& hexels) {
        const int fast = hexels.stride.x == 1   ? 0
                         : hexels.stride.y == 1 ? 1
                                                : 2,
                  b = (fast + 1) % 3, c = (fast + 2) % 3;
        for (int row = 0; row < 9; ++row) {
            Int3 step(0);
            step[b] = row % 3 - 1;
            step[c] = row / 3 - 1;
            step[fast] = -1;
            offset[static_cast<std::size_t>(row)] = hexels.offset(step);
            for (int bits = 0; bits < 8; ++bits) {
                Vec3f& sum = outward[static_cast<std::size_t>(row)][static_cast<std::size_t>(bits)];
                sum = Vec3f(0.0f);
                for (int k = 0; k < 3; ++k) {
                    step[fast] = k - 1;
                    const Vec3f direction(step);
                    if ((bits >> k) & 1) sum -= direction / std::fmax(1.0f, glm::dot(direction, direction));
                }
            }
        }
    }
};

/// Where phyxels are: centres at rest and displacements, over the phyxel lattice.
struct PlaceView {
    std::array<const float*, 3> rest_m{}, displacement_m{};
};

/// Sets near[k] to the lanes of group k whose centres are within `reach_m` of a capsule's surface, in the world. Cells
/// that are not there may have bits too.
void find_near_phyxels(const PlaceView& view, std::span<const Group> groups, const Capsules& capsules, float reach_m,
                       std::vector<std::uint16_t>& near);

}  // namespace calot::deformation

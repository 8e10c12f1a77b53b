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

/// Where phyxels are: centres at rest and displacements, over the phyxel lattice.
struct PlaceView {
    std::array<const float*, 3> rest_m{}, displacement_m{};
};

/// Sets near[k] to the lanes of group k whose centres are at most `further_m` beyond a capsule's reach, in the world.
/// Cells that are not there may have bits too.
void find_near_phyxels(const PlaceView& view, std::span<const Group> groups, const Capsules& capsules, float further_m,
                       std::vector<std::uint16_t>& near);

}  // namespace calot::deformation

#pragma once
// Which phyxels are near the instruments: the first, wide part of the search for near hexels (near.cpp).

#include <array>
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

/// Where phyxels are: centres at rest and displacements, over the phyxel lattice.
struct PlaceView {
    std::array<const float*, 3> rest_m{}, displacement_m{};
};

/// Sets near[k] to the lanes of group k whose centres are within `reach_m` of a capsule's surface, in the world. Cells
/// that are not there may have bits too.
void find_near_phyxels(const PlaceView& view, std::span<const Group> groups, const Capsules& capsules, float reach_m,
                       std::vector<std::uint16_t>& near);

}  // namespace calot::deformation

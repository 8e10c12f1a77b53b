#pragma once
// What the search for near hexels keeps (near.cpp): tables, and lists that last for a frame.

#include <array>
#include <cstdint>
#include <vector>

#include "calot/base/array.h"
#include "calot/tissue/exchange.h"

namespace calot::deformation {

struct NearReach;

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

    Capsules() = default;
    Capsules(const std::vector<tissue::Capsule>& capsules, const NearReach& reach);
};

/// A group of which phyxels may come near these capsules before the frame ends.
struct NearGroup {
    std::int32_t group = 0;
    std::uint16_t capsules = 0;
    std::uint16_t lanes = 0;  ///< that are near now
};

struct NearWork {
    // Of hexel centres, which sit at the same m^3 places in every phyxel's cell (bit as in Work::occupancy)
    Array<float> weight;                   ///< [m^3][kNeighbourhood] kernel towards carriers in their order (carriers.h)
    Array<std::uint32_t> weighted;         ///< [m^3] bits of those that are not 0
    std::array<Array<float>, 3> offset_m;  ///< [64] from the cell's centre

    std::vector<NearGroup> groups;  ///< ascending
    std::int64_t tick = -1;         ///< of the last search
    Capsules listed;                ///< where they were when `groups` were listed
};

}  // namespace calot::deformation

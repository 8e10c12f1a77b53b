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
    tissue::Instrument instrument;
};

/// Capsules in single precision. At most 16: more than any instrument has.
struct Capsules {
    std::array<CapsuleF, 16> item;
    std::size_t count = 0;

    Capsules() = default;
    Capsules(const std::vector<tissue::Capsule>& capsules, const NearReach& reach);
};

/// Sixteen phyxels that may come near some of the capsules before the frame ends.
struct NearBlock {
    alignas(64) std::array<std::int32_t, 16> cell{};
    alignas(64) std::array<std::array<float, 16>, 3> rest_m{};
    std::uint16_t there = 0;     ///< lanes
    std::uint16_t capsules = 0;  ///< those capsules
    std::uint16_t near = 0;      ///< lanes that are near now
};

/// Most carriers with a weight above 0 of a hexel's centre, however many hexels a phyxel has.
inline constexpr int kMostWeighted = 12;

/// A hexel's centre, which sits at the same place in every phyxel's cell: kernel towards those carriers that have any,
/// in their order (carriers.h).
struct HexelWeights {
    alignas(64) std::array<float, 16> weight{};
    alignas(64) std::array<std::int32_t, 16> carrier{};
};

struct NearWork {
    std::vector<HexelWeights, AlignedAllocator<HexelWeights>> weights;  ///< [m^3], bit as in Work::occupancy
    std::array<Array<float>, 3> offset_m;                               ///< [64] of the same centres from the cell's
    std::array<std::array<std::uint8_t, 3>, 64> local{};                ///< coordinates in the cell
    std::array<std::int64_t, 64> hexel_offset{};                        ///< from the cell's first hexel

    std::vector<NearBlock, AlignedAllocator<NearBlock>> blocks;  ///< cells ascend
    std::int64_t tick = -1;                                      ///< of the last search
    Capsules listed;                                             ///< where they were when `blocks` were listed
};

}  // namespace calot::deformation

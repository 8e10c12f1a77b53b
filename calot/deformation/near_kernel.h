#pragma once
// The wide parts of the search for near hexels (near.cpp).

#include <array>
#include <cstdint>
#include <span>

#include "calot/deformation/carriers.h"
#include "calot/deformation/embedding.h"
#include "calot/deformation/near_work.h"
#include "calot/deformation/work.h"

namespace calot::deformation {

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

/// The nine rows of three cells about a cell, along the lattice's fastest axis.
struct NeighbourRows {
    Int3 axis;                           ///< of the lattice: along, across, across
    std::array<std::int64_t, 9> offset;  ///< of a row's first cell

    explicit NeighbourRows(const Lattice& lattice) {
        const int fast = lattice.stride.x == 1 ? 0 : lattice.stride.y == 1 ? 1 : 2;
        axis = {fast, (fast + 1) % 3, (fast + 2) % 3};
        for (std::size_t row = 0; row < offset.size(); ++row)
            offset[row] = lattice.offset(step(3 * static_cast<int>(row)));
    }
    /// To the k-th cell, rows one after another.
    Int3 step(int k) const {
        Int3 step(0);
        step[axis.x] = k % 3 - 1;
        step[axis.y] = k / 3 % 3 - 1;
        step[axis.z] = k / 9 - 1;
        return step;
    }
};

/// Capsules as lanes; those that are not there reach nothing.
struct CapsuleLanes {
    alignas(64) std::array<std::array<float, 16>, 3> a, ab;
    alignas(64) std::array<float, 16> inverse_length2, within;  ///< within = radius and reach

    explicit CapsuleLanes(const Capsules& capsules);
};

/// Tables and room for lists. Requires Work::hexel_weight and ::groups.
NearWork make_near_work(const tissue::Model& model, const Work& work);

// ---- Phyxels

/// Where phyxels are: centres at rest and displacements, over the phyxel lattice.
struct PlaceView {
    std::array<const float*, 3> rest_m{}, displacement_m{};
};

/// Lists the phyxels whose centres are at most `further_m` beyond a capsule's reach, in the world. There is room for
/// all.
void list_near_phyxels(const PlaceView& view, std::span<const Group> groups, const Capsules& capsules, float further_m,
                       NearWork& near);

/// Sets NearBlock::near to those that are so now.
void find_near_phyxels(const PlaceView& view, const Capsules& capsules, float further_m, NearWork& near);

// ---- Hexels of one phyxel

/// Constant over a tick. Cells of the neighbourhood are in rows here, row by row (slots).
struct CellView {
    std::array<const float*, 12> field;                       ///< u (3), G (9, row-major) over the phyxel lattice
    std::array<std::int64_t, 9> row;                          ///< NeighbourRows::offset
    alignas(64) std::array<std::array<float, 32>, 3> step_m;  ///< [slot] from the phyxel's centre to the slot's
    std::array<std::uint8_t, 28> place;                       ///< [slot] in the order of carriers
    const NearWork* tables;
    const Capsules* capsules;
    const CapsuleLanes* lanes;  ///< the same
    float half_m;               ///< half edge of the cube of hexel centres
};

/// One phyxel: what carries its hexels.
struct Cell {
    std::int64_t phyxel = 0;
    Vec3f centre_m{0.0f};        ///< at rest
    std::uint32_t carriers = 0;  ///< bits in their order
    std::uint64_t hexels = 0;    ///< those that are asked for
};

/// Blended fields (a, G as in CarrierFields), padded.
using PaddedField = std::array<float, 16>;

/// Of the hexels asked for, those that may be within a capsule's reach; the field at each of them in turn, in
/// `blended`. None is missing that is within reach.
std::uint64_t blend_near(const CellView& view, const Cell& cell, PaddedField* blended);

/// Places in the world and what is known of them, sixteen at a time; lanes past `count` are anything.
struct NearPlaces {
    static constexpr std::size_t kCapacity = 128;
    alignas(64) std::array<std::array<float, kCapacity>, 3> world_m;
    alignas(64) std::array<float, kCapacity> beyond_m;    ///< a capsule's reach; negative within
    alignas(64) std::array<float, kCapacity> distance_m;  ///< to the surface of the nearest capsule
    alignas(64) std::array<float, kCapacity> bare_m;      ///< to that of the nearest bare one
    std::size_t count = 0;
};
void measure(const Capsules& capsules, NearPlaces& places);

}  // namespace calot::deformation

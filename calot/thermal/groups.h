#pragma once
// Cells in groups of sixteen, the widest vector: which of them hold tissue, what lies beside them, and hence what a heat
// step has to do with them. Presence changes seldom, so all of it is kept and renewed where hexels went.

#include <array>
#include <cstdint>

#include "calot/base/array.h"
#include "calot/tissue/model.h"

namespace calot::thermal {

inline constexpr int kGroupCells = 16;

/// What has to be done with a group.
enum GroupKind : std::uint8_t {
    kPlain = 0,
    kExposed = 1,  ///< has faces towards gas or held tissue
    kChanged = 2,  ///< not all water is there, or something is damaged
    kMixed = 4     ///< hexels or their neighbours are of several tissues
};

// Area. Tissue's surface is a staircase of hexel faces, which has up to 1.7 times the area of the smooth surface that it
// stands for: a plane with unit normal n shows |nx| + |ny| + |nz| faces per face's area. So a face counts as
// 1 / (|nx| + |ny| + |nz|), which is 1 on planes along the axes, and n is told from the 26 cells around the hexel, each
// with 1 over the square of its distance as its weight. Areas of planes at random come out 2.3 % too large in the mean,
// with a spread of as much; those of balls of 6 to 40 hexels across within 3 %. (Weights of 1, 0.35 and 0.2 are 2.0 %
// off on planes.) Price: real edges count as rounded; a cube of 20 hexels a side exchanges 6 % too little.

/// What a group costs, by its kind, in vectors of healthy tissue.
inline constexpr std::array<std::uint8_t, 8> kCost{1, 1, 3, 3, 5, 5, 5, 5};

/// A bit for each of its cells, lowest first.
struct alignas(16) CellGroup {
    std::uint16_t present = 0;
    std::uint16_t beside[6] = {};  ///< cells whose neighbour along -x, +x, -y, +y, -z, +z is present
    tissue::MaterialIndex material = tissue::kNoMaterial;  ///< of all of them, unless mixed
    std::uint8_t kind = kPlain;                            ///< GroupKinds, added
};
static_assert(sizeof(CellGroup) == 16);

/// Groups of a lattice and the faces of its hexels.
struct Groups {
    Array<CellGroup> groups;    ///< [hexels.cells / 16 + 17]
    Array<std::uint8_t> cost;   ///< [as many] kCost of those that hold hexels, else 0
    Array<std::uint8_t> faces;  ///< [hexels.cells] number towards gas, and towards held tissue times kHeldFace
    Array<std::uint8_t> share;  ///< [hexels.cells] of exposed hexels, what each face counts, in 1 / kWholeFace
    BitArray dirty;             ///< [groups] to be looked at anew; empty between calls

    /// All of them, for a model whose hexels are those of `present`.
    static Groups make(const tissue::Model& model, const BitArray& present);
    /// After `hexel` went or came: remembers which groups see it.
    void touch(const Lattice& lattice, std::int64_t hexel);
    /// Looks anew at what was touched.
    void refresh(const tissue::Model& model, const BitArray& present);
    /// After its kind changed.
    void weigh(std::int64_t group) {
        const CellGroup& own = groups[static_cast<std::size_t>(group)];
        cost[static_cast<std::size_t>(group)] = own.present != 0 ? kCost[own.kind] : std::uint8_t{0};
    }

  private:
    void look_at(const tissue::Model& model, const BitArray& present, std::int64_t group);
};
inline constexpr int kWholeFace = 255;
static_assert(255.0f * (1.0f / 255.0f) == 1.0f, "a whole face is exactly that");
inline constexpr int kHeldShift = 3, kHeldFace = 1 << kHeldShift, kFaceMask = kHeldFace - 1;

}  // namespace calot::thermal

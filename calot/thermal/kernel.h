#pragma once
// The kernels of a heat step, over a run of cells: as wide vectors (kernel_simd.cpp) and as the plain reference that
// tests compare with (kernel_scalar.cpp).

#include <cstdint>

#include "calot/thermal/heat.h"

namespace calot::thermal {

/// Joule heat as the kernels find it: a box of hexels whose rows run along the lattice's.
struct JouleRows {
    const float* density = nullptr;           ///< JouleHeat::density; null: none. 0 in cells beyond the lattice
    float scaled_dt_s;                        ///< dt times JouleHeat::scale
    int low[3];                               ///< of the box, along the fast, middle and slow axis
    int size[3];
    std::int64_t row_cells;   ///< lattice: cells from row to row
    std::int64_t plane_rows;  ///< lattice: rows from plane to plane
    std::int64_t first;       ///< lattice: index of cell (0, 0, 0)
};

/// Everything a kernel reads and writes.
struct HeatStep {
    // Constant
    const Properties* properties;  ///< set to the step
    const tissue::MaterialIndex* material;
    const std::uint8_t* living;  ///< bits: hexels present now; groups hold those present when the step began
    const BlockSet* active;      ///< groups
    const std::uint8_t* faces;   ///< Groups::faces
    const std::uint8_t* share;   ///< Groups::share
    std::int64_t first, last;    ///< of the lattice; block 0 begins at its first cell
    std::int64_t offset[3];      ///< to the next cell along each axis
    std::int64_t furthest;       ///< the greatest of them
    float body_K;
    float gas_K;
    float dt_s;
    bool threshold;  ///< PhaseModel::threshold
    JouleRows joule;
    const float* temperature_K;  ///< at the start of the step
    // Changed
    CellGroup* groups;           ///< [cells / 16] their kChanged
    float* next_temperature_K;  ///< at its end
    float* enthalpy_J_per_m3;
    float* water_kg_per_m3;
    float* peak_temperature_K;
    float* damage;
    float* steam_kg_per_m3;
};

/// A run of blocks is what a kernel works on at once: long enough for its groups to be sorted by kind, short enough to
/// stay near.
inline constexpr int kRunBlocks = 64;

/// Adds q dt to the hexels that are present now of at most kRunBlocks blocks, then in their active groups
///
///     H' = H + dt [ (1/s_h^2) sum_alive k_ij (T_j - T_i) + w_b(Omega) rho_b c_b (T_a - T_i)
///                   - (1/s_h) sum_exposed h_c (T_i - T_s) ]                       (docs/physics.md section 6)
///
/// boils water off and sets temperature, peak and damage from enthalpy and water. Adds to the sums, sets the marks of
/// each block.
void step_blocks(const HeatStep& step, const std::int32_t* blocks, int count, BlockMarks* marks, HeatSums& sums);
void step_blocks_scalar(const HeatStep& step, const std::int32_t* blocks, int count, BlockMarks* marks, HeatSums& sums);

/// Calls body(hexel, density, count) for the pieces of rows of the box within the cells [begin, end).
template <class Body>
inline void for_joule_rows(const JouleRows& joule, std::int64_t begin, std::int64_t end, const Body& body) {
    std::int64_t row = (begin - joule.first) / joule.row_cells;
    for (std::int64_t start = joule.first + row * joule.row_cells; start < end; start += joule.row_cells, ++row) {
        const std::int64_t middle = row % joule.plane_rows - joule.low[1], slow = row / joule.plane_rows - joule.low[2];
        if (middle < 0 || middle >= joule.size[1] || slow < 0 || slow >= joule.size[2]) continue;
        const std::int64_t box = start + joule.low[0];
        const std::int64_t low = box < begin ? begin : box;
        const std::int64_t high = box + joule.size[0] > end ? end : box + joule.size[0];
        if (low >= high) continue;
        body(low, joule.density + (slow * joule.size[1] + middle) * joule.size[0] + (low - box), high - low);
    }
}

}  // namespace calot::thermal

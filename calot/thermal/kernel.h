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
    const Properties* properties;
    const tissue::MaterialIndex* material;
    const std::uint8_t* group_material;
    const std::uint8_t* present;  ///< bits: hexels that take part, those present when the step began
    const std::uint8_t* living;   ///< bits: hexels present now
    const std::uint8_t* held;     ///< bits
    std::int64_t offset[3];       ///< to the next cell along each axis
    float body_K;
    float gas_K;
    float dt_s;
    float conduction_factor;  ///< dt / s_h^2
    float surface_factor;     ///< dt / s_h
    bool threshold;           ///< PhaseModel::threshold
    JouleRows joule;
    const float* temperature_K;  ///< at the start of the step
    // Changed
    float* next_temperature_K;  ///< at its end
    float* enthalpy_J_per_m3;
    float* water_kg_per_m3;
    float* peak_temperature_K;
    float* damage;
    float* steam_kg_per_m3;
};

/// Adds q dt to the hexels of [begin, end) that are present now.
void deposit_cells(const HeatStep& step, std::int64_t begin, std::int64_t end, BlockSums& sums);

/// H' = H + dt [ (1/s_h^2) sum_alive k_ij (T_j - T_i) + w_b(Omega) rho_b c_b (T_a - T_i)
///               - (1/s_h) sum_exposed h_c (T_i - T_s) ]                       (docs/physics.md section 6)
/// then boils water off and sets temperature, peak and damage from enthalpy and water. `pristine`: all water is there
/// and no damage; the same bytes either way. Cells from a multiple of 64 on.
void step_cells(const HeatStep& step, std::int64_t begin, std::int64_t end, bool pristine, BlockSums& sums);

void deposit_cells_scalar(const HeatStep& step, std::int64_t begin, std::int64_t end, BlockSums& sums);
void step_cells_scalar(const HeatStep& step, std::int64_t begin, std::int64_t end, bool pristine, BlockSums& sums);

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

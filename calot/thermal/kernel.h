#pragma once
// The two kernels of a heat step, over a run of cells: as wide vectors (kernel_simd.cpp) and as the plain reference
// that tests compare with (kernel_scalar.cpp).

#include <cstdint>

#include "calot/thermal/heat.h"

namespace calot::thermal {

/// Everything a kernel reads and writes.
struct HeatStep {
    // Constant
    const Properties* properties;
    const tissue::MaterialIndex* material;
    const std::uint8_t* group_material;
    const std::uint8_t* present;  ///< bits
    const std::uint8_t* held;     ///< bits
    std::int64_t offset[3];       ///< to the next cell along each axis
    float body_K;
    float gas_K;
    float dt_s;
    float conduction_factor;  ///< dt / s_h^2
    float surface_factor;     ///< dt / s_h
    bool threshold;           ///< PhaseModel::threshold
    // Changed
    float* temperature_K;
    float* enthalpy_J_per_m3;
    float* water_kg_per_m3;
    float* peak_temperature_K;
    float* damage;
    float* steam_kg_per_m3;
};

/// Joule heat [W/m^3] in the order of the lattice: rows of a cache line each.
inline constexpr int kTile = 16;
using HeatTile = float[kTile][kTile];

/// Adds q dt to the present hexels of a tile whose rows begin at first + row * stride. Returns the sum of what was
/// added, after rounding [J/m^3].
double deposit_tile(const HeatStep& step, const HeatTile& density_W_per_m3, std::int64_t first, std::int64_t stride,
                    int rows, int columns);

/// Whether any hexel of the cells [begin, end) is not at body temperature.
bool is_warm(const HeatStep& step, std::int64_t begin, std::int64_t end);

/// H' = H + dt [ (1/s_h^2) sum_alive k_ij (T_j - T_i) + w_b rho_b c_b (T_a - T_i) - (1/s_h) sum_exposed h_c (T_i - T_s)
/// ] (docs/physics.md section 6). Reads temperatures, writes enthalpies.
void conduct_cells(const HeatStep& step, std::int64_t begin, std::int64_t end, BlockSums& sums);

/// Boils water off, then sets temperature, peak and damage from enthalpy and water.
void settle_cells(const HeatStep& step, std::int64_t begin, std::int64_t end, BlockSums& sums);

void conduct_cells_scalar(const HeatStep& step, std::int64_t begin, std::int64_t end, BlockSums& sums);
void settle_cells_scalar(const HeatStep& step, std::int64_t begin, std::int64_t end, BlockSums& sums);

}  // namespace calot::thermal

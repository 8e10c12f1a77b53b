#pragma once
// What the heat kernels know of each material, from tissue::Material and ThermalParameters.
//
// Capacity. A hexel's volumetric heat capacity is that of its dry solids plus that of the water it still has,
//
//     C(w) = rho (1 - f) c_dry + w c_w        f = water mass fraction, w from rho f (alive) to 0 (dry)
//
// and must be rho c when alive, c being the published capacity of living tissue. c_dry is given, so c_w follows:
// c_w = (c - (1 - f) c_dry) / f. The default c_dry are those for which it is water's own 4187 J/(kg K).
//
// Phases, as a function of H (counted from body temperature T_0), limits being rises above T_0:
//
//     water then solids    T - T_0 = min(H / C(w), wet_limit if w > 0 else dry_limit)
//                          gas when w = 0 and H >= C(0) dry_limit + solids * their latent heat
//     threshold            T - T_0 = min(H / (rho c), T_v - T_0);  w falls from alive to 0 along the plateau
//                          gas when H >= rho (c (T_v - T_0) + f * 2.26e6)
//
// Surroundings. h_c acts on the temperature of a face, which is half a cell from a hexel's centre; the two resistances
// are in series, h = 1 / (1/h_c + s_h / 2k). (With h_c alone, exchange with held tissue would be up to 1.7 times too
// strong at the standard spacing and converge with first order only.)

#include <array>
#include <cstdint>

#include "calot/base/array.h"
#include "calot/tissue/model.h"

namespace calot::thermal {

/// Cells of a block, the unit of work and of rest.
inline constexpr std::int64_t kBlockCells = 512;

/// Damage below 43 C is not counted: living tissue mends as fast as it is hurt there, and the fits were made at higher
/// temperatures (extrapolated to 37 C, liver's would kill it at rest within an hour).
inline constexpr float kDamageThreshold_K = 316.15f;
inline constexpr float kDamageReference_K = 333.15f;  ///< rates are held in log space relative to theirs at 60 C
inline constexpr float kDamageLimit = 1e6f;           ///< Omega saturates

/// Cells come in groups of 16. Work::group_material names the material of the hexels of a group and of all their
/// neighbours, where it is the same; else:
inline constexpr std::uint8_t kMixedGroup = 255;
inline constexpr int kGroupCells = 16;

/// Temperature of one material as a function of H and w.
struct PhaseCurve {
    float dry_capacity_J_per_m3K = 1.0f;    ///< C(0)
    float water_capacity_J_per_kgK = 0.0f;  ///< c_w
    float wet_limit_K = 0.0f;               ///< rise above T_0 while there is water
    float dry_limit_K = 0.0f;               ///< and without

    static PhaseCurve make(const tissue::ThermalParameters& thermal, const tissue::Material& material);
    /// T - T_0. Kernels do the same operations in the same order.
    float rise_K(float enthalpy_J_per_m3, float water_kg_per_m3) const;
};

struct Properties {
    template <class T>
    using PerMaterial = std::array<T, 256>;

    alignas(64) PerMaterial<float> conductivity_W_per_mK{};
    PerMaterial<float> gas_transfer_W_per_m2K{};    ///< from a hexel's centre to gas, see below
    PerMaterial<float> held_transfer_W_per_m2K{};   ///< and to held tissue
    PerMaterial<float> perfusion_W_per_m3K{};       ///< w_b rho_b c_b
    PerMaterial<float> dry_capacity_J_per_m3K{};    ///< C(0)
    PerMaterial<float> water_capacity_J_per_kgK{};  ///< c_w
    PerMaterial<float> dry_limit_K{};               ///< rise above T_0 that dry tissue stops at
    PerMaterial<float> boil_off_J_per_kg{};         ///< latent heat and heat above T_0 that a kilogram of steam takes
    PerMaterial<float> plateau_J_per_m3{};          ///< H where the last plateau begins
    PerMaterial<float> spent_J_per_m3{};            ///< H where it ends and the hexel is gas
    PerMaterial<float> water_kg_per_m3{};           ///< alive
    PerMaterial<float> solids_kg_per_m3{};
    PerMaterial<float> damage_log_rate{};  ///< ln of the rate [1/s] at kDamageReference_K
    PerMaterial<float> damage_slope{};     ///< Ea / (R T_ref)
    float wet_limit_K = 0.0f;              ///< boiling - T_0
    float quick_rise_K = 0.0f;             ///< up to here nothing boils, is hurt or changes phase
    float longest_step_s = 0.0f;           ///< stable for every material and pair of materials

    static Properties make(const tissue::Model& model);
};

/// Work::group_material of a model.
Array<std::uint8_t> group_materials(const tissue::Model& model);

}  // namespace calot::thermal

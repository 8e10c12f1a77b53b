#pragma once
// What the heat kernels know of each material, from tissue::Material and ThermalParameters. Capacities and phases:
// tissue/phase.h.
//
// Surroundings. h_c acts on the temperature of a face, which is half a cell from a hexel's centre; the two resistances
// are in series, h = 1 / (1/h_c + s_h / 2k). (With h_c alone, exchange with held tissue would be up to 1.7 times too
// strong at the standard spacing and converge with first order only.)

#include <array>
#include <cstdint>

#include "calot/base/array.h"
#include "calot/tissue/model.h"
#include "calot/tissue/phase.h"

namespace calot::thermal {

/// Damage below 43 C is not counted: living tissue mends as fast as it is hurt there, and the fits were made at higher
/// temperatures (extrapolated to 37 C, liver's would kill it at rest within an hour).
inline constexpr float kDamageThreshold_K = 316.15f;
inline constexpr float kDamageReference_K = 333.15f;  ///< rates are held in log space relative to theirs at 60 C
inline constexpr float kDamageLimit = 1e6f;           ///< Omega saturates

using tissue::PhaseCurve;

struct Properties {
    template <class T>
    using PerMaterial = std::array<T, 256>;

    // What a hexel exchanges in a step and per kelvin [J/(m^3 K)]; see set_step
    alignas(64) PerMaterial<float> conducted_J_per_m3K{};  ///< through a face to its like: dt k / s_h^2
    PerMaterial<float> to_gas_J_per_m3K{};                 ///< through a face to gas: dt h / s_h
    PerMaterial<float> to_held_J_per_m3K{};                ///< and to held tissue
    PerMaterial<float> to_blood_J_per_m3K{};  ///< dt w_b rho_b c_b, with what streams through vessels

    PerMaterial<float> dry_capacity_J_per_m3K{};        ///< C(0)
    PerMaterial<float> water_capacity_J_per_kgK{};      ///< c_w
    PerMaterial<float> per_capacity_alive_m3K_per_J{};  ///< 1 / C with all water
    PerMaterial<float> dry_limit_K{};                   ///< rise above T_0 that dry tissue stops at
    PerMaterial<float> boil_off_J_per_kg{};  ///< latent heat and heat above T_0 that a kilogram of steam takes
    PerMaterial<float> plateau_J_per_m3{};   ///< H where the last plateau begins
    PerMaterial<float> spent_J_per_m3{};     ///< H where it ends and the hexel is gas
    PerMaterial<float> water_kg_per_m3{};    ///< alive
    PerMaterial<float> solids_kg_per_m3{};
    PerMaterial<float> damage_log_rate{};  ///< ln of the rate [1/s] at kDamageReference_K
    PerMaterial<float> damage_slope{};     ///< Ea / (R T_ref)
    float wet_limit_K = 0.0f;              ///< boiling - T_0
    float quick_rise_K = 0.0f;             ///< up to here nothing boils, is hurt or changes phase
    float longest_step_s = 0.0f;           ///< stable for every material and pair of materials

    bool few = false;                      ///< all materials are among the first 16

    /// For steps of the longest stable length.
    static Properties make(const tissue::Model& model);
    void set_step(const tissue::Model& model, double dt_s);
};

}  // namespace calot::thermal

#pragma once
// Temperature of tissue as a function of its enthalpy and water (docs/physics.md section 6). Rooms that need the
// temperature of a hexel (heat, electric conductivity, pictures) ask here.
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
//     both                 T = T_0 within kRest_K of it
//     threshold            T - T_0 = min(H / (rho c), T_v - T_0);  w falls from alive to 0 along the plateau
//                          gas when H >= rho (c (T_v - T_0) + f * 2.26e6)

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "calot/tissue/state.h"

namespace calot::tissue {

/// Tissue this close to body temperature counts as being at it. The heat stays in its enthalpy and flows once there is
/// more: the front of a burn is sharp, and what lies beyond needs no work. A plain zero would leave everything warm by
/// 1e-5 K within seconds.
inline constexpr float kRest_K = 1e-3f;

/// Temperature of one material as a function of H and w.
struct PhaseCurve {
    float dry_capacity_J_per_m3K = 1.0f;    ///< C(0)
    float water_capacity_J_per_kgK = 0.0f;  ///< c_w
    float wet_limit_K = 0.0f;               ///< rise above T_0 while there is water
    float dry_limit_K = 0.0f;               ///< and without

    static PhaseCurve make(const ThermalParameters& thermal, const Material& material);
    /// T - T_0. The heat kernels do the same operations in the same order.
    float rise_K(float enthalpy_J_per_m3, float water_kg_per_m3) const {
        const float capacity = dry_capacity_J_per_m3K + water_kg_per_m3 * water_capacity_J_per_kgK;
        const float rise = enthalpy_J_per_m3 * (1.0f / capacity);
        if (std::abs(rise) < kRest_K) return 0.0f;
        return std::min(rise, water_kg_per_m3 > 0.0f ? wet_limit_K : dry_limit_K);
    }
};

/// Temperature of a hexel from its enthalpy and water [K]. For many hexels, keep a PhaseCurve per material.
float temperature_K(const Model& model, const State& state, std::int64_t hexel);

}  // namespace calot::tissue

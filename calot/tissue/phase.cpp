#include "calot/tissue/phase.h"

namespace calot::tissue {

PhaseCurve PhaseCurve::make(const ThermalParameters& thermal, const Material& material) {
    const double density = material.density_kg_per_m3, alive = density * material.specific_heat_J_per_kgK;
    const double water = density * material.water_mass_fraction;
    const double boils_K = thermal.boiling_temperature_K - thermal.body_temperature_K;
    PhaseCurve curve;
    if (thermal.phase_model == PhaseModel::threshold || water <= 0.0) {
        curve.dry_capacity_J_per_m3K = static_cast<float>(alive);
    } else {
        // Water has no negative capacity: should the solids want more than all, they get all.
        const double dry = std::min(alive, (density - water) * material.dry_specific_heat_J_per_kgK);
        curve.dry_capacity_J_per_m3K = static_cast<float>(dry);
        curve.water_capacity_J_per_kgK = static_cast<float>((alive - dry) / water);
    }
    if (thermal.phase_model == PhaseModel::threshold) {
        curve.dry_limit_K = static_cast<float>(thermal.threshold_temperature_K - thermal.body_temperature_K);
        curve.wet_limit_K = curve.dry_limit_K;
    } else {
        curve.wet_limit_K = static_cast<float>(boils_K);
        curve.dry_limit_K =
            static_cast<float>(std::max(boils_K, material.removal_temperature_K - thermal.body_temperature_K));
    }
    return curve;
}

float temperature_K(const Model& model, const State& state, std::int64_t hexel) {
    const auto h = static_cast<std::size_t>(hexel);
    const PhaseCurve curve = PhaseCurve::make(model.thermal, model.materials[model.hexel_material[h]]);
    return static_cast<float>(model.thermal.body_temperature_K) +
           curve.rise_K(state.enthalpy_J_per_m3[h], state.water_kg_per_m3[h]);
}

}  // namespace calot::tissue

#include "calot/thermal/properties.h"

#include <algorithm>
#include <cmath>

#include "calot/base/units.h"

namespace calot::thermal {

namespace {

/// Two resistances in series: the surroundings' and half a cell's.
double transfer_W_per_m2K(const tissue::Model& model, double surroundings_W_per_m2K, double conductivity_W_per_mK) {
    if (conductivity_W_per_mK <= 0.0) return 0.0;
    const double h = surroundings_W_per_m2K;
    return h / (1.0 + 0.5 * h * model.hexels.spacing_m / conductivity_W_per_mK);
}

double blood_W_per_m3K(const tissue::Model& model, const tissue::Material& material) {
    return material.perfusion_m3_per_s_kg * material.density_kg_per_m3 * model.thermal.blood_density_kg_per_m3 *
               model.thermal.blood_specific_heat_J_per_kgK +
           material.vessel_transfer_W_per_m3K;
}

/// Explicit Euler obeys the maximum principle while no hexel can give more than it has above its surroundings:
/// dt (sum over faces of the strongest exchange + perfusion) <= C, with C least when dry. For one material and no
/// surroundings that is s_h^2 / 6a.
double longest_step_s(const tissue::Model& model, const Properties& p) {
    const double s = model.hexels.spacing_m;
    double strongest = 0.0;
    for (std::size_t m = 1; m < model.materials.size(); ++m)
        strongest = std::max(strongest, model.materials[m].thermal_conductivity_W_per_mK);
    double longest = 1e9;
    for (std::size_t m = 1; m < model.materials.size(); ++m) {
        const double own = model.materials[m].thermal_conductivity_W_per_mK;
        if (own <= 0.0) continue;
        const double transfer = std::max(transfer_W_per_m2K(model, model.thermal.gas_transfer_W_per_m2K, own),
                                         transfer_W_per_m2K(model, model.thermal.held_transfer_W_per_m2K, own));
        const double face = std::max(2.0 * own * strongest / (own + strongest) / (s * s), transfer / s);
        const double rate = 6.0 * face + blood_W_per_m3K(model, model.materials[m]);
        longest = std::min(longest, static_cast<double>(p.dry_capacity_J_per_m3K[m]) / rate);
    }
    return longest;
}

}  // namespace

Properties Properties::make(const tissue::Model& model) {
    const tissue::ThermalParameters& thermal = model.thermal;
    const bool threshold = thermal.phase_model == tissue::PhaseModel::threshold;
    Properties p;
    p.wet_limit_K = static_cast<float>(thermal.boiling_temperature_K - thermal.body_temperature_K);
    const double unhurt = static_cast<double>(kDamageThreshold_K) - thermal.body_temperature_K;
    // Water follows H, down as well as up, with a threshold: no short cut.
    p.quick_rise_K = threshold ? -1e30f : std::min(static_cast<float>(unhurt), p.wet_limit_K);
    p.dry_capacity_J_per_m3K.fill(1.0f);  // "none": any number but zero
    for (std::size_t m = 1; m < model.materials.size(); ++m) {
        const tissue::Material& material = model.materials[m];
        const PhaseCurve curve = PhaseCurve::make(thermal, material);
        const double density = material.density_kg_per_m3;
        const double water = density * material.water_mass_fraction, solids = density - water;
        p.dry_capacity_J_per_m3K[m] = curve.dry_capacity_J_per_m3K;
        p.water_capacity_J_per_kgK[m] = curve.water_capacity_J_per_kgK;
        p.dry_limit_K[m] = curve.dry_limit_K;
        p.quick_rise_K = std::min(p.quick_rise_K, curve.dry_limit_K);
        p.boil_off_J_per_kg[m] = static_cast<float>(
            kLatentHeatOfWater_J_per_kg + static_cast<double>(curve.water_capacity_J_per_kgK * curve.wet_limit_K));
        const double plateau =
            static_cast<double>(curve.dry_capacity_J_per_m3K) * static_cast<double>(curve.dry_limit_K);
        p.plateau_J_per_m3[m] = static_cast<float>(plateau);
        p.spent_J_per_m3[m] = static_cast<float>(
            plateau + (threshold ? water * kLatentHeatOfWater_J_per_kg : solids * material.solid_latent_heat_J_per_kg));
        p.water_kg_per_m3[m] = static_cast<float>(water);
        p.per_capacity_alive_m3K_per_J[m] =
            1.0f / (p.dry_capacity_J_per_m3K[m] + p.water_kg_per_m3[m] * p.water_capacity_J_per_kgK[m]);
        p.solids_kg_per_m3[m] = static_cast<float>(solids);
        const double slope =
            material.arrhenius_energy_J_per_mol / (kGasConstant_J_per_molK * static_cast<double>(kDamageReference_K));
        const double log_rate = material.arrhenius_frequency_per_s > 0.0
                                    ? std::log(material.arrhenius_frequency_per_s) - slope
                                    : -1e4;  // exp() of it is zero
        p.damage_slope[m] = static_cast<float>(slope);
        p.damage_log_rate[m] = static_cast<float>(log_rate);
    }
    p.few = model.materials.size() <= 16;
    p.longest_step_s = static_cast<float>(thermal::longest_step_s(model, p));
    p.set_step(model, static_cast<double>(p.longest_step_s));
    return p;
}

void Properties::set_step(const tissue::Model& model, double dt_s) {
    const double s = model.hexels.spacing_m;
    for (std::size_t m = 1; m < model.materials.size(); ++m) {
        const double k = model.materials[m].thermal_conductivity_W_per_mK;
        conducted_J_per_m3K[m] = static_cast<float>(dt_s * k / (s * s));
        to_gas_J_per_m3K[m] =
            static_cast<float>(dt_s / s * transfer_W_per_m2K(model, model.thermal.gas_transfer_W_per_m2K, k));
        to_held_J_per_m3K[m] =
            static_cast<float>(dt_s / s * transfer_W_per_m2K(model, model.thermal.held_transfer_W_per_m2K, k));
        to_blood_J_per_m3K[m] = static_cast<float>(dt_s * blood_W_per_m3K(model, model.materials[m]));
    }
}

}  // namespace calot::thermal

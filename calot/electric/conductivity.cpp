#include "calot/electric/conductivity.h"

#include <algorithm>

#include "calot/base/parallel.h"
#include "calot/tissue/phase.h"

namespace calot::electric {

namespace {

/// Of organs whose material is unknown: about that of liver and muscle at 450 kHz (IT'IS database).
constexpr double kOrganConductivity_S_per_m = 0.2;

double organ_conductivity_S_per_m(const tissue::Model& model, const Vec3& place_m) {
    for (const tissue::RigidOrgan& organ : model.organs)
        if (organ.holds_tissue && organ.material != tissue::kNoMaterial && organ.shape->distance_m(place_m) < 0.0)
            return model.materials[organ.material].electric_conductivity_S_per_m;
    return kOrganConductivity_S_per_m;
}

}  // namespace

Array<float> conductivity_at_rest_S_per_m(const tissue::Model& model) {
    Array<float> conductivity(static_cast<std::size_t>(model.hexels.cells), 0.0f);
    parallel_for("electric.conductivity", model.hexels.first, model.hexels.last, 4096,
                 [&](std::int64_t low, std::int64_t high) {
                     for (std::int64_t hexel = low; hexel < high; ++hexel) {
                         double value = 0.0;
                         if (model.hexel_initial.test(hexel))
                             value = model.materials[model.hexel_material[static_cast<std::size_t>(hexel)]]
                                         .electric_conductivity_S_per_m;
                         else if (model.hexel_held.test(hexel))
                             value = organ_conductivity_S_per_m(model, model.hexels.centre_m(hexel));
                         conductivity[static_cast<std::size_t>(hexel)] = static_cast<float>(value);
                     }
                 });
    return conductivity;
}

Conductivity conductivity_of_materials(const tissue::Model& model) {
    Conductivity c;
    c.wet_limit_K = static_cast<float>(model.thermal.boiling_temperature_K - model.thermal.body_temperature_K);
    c.dry_capacity_J_per_m3K.fill(1.0f);
    for (std::size_t m = 1; m < model.materials.size(); ++m) {
        const tissue::Material& material = model.materials[m];
        const tissue::PhaseCurve curve = tissue::PhaseCurve::make(model.thermal, material);
        const double water = material.density_kg_per_m3 * material.water_mass_fraction;
        c.slope_per_K[m] = static_cast<float>(material.electric_temperature_coefficient_per_K);
        c.dry_S_per_m[m] = static_cast<float>(
            std::min(material.electric_dry_conductivity_S_per_m, material.electric_conductivity_S_per_m));
        c.dry_capacity_J_per_m3K[m] = curve.dry_capacity_J_per_m3K;
        c.water_capacity_J_per_kgK[m] = curve.water_capacity_J_per_kgK;
        c.alive_water_kg_per_m3[m] = static_cast<float>(water);
        c.per_water_m3_per_kg[m] = water > 0.0 ? static_cast<float>(1.0 / water) : 0.0f;
    }
    return c;
}

void look_at(const tissue::Model& model, const tissue::State& state, const Array<float>& rest_S_per_m,
             Conductivity& conductivity) {
    conductivity.rest_S_per_m = rest_S_per_m.data();
    conductivity.present = state.hexel_present.bytes();
    conductivity.held = model.hexel_held.bytes();
    conductivity.material = model.hexel_material.data();
    conductivity.enthalpy_J_per_m3 = state.enthalpy_J_per_m3.data();
    conductivity.water_kg_per_m3 = state.water_kg_per_m3.data();
}

}  // namespace calot::electric

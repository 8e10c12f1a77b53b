#include "calot/electric/conductivity.h"

#include "calot/base/parallel.h"

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

}  // namespace calot::electric

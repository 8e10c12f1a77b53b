// What heat did, for scores and reports.

#include <algorithm>

#include "calot/thermal/heat.h"

namespace calot::thermal {

std::vector<MaterialInjury> injuries(const tissue::Model& model, const tissue::State& state) {
    std::vector<MaterialInjury> all(model.materials.size());
    for (std::int64_t i = model.hexels.first; i < model.hexels.last; ++i) {
        if (!model.hexel_initial.test(i)) continue;
        const auto h = static_cast<std::size_t>(i);
        MaterialInjury& injury = all[model.hexel_material[h]];
        const bool present = state.hexel_present.test(i);
        injury.material = model.hexel_material[h];
        ++(present ? injury.present_hexels : injury.removed_hexels);
        if (present && state.damage[h] >= 1.0f) ++injury.damaged_hexels;
        injury.peak_temperature_K =
            std::max(injury.peak_temperature_K, static_cast<double>(state.peak_temperature_K[h]));
    }
    all.erase(std::remove_if(all.begin(), all.end(),
                             [](const MaterialInjury& m) { return m.material == tissue::kNoMaterial; }),
              all.end());
    for (MaterialInjury& injury : all)
        injury.damaged_volume_m3 = static_cast<double>(injury.damaged_hexels) * model.hexel_volume_m3();
    return all;
}

}  // namespace calot::thermal

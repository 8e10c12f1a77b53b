#include "injuries.h"

#include <algorithm>

namespace calot::app {

InjuryWatch::InjuryWatch(const tissue::Model& model, const tissue::State& state)
    : by_material_(model.materials.size()) {
    for (std::size_t k = 0; k < by_material_.size(); ++k) {
        by_material_[k].structure = model.materials[k].name;
        by_material_[k].first_time_s = -1.0;
    }
    const tissue::MaterialIndex fat = tissue::find_material(model.materials, "fat");
    for (std::int64_t h = model.hexels.first; h < model.hexels.last; ++h)
        if (state.hexel_present.test(h) && model.hexel_material[static_cast<std::size_t>(h)] != fat)
            hexels_.push_back(h);
}

void InjuryWatch::look(const tissue::Model& model, const tissue::State& state, double time_s) {
    for (Injury& injury : by_material_) injury.hexels_removed = injury.hexels_damaged = 0;
    for (std::int64_t h : hexels_) {
        const auto cell = static_cast<std::size_t>(h);
        Injury& injury = by_material_[model.hexel_material[cell]];
        injury.max_temperature_K =
            std::max(injury.max_temperature_K, static_cast<double>(state.peak_temperature_K[cell]));
        if (!state.hexel_present.test(h))
            ++injury.hexels_removed;
        else if (state.damage[cell] >= 1.0f)
            ++injury.hexels_damaged;
    }
    for (Injury& injury : by_material_) {
        const std::int64_t hurt = injury.hexels_removed + injury.hexels_damaged;
        injury.volume_m3 = static_cast<double>(hurt) * model.hexel_volume_m3();
        if (hurt > 0 && injury.first_time_s < 0.0) injury.first_time_s = time_s;
    }
}

std::vector<Injury> InjuryWatch::injuries() const {
    std::vector<Injury> found;
    for (const Injury& injury : by_material_)
        if (injury.hexels_removed + injury.hexels_damaged > 0) found.push_back(injury);
    return found;
}

}  // namespace calot::app

#include "calot/deformation/ghosts.h"

#include <algorithm>

#include "calot/deformation/links.h"

namespace calot::deformation {

void list_ghosts(const tissue::Model& model, Work& work) {
    work.mirrors.clear();
    work.mirrors.reserve(static_cast<std::size_t>(model.phyxel_ghost.count()));
    for (std::int64_t p = model.phyxels.first; p < model.phyxels.last; ++p)
        if (model.phyxel_ghost.test(p)) work.mirrors.push_back({static_cast<std::int32_t>(p), 0, {}, {}});
}

const Mirror& find_mirror(const Work& work, std::int64_t ghost) {
    return *std::lower_bound(work.mirrors.begin(), work.mirrors.end(), ghost,
                             [](const Mirror& mirror, std::int64_t cell) { return mirror.ghost < cell; });
}

void refresh_mirror(const tissue::Model& model, const tissue::State& state, Work& work, std::int64_t ghost) {
    Mirror& mirror = const_cast<Mirror&>(find_mirror(work, ghost));
    mirror.count = 0;
    for (const double wanted : {kFaceWeight, kEdgeWeight}) {
        if (mirror.count > 0) break;
        for_each_link(model.phyxels, state.links, ghost, [&](std::int64_t other, const Int3&, double weight) {
            if (weight == wanted && state.phyxel_present.test(other))
                mirror.phyxel[static_cast<std::size_t>(mirror.count++)] = static_cast<std::int32_t>(other);
        });
    }
}

void move_ghosts(tissue::State& state, const Work& work) {
    for (const Mirror& mirror : work.mirrors) {
        const auto ghost = static_cast<std::size_t>(mirror.ghost);
        const float share = mirror.count > 0 ? 1.0f / static_cast<float>(mirror.count) : 0.0f;
        for (std::size_t r = 0; r < 3; ++r) {
            Array<float>& u = state.displacement_m[r];
            float sum = 0.0f;
            for (int k = 0; k < mirror.count; ++k)
                sum += u[static_cast<std::size_t>(mirror.phyxel[static_cast<std::size_t>(k)])];
            u[ghost] = mirror.count > 0 ? 2.0f * mirror.face_m[r] - share * sum : mirror.face_m[r];
        }
    }
}

void return_ghost_impulses(tissue::State& state, const Work& work, float decay) {
    for (const Mirror& mirror : work.mirrors) {
        const auto ghost = static_cast<std::size_t>(mirror.ghost);
        const float share = mirror.count > 0 ? -decay / static_cast<float>(mirror.count) : 0.0f;
        for (int k = 0; k < mirror.count; ++k) {
            const auto p = static_cast<std::size_t>(mirror.phyxel[static_cast<std::size_t>(k)]);
            const float gain = share * work.inverse_mass_per_kg[p];
            for (auto& v : state.velocity_m_per_s) v[p] += gain * v[ghost];
        }
        for (auto& v : state.velocity_m_per_s) v[ghost] = 0.0f;
    }
}

}  // namespace calot::deformation

#pragma once
// A burn of a body of several tissues, for tests of budgets and of determinism.

#include <gtest/gtest.h>

#include "calot/validation/heat_rig.h"

namespace calot::thermal {

/// Fat over liver with an artery through it, in a lattice whose fastest axis is not x. Its floor is held.
inline tissue::Model burn_model(const Int3& size = {40, 34, 22},
                                tissue::PhaseModel phase = tissue::PhaseModel::water_then_solids) {
    const auto all = tissue::default_materials();
    std::vector<tissue::Material> real;
    for (const char* name : {"fat", "liver", "cystic_artery"}) real.push_back(all[tissue::find_material(all, name)]);
    tissue::Model model = box_model(size, 0.6e-3, 1e-3, real, [&](const Int3& c) -> tissue::MaterialIndex {
        if (c.z == 0 || c.z >= size.z - 2 || c.x < 2) return tissue::kNoMaterial;
        const int dy = c.y - size.y / 2, dz = c.z - size.z / 2;
        if (dy * dy + dz * dz <= 9) return 3;
        return c.z < size.z / 2 ? 2 : 1;
    });
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) model.hexel_held.set(model.hexels.index(x, y, 0));
    model.thermal.refresh_ticks = tissue::ThermalParameters{}.refresh_ticks;
    model.thermal.phase_model = phase;
    return model;
}

/// Heat that falls off as 1/r^4 from a spot on the surface which moves along x.
inline void heat_spot(HeatRun& run, std::int64_t tick) {
    const Int3 size = run.model.hexels.size, box(16);
    run.exchange.joule.outflow_W = 10.0;
    const Vec3 spot(6.0 + 0.01 * static_cast<double>(tick), 0.5 * size.y, size.z - 3.0);
    run.set_joule(Int3(spot) - 8, box, [&](const Int3& c) {
        const Vec3 d = Vec3(c) - spot;
        return 2e10 / std::pow(1.0 + 0.3 * glm::dot(d, d), 2.0);
    });
}

/// A tick of the burn; heat is given for the first 1.6 s and set anew every 8 ticks.
inline void burn_tick(HeatRun& run) {
    if (run.state.tick >= 1600)
        run.exchange.joule.size = Int3(0);
    else if (run.state.tick % 8 == 0)
        heat_spot(run, run.state.tick);
    run.tick();
}

}  // namespace calot::thermal

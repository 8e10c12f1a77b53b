#pragma once
// A small operating field from analytic solids: fat with a duct and an artery in it, liver, gallbladder, backdrop, a
// burnt crater and the hook. Enough to look at every look without the simulation.

#include <memory>

#include "calot/render/view.h"
#include "calot/surface/surface.h"
#include "calot/tissue/model.h"
#include "calot/tissue/state.h"

namespace calot::render::demo {

struct Scene {
    tissue::Model model;
    tissue::State state;
    Array<float> temperature_K;
    std::vector<OrganMesh> organs;

    explicit Scene(double hexel_spacing_m);
    /// Heats and removes fat about the fat window, as a hook would.
    void burn(const Vec3& centre_m, double radius_m);
    View view() const;
    static std::vector<tissue::Capsule> hook(const Vec3& tip_m);
};

inline const Vec3 kCrater_m(0.004, -0.002, 0.0);

}  // namespace calot::render::demo

#pragma once
// Where the current comes from and goes to beyond the window.
//
// Return electrode at a place: beyond the window the potential is taken as that of a source at the tip and a sink at
// r2, which ends on a disc of radius a_p:  phi ~ 1/r1 - 1/r2 + 1/a_p - 1/D  with D their distance. Then
//     a = s (n.r1/r1^3 - n.r2/r2^3) / (1/r1 - 1/r2 + 1/a_p - 1/D), at least 0
// which is s n.r/r^2 for a return far away.

#include <algorithm>
#include <cmath>

#include "calot/base/vec.h"
#include "calot/electric/window.h"
#include "calot/tissue/model.h"

namespace calot::electric {

/// In cells of the window.
struct Poles {
    Vec3f source{0.0f}, sink{0.0f};
    float rest = 0.0f;  ///< 1/a_p - 1/D
    bool placed = false;

    /// a / (1 + a/2): of the conductance of half a cell and beyond, in units of sigma.
    float share(const Vec3f& face, int axis, float side) const {
        const Vec3f r1 = face - source;
        const float d1 = glm::dot(r1, r1), through = std::max(0.0f, side * r1[axis]);
        if (!placed) return through / (d1 + 0.5f * through);
        const Vec3f r2 = face - sink;
        const float d2 = std::max(glm::dot(r2, r2), 1.0f), i1 = 1.0f / std::sqrt(d1), i2 = 1.0f / std::sqrt(d2);
        const float slope = std::max(0.0f, through * i1 / d1 - side * r2[axis] * i2 / d2), level = i1 - i2 + rest;
        return level > 0.0f ? slope / (level + 0.5f * slope) : 0.0f;
    }
};

/// `centre`: of what current enters, window coordinates.
inline Poles find_poles(const tissue::Model& model, const Window& window, const Vec3& centre) {
    const tissue::ElectricParameters& p = model.electric;
    Poles poles;
    poles.source = Vec3f(centre);
    if (!p.return_placed) return poles;
    const double s = model.hexels.spacing_m;
    const Vec3 there = (p.return_m - model.hexels.centre_m(model.hexels.index(Int3(0)))) / s - Vec3(window.low);
    for (int k = 0; k < 3; ++k) poles.sink[k] = static_cast<float>(there[window.axis[k]]);
    const float distance = glm::length(poles.sink - poles.source);
    poles.rest = static_cast<float>(s / p.return_radius_m) - 1.0f / std::max(distance, 1.0f);
    poles.placed = true;
    return poles;
}

}  // namespace calot::electric

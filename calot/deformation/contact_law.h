#pragma once
// One point's law, with all other points as they are (contact.h).

#include <cmath>

#include "calot/deformation/contact.h"

namespace calot::deformation {

/// The impulse [N s] of a touching point whose velocity is `velocity`, of which `coupling` times its present impulse is
/// its own doing: a one-sided spring, and friction that sticks if it suffices, else slides.
inline Vec3f touching_impulse(const ContactPoint& point, const Vec3f& velocity, float coupling, float friction,
                              float dt) {
    const Vec3f relative = velocity - point.tool_velocity_m_per_s;
    const float closing = glm::dot(relative, point.normal);
    const float before = glm::dot(point.impulse_Ns, point.normal);
    const float without = closing - coupling * before;
    const float stiffness = point.stiffness_N_per_m;
    const float wanted = -stiffness * dt * (point.gap_m + dt * without) / (1.0f + stiffness * dt * dt * coupling);
    if (!(wanted > 0.0f)) return Vec3f(0.0f);
    Vec3f tangential =
        (point.impulse_Ns - before * point.normal) - (relative - closing * point.normal) * (1.0f / coupling);
    const float most = friction * wanted, length2 = glm::dot(tangential, tangential);
    if (length2 > most * most) tangential *= most / std::sqrt(length2);
    return wanted * point.normal + tangential;
}

/// The impulse of a held point: a spring to where it is held, in all directions, that gives no more than its limit.
inline Vec3f holding_impulse(const ContactPoint& point, const Vec3f& velocity, float coupling, float dt) {
    const Vec3f without = velocity - point.tool_velocity_m_per_s - coupling * point.impulse_Ns;
    const float stiffness = point.stiffness_N_per_m;
    const Vec3f wanted = (point.away_m + dt * without) * (-stiffness * dt / (1.0f + stiffness * dt * dt * coupling));
    const float most = point.most_force_N * dt, length2 = glm::dot(wanted, wanted);
    return length2 > most * most ? wanted * (most / std::sqrt(length2)) : wanted;
}

}  // namespace calot::deformation

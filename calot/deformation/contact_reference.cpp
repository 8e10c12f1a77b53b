// Plainly what contact_simd.cpp does a vector at a time.

#include "calot/deformation/contact_kernel.h"
#include "calot/deformation/contact_law.h"

namespace calot::deformation::reference {

namespace {

const float* line(const ContactWork& contact, std::size_t point) {
    return contact.psi.data() + point * static_cast<std::size_t>(contact.stride);
}

template <class Term>
float sum_over(std::int32_t first, std::int32_t end, const Term& term) {
    std::array<float, kContactLanes> sum{};
    for (std::int32_t row = first; row < end; row += kContactLanes)
        for (std::size_t lane = 0; lane < kContactLanes; ++lane)
            sum[lane] = sum[lane] + term(static_cast<std::size_t>(row) + lane);
    for (std::size_t half = kContactLanes / 2; half > 0; half /= 2)
        for (std::size_t lane = 0; lane < half; ++lane) sum[lane] = sum[lane] + sum[lane + half];
    return sum[0];
}

void push(ContactWork& contact, std::size_t c, const Vec3f& impulse) {
    for (std::size_t d = 0; d < contact.points.size(); ++d)
        for (std::size_t r = 0; r < 3; ++r)
            contact.velocity_m_per_s[r][d] +=
                contact.coupling_per_kg[c * kMaxPoints + d] * impulse[static_cast<int>(r)];
}

}  // namespace

void couple_points(ContactWork& contact) {
    for (std::size_t c = 0; c < contact.points.size(); ++c)
        for (std::size_t d = 0; d <= c; ++d) {
            const ContactPoint &a = contact.points[c], &b = contact.points[d];
            const float* psi_a = line(contact, c);
            const float* psi_b = line(contact, d);
            const float value = sum_over(std::max(a.first, b.first), std::min(a.end, b.end), [&](std::size_t row) {
                return psi_a[row] * contact.inverse_mass_per_kg[row] * psi_b[row];
            });
            contact.coupling_per_kg[c * kMaxPoints + d] = contact.coupling_per_kg[d * kMaxPoints + c] = value;
        }
}

void gather_point_velocities(ContactWork& contact) {
    for (std::size_t c = 0; c < contact.points.size(); ++c)
        for (std::size_t r = 0; r < 3; ++r)
            contact.velocity_m_per_s[r][c] =
                sum_over(contact.points[c].first, contact.points[c].end,
                         [&](std::size_t row) { return line(contact, c)[row] * contact.row_velocity_m_per_s[r][row]; });
}

void push_all_points(ContactWork& contact) {
    for (std::size_t c = 0; c < contact.points.size(); ++c)
        if (contact.points[c].impulse_Ns != Vec3f(0.0f)) push(contact, c, contact.points[c].impulse_Ns);
}

void sweep_points(ContactWork& contact, int sweeps, float friction, float substep_s) {
    for (int sweep = 0; sweep < sweeps; ++sweep)
        for (std::size_t c = 0; c < contact.points.size(); ++c) {
            ContactPoint& point = contact.points[c];
            const float coupling = contact.coupling_per_kg[c * kMaxPoints + c];
            if (coupling <= 0.0f) continue;  // nothing that moves carries it
            const Vec3f velocity(contact.velocity_m_per_s[0][c], contact.velocity_m_per_s[1][c],
                                 contact.velocity_m_per_s[2][c]);
            const Vec3f impulse = point.held() ? holding_impulse(point, velocity, coupling, substep_s)
                                               : touching_impulse(point, velocity, coupling, friction, substep_s);
            const Vec3f more = impulse - point.impulse_Ns;
            point.impulse_Ns = impulse;
            if (more != Vec3f(0.0f)) push(contact, c, more);
        }
}

void spread_impulses(ContactWork& contact) {
    for (std::size_t r = 0; r < 3; ++r)
        for (std::size_t row = 0; row < static_cast<std::size_t>(contact.stride); ++row)
            contact.row_impulse_Ns[r][row] = 0.0f;
    for (std::size_t c = 0; c < contact.points.size(); ++c) {
        const ContactPoint& point = contact.points[c];
        if (point.impulse_Ns == Vec3f(0.0f)) continue;
        for (auto row = static_cast<std::size_t>(point.first); row < static_cast<std::size_t>(point.end); ++row)
            for (std::size_t r = 0; r < 3; ++r)
                contact.row_impulse_Ns[r][row] += line(contact, c)[row] * point.impulse_Ns[static_cast<int>(r)];
    }
}

}  // namespace calot::deformation::reference

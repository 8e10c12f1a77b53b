// Contact's dense lines a vector at a time (contact_kernel.h); contact_reference.cpp has the same plainly.

#include <algorithm>

#include "calot/deformation/contact_kernel.h"
#include "calot/deformation/contact_law.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "calot/deformation/contact_simd.cpp"
#include <hwy/foreach_target.h>

#include "calot/base/simd.h"

HWY_BEFORE_NAMESPACE();
namespace calot::deformation {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = calot::HWY_NAMESPACE::simd::Floats;
constexpr std::int32_t kLanes = kContactLanes;

/// Sixteen partial sums, in as many vectors as they take, and their sum as a tree.
struct Partial {
    alignas(64) float sum[kLanes];
    HWY_INLINE float total() {
        for (int half = kLanes / 2; half > 0; half /= 2)
            for (int lane = 0; lane < half; ++lane) sum[lane] = sum[lane] + sum[lane + half];
        return sum[0];
    }
};

HWY_INLINE const float* line(const ContactWork& contact, std::size_t point) {
    return contact.psi.data() + point * static_cast<std::size_t>(contact.stride);
}

/// W_cd for d = d0 .. d0 + 3 at once: four chains of additions. `scaled` = psi_c / m over c's range.
HWY_INLINE void couple_four(ContactWork& contact, const float* scaled, std::size_t c, std::size_t d0) {
    const D d;
    const auto n = static_cast<std::int32_t>(hn::Lanes(d));
    const ContactPoint& point = contact.points[c];
    std::int32_t first = point.end, end = point.first;
    const std::size_t last = std::min(d0 + 4, c + 1);
    for (std::size_t k = d0; k < last; ++k) {
        first = std::min(first, contact.points[k].first);
        end = std::max(end, contact.points[k].end);
    }
    first = std::max(first, point.first);
    end = std::min(end, point.end);
    // Lines of points past `last` are read, not used.
    const float* lines[4];
    for (std::size_t k = 0; k < 4; ++k) lines[k] = line(contact, std::min(d0 + k, last - 1));
    Partial sums[4];
    for (std::int32_t o = 0; o < kLanes; o += n) {
        auto s0 = hn::Zero(d), s1 = s0, s2 = s0, s3 = s0;
        for (std::int32_t row = first + o; row < end; row += kLanes) {
            const auto a = hn::Load(d, scaled + row);
            s0 = hn::Add(s0, hn::Mul(a, hn::Load(d, lines[0] + row)));
            s1 = hn::Add(s1, hn::Mul(a, hn::Load(d, lines[1] + row)));
            s2 = hn::Add(s2, hn::Mul(a, hn::Load(d, lines[2] + row)));
            s3 = hn::Add(s3, hn::Mul(a, hn::Load(d, lines[3] + row)));
        }
        hn::Store(s0, d, sums[0].sum + o);
        hn::Store(s1, d, sums[1].sum + o);
        hn::Store(s2, d, sums[2].sum + o);
        hn::Store(s3, d, sums[3].sum + o);
    }
    for (std::size_t k = d0; k < last; ++k) {
        const float value = first < end ? sums[k - d0].total() : 0.0f;
        contact.coupling_per_kg[c * kMaxPoints + k] = contact.coupling_per_kg[k * kMaxPoints + c] = value;
    }
}

void couple(ContactWork& contact) {
    const D d;
    const auto n = static_cast<std::int32_t>(hn::Lanes(d));
    float* scaled = contact.row_impulse_Ns[0].data();  // free at this time
    for (std::size_t c = 0; c < contact.points.size(); ++c) {
        const ContactPoint& point = contact.points[c];
        for (std::int32_t row = point.first; row < point.end; row += n)
            hn::Store(
                hn::Mul(hn::Load(d, line(contact, c) + row), hn::Load(d, contact.inverse_mass_per_kg.data() + row)), d,
                scaled + row);
        for (std::size_t other = 0; other <= c; other += 4) couple_four(contact, scaled, c, other);
    }
}

void gather(ContactWork& contact) {
    const D d;
    const auto n = static_cast<std::int32_t>(hn::Lanes(d));
    const float* x = contact.row_velocity_m_per_s[0].data();
    const float* y = contact.row_velocity_m_per_s[1].data();
    const float* z = contact.row_velocity_m_per_s[2].data();
    for (std::size_t c = 0; c < contact.points.size(); ++c) {
        const ContactPoint& point = contact.points[c];
        const float* psi = line(contact, c);
        Partial sums[3];
        for (std::int32_t o = 0; o < kLanes; o += n) {
            auto sx = hn::Zero(d), sy = sx, sz = sx;
            for (std::int32_t row = point.first + o; row < point.end; row += kLanes) {
                const auto share = hn::Load(d, psi + row);
                sx = hn::Add(sx, hn::Mul(share, hn::Load(d, x + row)));
                sy = hn::Add(sy, hn::Mul(share, hn::Load(d, y + row)));
                sz = hn::Add(sz, hn::Mul(share, hn::Load(d, z + row)));
            }
            hn::Store(sx, d, sums[0].sum + o);
            hn::Store(sy, d, sums[1].sum + o);
            hn::Store(sz, d, sums[2].sum + o);
        }
        for (std::size_t r = 0; r < 3; ++r) contact.velocity_m_per_s[r][c] = sums[r].total();
    }
}

/// An impulse more at point c moves all points.
HWY_INLINE void push(ContactWork& contact, std::size_t c, const Vec3f& impulse) {
    const D d;
    const float* coupling = contact.coupling_per_kg.data() + c * kMaxPoints;
    float* x = contact.velocity_m_per_s[0].data();
    float* y = contact.velocity_m_per_s[1].data();
    float* z = contact.velocity_m_per_s[2].data();
    const auto px = hn::Set(d, impulse.x), py = hn::Set(d, impulse.y), pz = hn::Set(d, impulse.z);
    for (std::size_t k = 0; k < contact.points.size(); k += hn::Lanes(d)) {
        const auto w = hn::Load(d, coupling + k);
        hn::Store(hn::Add(hn::Load(d, x + k), hn::Mul(w, px)), d, x + k);
        hn::Store(hn::Add(hn::Load(d, y + k), hn::Mul(w, py)), d, y + k);
        hn::Store(hn::Add(hn::Load(d, z + k), hn::Mul(w, pz)), d, z + k);
    }
}

void push_all(ContactWork& contact) {
    for (std::size_t c = 0; c < contact.points.size(); ++c)
        if (contact.points[c].impulse_Ns != Vec3f(0.0f)) push(contact, c, contact.points[c].impulse_Ns);
}

void sweep(ContactWork& contact, int sweeps, float friction, float substep_s) {
    for (int k = 0; k < sweeps; ++k)
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

void spread(ContactWork& contact) {
    const D d;
    const auto n = static_cast<std::int32_t>(hn::Lanes(d));
    float* rows[3];
    for (std::size_t r = 0; r < 3; ++r) {
        rows[r] = contact.row_impulse_Ns[r].data();
        std::fill(rows[r], rows[r] + contact.stride, 0.0f);
    }
    for (std::size_t c = 0; c < contact.points.size(); ++c) {
        const ContactPoint& point = contact.points[c];
        if (point.impulse_Ns == Vec3f(0.0f)) continue;
        const float* psi = line(contact, c);
        const auto px = hn::Set(d, point.impulse_Ns.x), py = hn::Set(d, point.impulse_Ns.y),
                   pz = hn::Set(d, point.impulse_Ns.z);
        for (std::int32_t row = point.first; row < point.end; row += n) {
            const auto share = hn::Load(d, psi + row);
            hn::Store(hn::Add(hn::Load(d, rows[0] + row), hn::Mul(share, px)), d, rows[0] + row);
            hn::Store(hn::Add(hn::Load(d, rows[1] + row), hn::Mul(share, py)), d, rows[1] + row);
            hn::Store(hn::Add(hn::Load(d, rows[2] + row), hn::Mul(share, pz)), d, rows[2] + row);
        }
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace calot::deformation
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace calot::deformation {

HWY_EXPORT(couple);
HWY_EXPORT(gather);
HWY_EXPORT(push_all);
HWY_EXPORT(sweep);
HWY_EXPORT(spread);

void couple_points(ContactWork& contact) {
    HWY_DYNAMIC_DISPATCH(couple)(contact);
}
void gather_point_velocities(ContactWork& contact) {
    HWY_DYNAMIC_DISPATCH(gather)(contact);
}
void push_all_points(ContactWork& contact) {
    HWY_DYNAMIC_DISPATCH(push_all)(contact);
}
void sweep_points(ContactWork& contact, int sweeps, float friction, float substep_s) {
    HWY_DYNAMIC_DISPATCH(sweep)(contact, sweeps, friction, substep_s);
}
void spread_impulses(ContactWork& contact) {
    HWY_DYNAMIC_DISPATCH(spread)(contact);
}

}  // namespace calot::deformation
#endif

// The elastic kernels, a vector of neighbouring cells at a time (kernel.h, reference.h).
//
// A neighbour in direction d lies at a constant offset, so its values are one load at i + offset[d] and, the other way,
// at i - offset[d]; a link is a bit, so the links of a vector of cells are one mask. The link towards -d is the bit of
// the cell at i - offset[d]. Absent neighbours add exact zeros.
//
//      links[d] bits:  ... 1 1 0 1 1 1 0 0 ...      lanes of cell i .. i + N - 1
//                          |     plus = bits at i, minus = bits at i - offset[d]
//
// Sums run over faces first (weight 8, applied once), then edges (weight 1). Lengths are in units of the spacing s
// until the end. Multiplication and addition stay separate so that instruction sets with and without fused
// multiply-add give the same bytes.

#include "calot/deformation/kernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "calot/deformation/kernel_simd.cpp"
#include <hwy/foreach_target.h>

#include "calot/base/simd.h"

HWY_BEFORE_NAMESPACE();
namespace calot::deformation {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace simd = calot::HWY_NAMESPACE::simd;

using D = simd::Floats;
using Mask = hn::Mask<D>;

/// A vector of floats with ordinary arithmetic.
struct Lanes {
    hn::Vec<D> v;
};
HWY_INLINE Lanes operator+(Lanes a, Lanes b) {
    return {hn::Add(a.v, b.v)};
}
HWY_INLINE Lanes operator-(Lanes a, Lanes b) {
    return {hn::Sub(a.v, b.v)};
}
HWY_INLINE Lanes operator*(Lanes a, Lanes b) {
    return {hn::Mul(a.v, b.v)};
}
HWY_INLINE Lanes load(const float* p) {
    return {hn::LoadU(D(), p)};
}
HWY_INLINE void store(Lanes a, float* p) {
    hn::StoreU(a.v, D(), p);
}
HWY_INLINE Lanes all(float value) {
    return {hn::Set(D(), value)};
}
HWY_INLINE Lanes where(Mask mask, Lanes a) {
    return {hn::IfThenElseZero(mask, a.v)};
}

/// Columns of the nine positive directions: an edge step is e[first] + sign e[second].
template <int d>
struct Direction {
    static constexpr Int3 step = tissue::kLinkDirections[d];
    static constexpr bool face = d < tissue::kFaceDirections;
    static constexpr int first = step.x != 0 ? 0 : step.y != 0 ? 1 : 2;
    static constexpr int second = step.z != 0 ? 2 : step.y != 0 ? 1 : 0;
    static constexpr bool falling = step.y < 0 || step.z < 0;  ///< sign = -1
};

/// a + sign b along an edge.
template <int d>
HWY_INLINE Lanes along(Lanes a, Lanes b) {
    return Direction<d>::falling ? a - b : a + b;
}

/// Both links of a direction for the cells from i on.
struct LinkPair {
    Mask plus, minus;
};
template <int d>
HWY_INLINE LinkPair links_of(const KernelView& k, std::int64_t i) {
    return {simd::mask_at(D(), k.links[d], i), simd::mask_at(D(), k.links[d], i - k.offset[d])};
}

// ---- Gradients

/// Adds the links along one direction to B [displacement x step].
template <int d>
HWY_INLINE void add_to_b(const KernelView& k, std::int64_t i, const Lanes (&u)[3], Lanes (&b)[9]) {
    using Dir = Direction<d>;
    const LinkPair link = links_of<d>(k, i);
    const std::int64_t offset = k.offset[d];
    for (int r = 0; r < 3; ++r) {
        const float* p = k.displacement_m[r] + i;
        const Lanes difference = where(link.plus, load(p + offset) - u[r]) - where(link.minus, load(p - offset) - u[r]);
        if constexpr (Dir::face) {
            b[3 * r + Dir::first] = all(static_cast<float>(8)) * difference;
        } else {
            b[3 * r + Dir::first] = b[3 * r + Dir::first] + difference;
            b[3 * r + Dir::second] = along<d>(b[3 * r + Dir::second], difference);
        }
    }
}

/// c = a b with b symmetric (xx xy xz yy yz zz).
HWY_INLINE void multiply_symmetric(const Lanes (&a)[9], const Lanes (&b)[6], Lanes (&c)[9]) {
    for (int r = 0; r < 3; ++r) {
        const Lanes x = a[3 * r], y = a[3 * r + 1], z = a[3 * r + 2];
        c[3 * r] = x * b[0] + y * b[1] + z * b[2];
        c[3 * r + 1] = x * b[1] + y * b[3] + z * b[4];
        c[3 * r + 2] = x * b[2] + y * b[4] + z * b[5];
    }
}

/// cof G, row-major.
HWY_INLINE void cofactor(const Lanes (&g)[9], Lanes (&c)[9]) {
    c[0] = g[4] * g[8] - g[5] * g[7];
    c[1] = g[5] * g[6] - g[3] * g[8];
    c[2] = g[3] * g[7] - g[4] * g[6];
    c[3] = g[2] * g[7] - g[1] * g[8];
    c[4] = g[0] * g[8] - g[2] * g[6];
    c[5] = g[1] * g[6] - g[0] * g[7];
    c[6] = g[1] * g[5] - g[2] * g[4];
    c[7] = g[2] * g[3] - g[0] * g[5];
    c[8] = g[0] * g[4] - g[1] * g[3];
}

/// First Piola-Kirchhoff stress; law.h has the equations.
template <tissue::ElasticLaw law>
HWY_INLINE void stress(const KernelView& k, const Lanes (&g)[9], Lanes mu, Lanes lambda, Lanes (&p)[9]) {
    Lanes cofactor_g[9], cofactor_f[9], difference[9];
    cofactor(g, cofactor_g);
    const Lanes trace = g[0] + g[4] + g[8];
    const Lanes minors = cofactor_g[0] + cofactor_g[4] + cofactor_g[8];
    const Lanes det = g[0] * cofactor_g[0] + g[1] * cofactor_g[1] + g[2] * cofactor_g[2];
    const Lanes change = trace + minors + det;  // J - 1
    for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c) {
            const int rc = 3 * r + c, cr = 3 * c + r;
            const Lanes on_diagonal = r == c ? trace : all(0.0f);
            difference[rc] = g[rc] + g[cr] - on_diagonal - cofactor_g[rc];  // F - cof F
            const Lanes f = r == c ? all(1.0f) + g[rc] : g[rc];
            cofactor_f[rc] = f - difference[rc];
        }
    if constexpr (law == tissue::ElasticLaw::stable_neo_hookean) {
        const Lanes pressure = (lambda + mu) * change;
        for (int e = 0; e < 9; ++e) p[e] = mu * difference[e] + pressure * cofactor_f[e];
    } else {
        Lanes second[6];  // S = lambda tr(E) 1 + 2 mu E, xx xy xz yy yz zz
        constexpr int kRow[6] = {0, 0, 0, 1, 1, 2}, kColumn[6] = {0, 1, 2, 1, 2, 2};
        for (int e = 0; e < 6; ++e) {
            const int a = kRow[e], b = kColumn[e];
            const Lanes square = g[a] * g[b] + g[3 + a] * g[3 + b] + g[6 + a] * g[6 + b];
            second[e] = all(0.5f) * (g[3 * a + b] + g[3 * b + a] + square);
        }
        const Lanes pressure = lambda * (second[0] + second[3] + second[5]);
        for (int e = 0; e < 6; ++e) {
            const Lanes deviatoric = (mu + mu) * second[e];
            second[e] = kRow[e] == kColumn[e] ? deviatoric + pressure : deviatoric;
        }
        Lanes f[9];
        for (int e = 0; e < 9; ++e) f[e] = e % 4 == 0 ? all(1.0f) + g[e] : g[e];
        multiply_symmetric(f, second, p);
        const Lanes bulk = all(k.volume_stiffness_Pa) * change;
        for (int e = 0; e < 9; ++e) p[e] = p[e] + bulk * cofactor_f[e];
    }
}

template <tissue::ElasticLaw law>
HWY_INLINE void gradients_of(const KernelView& k, std::int64_t i) {
    Lanes u[3], b[9], inverse[6], g[9], p[9], m[9];
    for (int r = 0; r < 3; ++r) u[r] = load(k.displacement_m[r] + i);
    add_to_b<0>(k, i, u, b);
    add_to_b<1>(k, i, u, b);
    add_to_b<2>(k, i, u, b);
    add_to_b<3>(k, i, u, b);
    add_to_b<4>(k, i, u, b);
    add_to_b<5>(k, i, u, b);
    add_to_b<6>(k, i, u, b);
    add_to_b<7>(k, i, u, b);
    add_to_b<8>(k, i, u, b);
    const Lanes spacing = all(k.spacing_m);
    for (int e = 0; e < 6; ++e) inverse[e] = load(k.moment_inverse[e] + i);
    for (int e = 0; e < 9; ++e) b[e] = spacing * b[e];
    multiply_symmetric(b, inverse, g);
    stress<law>(k, g, load(k.lame_mu_Pa + i), load(k.lame_lambda_Pa + i), p);
    const Lanes volume = load(k.volume_m3 + i), hourglass = load(k.hourglass + i);
    for (int e = 0; e < 6; ++e) inverse[e] = volume * inverse[e];
    multiply_symmetric(p, inverse, m);
    for (int e = 0; e < 9; ++e) {
        store(g[e], k.gradient[e] + i);
        store(m[e] - hourglass * g[e], k.moment_stress[e] + i);
    }
}

/// Calls body(i) for the vectors of all groups in which `first` or `second` has a bit.
template <class Body>
HWY_INLINE void for_each_vector(Groups groups, const std::uint8_t* first, const std::uint8_t* second,
                                const Body& body) {
    const auto lanes = static_cast<std::int64_t>(hn::Lanes(D()));
    for (const std::int32_t group : groups)
        for (std::int64_t i = group; i < group + kGroupCells; i += lanes)
            if ((simd::bits_at(D(), first, i) | simd::bits_at(D(), second, i)) != 0) body(i);
}

void gradients(const KernelView& k, Groups groups) {
    if (k.law == tissue::ElasticLaw::stable_neo_hookean)
        for_each_vector(groups, k.present, k.ghost,
                        [&](std::int64_t i) HWY_ATTR { gradients_of<tissue::ElasticLaw::stable_neo_hookean>(k, i); });
    else
        for_each_vector(groups, k.present, k.ghost, [&](std::int64_t i) HWY_ATTR {
            gradients_of<tissue::ElasticLaw::saint_venant_kirchhoff>(k, i);
        });
}

// ---- Forces and velocities

struct Sums {
    Lanes stress[3];     ///< sum w M_j X_ij / s
    Lanes hourglass[3];  ///< sum w (kappa_i + kappa_j) u_ij
    Lanes step[3];       ///< sum w X_ij / s
};

/// One end of a link: M_j and kappa_j of the neighbour at j.
template <int d>
HWY_INLINE void add_end(const KernelView& k, std::int64_t i, std::int64_t j, Mask mask, const Lanes (&u)[3],
                        Lanes hourglass, Lanes (&stress)[3], Sums& sums) {
    using Dir = Direction<d>;
    const Lanes stiffness = where(mask, hourglass + load(k.hourglass + j));
    static_cast<void>(i);
    for (int r = 0; r < 3; ++r) {
        const Lanes first = load(k.moment_stress[3 * r + Dir::first] + j);
        if constexpr (Dir::face)
            stress[r] = where(mask, first);
        else
            stress[r] = where(mask, along<d>(first, load(k.moment_stress[3 * r + Dir::second] + j)));
        sums.hourglass[r] = sums.hourglass[r] + stiffness * (load(k.displacement_m[r] + j) - u[r]);
    }
}

template <int d>
HWY_INLINE void add_to_sums(const KernelView& k, std::int64_t i, const Lanes (&u)[3], Lanes hourglass, Sums& sums) {
    using Dir = Direction<d>;
    const LinkPair link = links_of<d>(k, i);
    Lanes plus[3], minus[3];
    add_end<d>(k, i, i + k.offset[d], link.plus, u, hourglass, plus, sums);
    add_end<d>(k, i, i - k.offset[d], link.minus, u, hourglass, minus, sums);
    for (int r = 0; r < 3; ++r) sums.stress[r] = sums.stress[r] + (plus[r] - minus[r]);
    const Lanes excess = where(link.plus, all(1.0f)) - where(link.minus, all(1.0f));
    sums.step[Dir::first] = sums.step[Dir::first] + excess;
    if constexpr (!Dir::face) sums.step[Dir::second] = along<d>(sums.step[Dir::second], excess);
}

HWY_INLINE void velocities_of(const KernelView& k, std::int64_t i, Mask present, Mask ghost) {
    Lanes u[3];
    Sums sums;
    for (int r = 0; r < 3; ++r) {
        u[r] = load(k.displacement_m[r] + i);
        sums.stress[r] = sums.hourglass[r] = sums.step[r] = all(0.0f);
    }
    const Lanes hourglass = load(k.hourglass + i);
    add_to_sums<0>(k, i, u, hourglass, sums);
    add_to_sums<1>(k, i, u, hourglass, sums);
    add_to_sums<2>(k, i, u, hourglass, sums);
    const Lanes face_weight = all(8.0f);
    for (int r = 0; r < 3; ++r) {
        sums.stress[r] = face_weight * sums.stress[r];
        sums.hourglass[r] = face_weight * sums.hourglass[r];
        sums.step[r] = face_weight * sums.step[r];
    }
    add_to_sums<3>(k, i, u, hourglass, sums);
    add_to_sums<4>(k, i, u, hourglass, sums);
    add_to_sums<5>(k, i, u, hourglass, sums);
    add_to_sums<6>(k, i, u, hourglass, sums);
    add_to_sums<7>(k, i, u, hourglass, sums);
    add_to_sums<8>(k, i, u, hourglass, sums);
    const Lanes spacing = all(k.spacing_m), decay = all(k.decay);
    const Lanes inverse_mass = load(k.inverse_mass_per_kg + i), gravity_share = load(k.gravity_share + i);
    for (int r = 0; r < 3; ++r) {
        const float* m = k.moment_stress[3 * r] + i;
        const Lanes own = load(m) * sums.step[0] + load(k.moment_stress[3 * r + 1] + i) * sums.step[1] +
                          load(k.moment_stress[3 * r + 2] + i) * sums.step[2];
        const Lanes impulse = all(k.substep_s) * (spacing * (sums.stress[r] + own) + sums.hourglass[r]);
        float* v = k.velocity_m_per_s[r] + i;
        const Lanes gravity = all(k.gravity_step_m_per_s[static_cast<std::size_t>(r)]) * gravity_share;
        const Lanes velocity = decay * (load(v) + inverse_mass * impulse + gravity);
        store(where(present, velocity) + where(ghost, impulse), v);
    }
}

void velocities(const KernelView& k, Groups groups) {
    for_each_vector(groups, k.present, k.ghost, [&](std::int64_t i) HWY_ATTR {
        velocities_of(k, i, simd::mask_at(D(), k.present, i), simd::mask_at(D(), k.ghost, i));
    });
}

void displacements(const KernelView& k, Groups groups) {
    const Lanes dt = all(k.substep_s);
    for_each_vector(groups, k.present, k.present, [&](std::int64_t i) HWY_ATTR {
        for (int r = 0; r < 3; ++r) {
            float* u = k.displacement_m[r] + i;
            store(load(u) + dt * load(k.velocity_m_per_s[r] + i), u);
        }
    });
}

}  // namespace HWY_NAMESPACE
}  // namespace calot::deformation
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace calot::deformation {

HWY_EXPORT(gradients);
HWY_EXPORT(velocities);
HWY_EXPORT(displacements);

void sweep_gradients(const KernelView& view, Groups groups) {
    HWY_DYNAMIC_DISPATCH(gradients)(view, groups);
}
void sweep_velocities(const KernelView& view, Groups groups) {
    HWY_DYNAMIC_DISPATCH(velocities)(view, groups);
}
void sweep_displacements(const KernelView& view, Groups groups) {
    HWY_DYNAMIC_DISPATCH(displacements)(view, groups);
}

}  // namespace calot::deformation
#endif

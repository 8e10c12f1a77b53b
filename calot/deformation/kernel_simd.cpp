// The elastic kernels, a vector of neighbouring cells at a time (kernel.h, reference.h).
//
// A neighbour in direction d lies at a constant offset, so its values are one load at i + offset[d] and, the other way,
// at i - offset[d]; a link is a bit, so the links of a vector of cells are one mask, kept ready for every group of
// cells (Group). Absent neighbours add exact zeros.
//
//      Group::plus[d]:  ... 1 1 0 1 1 1 0 0 ...      lanes of cell i .. i + N - 1
//
// Sums run over faces first (their weight is applied once), then edges (weight 1). Lengths are in units of the spacing
// s until the end. Multiplication and addition stay separate so that instruction sets with and without fused
// multiply-add give the same bytes.
//
// What a substep costs, for 16 cells: 72 loads of neighbours' values in the gradient sweep (u and kappa at 18 places),
// 90 in the velocity sweep (a column of M at 6, two at 12), nearly all across a border of cache lines; 280 and 100
// additions, 170 and 30 multiplications. Additions bound the first, loads the second (docs/performance.md).

#include "calot/deformation/kernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "calot/deformation/kernel_simd.cpp"
#include <hwy/foreach_target.h>

#include "calot/base/simd.h"
#include "calot/deformation/links.h"

HWY_BEFORE_NAMESPACE();
namespace calot::deformation {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace simd = calot::HWY_NAMESPACE::simd;

using D = simd::Floats;
constexpr float kFace = static_cast<float>(kFaceWeight);  ///< edges weigh 1
using Mask = hn::Mask<D>;

/// A vector of floats with ordinary arithmetic. (Its constructors are written out: g++ makes others without the
/// target's options, and then cannot inline them on Arm.)
struct Lanes {
    hn::Vec<D> v;
    HWY_INLINE Lanes() {}
    HWY_INLINE Lanes(hn::Vec<D> value) : v(value) {}
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

/// A vector of cells: the first one's index, its group and its lane in there.
struct Place {
    std::int64_t i;
    Group& group;
    int lane;

    Mask mask(std::uint16_t bits) const { return simd::mask_of(D(), bits, lane); }
    template <int d>
    Mask plus() const {
        return mask(group.plus[d]);
    }
    template <int d>
    Mask minus() const {
        return mask(group.minus[d]);
    }
    /// Sets these lanes of one of the group's words.
    void mark(std::uint16_t& word, Mask lanes) const {
        const D d;
        std::uint8_t bytes[8] = {};
        hn::StoreMaskBits(d, lanes, bytes);
        const std::uint32_t all = ((1u << hn::Lanes(d)) - 1u) << lane;
        const std::uint32_t bits = (bytes[0] | static_cast<std::uint32_t>(bytes[1]) << 8) << lane;
        word = static_cast<std::uint16_t>((word & ~all) | bits);
    }
};

// ---- Gradients

/// Adds the links along one direction to B [displacement x step] and to the hourglass force.
template <int d>
HWY_INLINE void add_links(const KernelView& k, const Place& at, const Lanes (&u)[3], Lanes hourglass, Lanes (&b)[9],
                          Lanes (&force)[3]) {
    using Dir = Direction<d>;
    const std::int64_t offset = k.offset[d];
    const Mask plus = at.plus<d>(), minus = at.minus<d>();
    const Lanes stiffness_plus = hourglass + load(k.hourglass + at.i + offset);
    const Lanes stiffness_minus = hourglass + load(k.hourglass + at.i - offset);
    for (int r = 0; r < 3; ++r) {
        const float* p = k.displacement_m[r] + at.i;
        const Lanes up = where(plus, load(p + offset) - u[r]), down = where(minus, load(p - offset) - u[r]);
        const Lanes difference = up - down;
        force[r] = force[r] + (stiffness_plus * up + stiffness_minus * down);
        if constexpr (Dir::face) {
            b[3 * r + Dir::first] = all(kFace) * difference;
        } else {
            b[3 * r + Dir::first] = b[3 * r + Dir::first] + difference;
            b[3 * r + Dir::second] = along<d>(b[3 * r + Dir::second], difference);
        }
    }
}

/// B and the hourglass force of a vector of cells.
HWY_INLINE void add_all_links(const KernelView& k, const Place& at, Lanes hourglass, Lanes (&b)[9], Lanes (&force)[3]) {
    Lanes u[3];
    for (int r = 0; r < 3; ++r) {
        u[r] = load(k.displacement_m[r] + at.i);
        force[r] = all(0.0f);
    }
    add_links<0>(k, at, u, hourglass, b, force);
    add_links<1>(k, at, u, hourglass, b, force);
    add_links<2>(k, at, u, hourglass, b, force);
    for (int r = 0; r < 3; ++r) force[r] = all(kFace) * force[r];
    add_links<3>(k, at, u, hourglass, b, force);
    add_links<4>(k, at, u, hourglass, b, force);
    add_links<5>(k, at, u, hourglass, b, force);
    add_links<6>(k, at, u, hourglass, b, force);
    add_links<7>(k, at, u, hourglass, b, force);
    add_links<8>(k, at, u, hourglass, b, force);
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

/// Sum of the nine squares.
HWY_INLINE Lanes squares(const Lanes (&a)[9]) {
    Lanes sum = a[0] * a[0];
    for (int e = 1; e < 9; ++e) sum = sum + a[e] * a[e];
    return sum;
}

/// First Piola-Kirchhoff stress; law.h has the equations. Also cof F.
template <tissue::ElasticLaw law>
HWY_INLINE void stress(const KernelView& k, const Lanes (&g)[9], Lanes mu, Lanes lambda, Lanes (&p)[9],
                       Lanes (&cofactor_f)[9]) {
    Lanes cofactor_g[9], difference[9];
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

/// How far F stretches, for tear.cpp and stable_mass.h.
template <tissue::ElasticLaw law>
HWY_INLINE void measure_stretch(const KernelView& k, const Place& at, const Lanes (&g)[9],
                                const Lanes (&cofactor_f)[9]) {
    const D d;
    Lanes f[9];
    for (int e = 0; e < 9; ++e) f[e] = e % 4 == 0 ? all(1.0f) + g[e] : g[e];
    const Lanes stretch = squares(f);
    Lanes stiffening = squares(cofactor_f) - all(3.0f);
    if constexpr (law == tissue::ElasticLaw::saint_venant_kirchhoff)  // d(F S)/dF: (3 lambda^2 - 1) / 2 along a stretch
        stiffening = Lanes{hn::Max(stiffening.v, (all(1.5f) * (stretch - all(3.0f))).v)};
    store(Lanes{hn::Max(stiffening.v, hn::Zero(d))}, k.stiffening + at.i);
    at.mark(at.group.overstretched, hn::Not(hn::Le(stretch.v, hn::Set(d, k.most_squared_stretch))));
    at.mark(at.group.stiffened, hn::Gt(stiffening.v, hn::Set(d, kStiffer)));
    k.strained[&at.group - k.first_group] = (at.group.overstretched | at.group.stiffened) != 0 ? 1 : 0;
}

/// G, and the hourglass force.
HWY_INLINE void shape_of(const KernelView& k, const Place& at, Lanes hourglass, Lanes (&inverse)[6], Lanes (&g)[9],
                         Lanes (&force)[3]) {
    Lanes b[9];
    add_all_links(k, at, hourglass, b, force);
    for (int e = 0; e < 6; ++e) inverse[e] = load(k.moment_inverse[e] + at.i);
    for (int e = 0; e < 9; ++e) b[e] = all(k.spacing_m) * b[e];
    multiply_symmetric(b, inverse, g);
}

template <tissue::ElasticLaw law>
HWY_INLINE void gradients_of(const KernelView& k, const Place& at) {
    const std::int64_t i = at.i;
    Lanes force[3], inverse[6], g[9], p[9], m[9], cofactor_f[9];
    const Lanes hourglass = load(k.hourglass + i), spacing = all(k.spacing_m);
    shape_of(k, at, hourglass, inverse, g, force);
    stress<law>(k, g, load(k.lame_mu_Pa + i), load(k.lame_lambda_Pa + i), p, cofactor_f);
    const Lanes volume = load(k.volume_m3 + i);
    for (int e = 0; e < 6; ++e) inverse[e] = volume * inverse[e];
    multiply_symmetric(p, inverse, m);
    for (int e = 0; e < 9; ++e) {
        m[e] = m[e] - hourglass * g[e];
        store(m[e], k.moment_stress[e] + i);
    }
    if (k.embedding) {
        for (int e = 0; e < 9; ++e) store(g[e], k.gradient[e] + i);
        measure_stretch<law>(k, at, g, cofactor_f);
    }
    Lanes step[3];
    for (int c = 0; c < 3; ++c) step[c] = load(k.step_sum[static_cast<std::size_t>(c)] + i);
    for (int r = 0; r < 3; ++r) {
        const Lanes own = m[3 * r] * step[0] + m[3 * r + 1] * step[1] + m[3 * r + 2] * step[2];
        store(spacing * own + force[r], k.own_force_N[static_cast<std::size_t>(r)] + i);
    }
}

/// Of ghosts alone: they have no stress.
HWY_INLINE void ghost_forces_of(const KernelView& k, const Place& at) {
    Lanes b[9], force[3], inverse[6], g[9];
    const Lanes hourglass = load(k.hourglass + at.i);
    if (k.embedding) {
        shape_of(k, at, hourglass, inverse, g, force);
        for (int e = 0; e < 9; ++e) store(g[e], k.gradient[e] + at.i);
    } else {
        add_all_links(k, at, hourglass, b, force);
    }
    for (int r = 0; r < 3; ++r) store(force[r], k.own_force_N[static_cast<std::size_t>(r)] + at.i);
}

/// Calls body(place) for the vectors of all groups in which `of(group)` has a bit.
template <class Bits, class Body>
HWY_INLINE void for_each_vector(Groups groups, const Bits& of, const Body& body) {
    constexpr int kLanes = static_cast<int>(hn::MaxLanes(D()));
    for (Group& group : groups)
        for (int lane = 0; lane < kGroupCells; lane += kLanes)
            if (((of(group) >> lane) & ((1u << kLanes) - 1u)) != 0) body(Place{group.first + lane, group, lane});
}

template <tissue::ElasticLaw law>
void gradients_with(const KernelView& k, Groups groups) {
    for_each_vector(
        groups, [](const Group& group) { return std::uint32_t{group.present} | group.ghost; },
        [&](const Place& at) HWY_ATTR {
            const std::uint32_t lanes = (1u << hn::Lanes(D())) - 1u;
            if (((std::uint32_t{at.group.present} >> at.lane) & lanes) != 0)
                gradients_of<law>(k, at);
            else
                ghost_forces_of(k, at);
        });
}

void gradients(const KernelView& k, Groups groups) {
    if (k.law == tissue::ElasticLaw::stable_neo_hookean)
        gradients_with<tissue::ElasticLaw::stable_neo_hookean>(k, groups);
    else
        gradients_with<tissue::ElasticLaw::saint_venant_kirchhoff>(k, groups);
}

// ---- Forces and velocities

/// M_j X_ij / s of the neighbours at j along a direction.
template <int d>
HWY_INLINE void neighbour_stress(const KernelView& k, std::int64_t j, Mask mask, Lanes (&stress)[3]) {
    using Dir = Direction<d>;
    for (int r = 0; r < 3; ++r) {
        const Lanes first = load(k.moment_stress[3 * r + Dir::first] + j);
        if constexpr (Dir::face)
            stress[r] = where(mask, first);
        else
            stress[r] = where(mask, along<d>(first, load(k.moment_stress[3 * r + Dir::second] + j)));
    }
}

template <int d>
HWY_INLINE void add_stresses(const KernelView& k, const Place& at, Lanes (&sum)[3]) {
    Lanes plus[3], minus[3];
    neighbour_stress<d>(k, at.i + k.offset[d], at.plus<d>(), plus);
    neighbour_stress<d>(k, at.i - k.offset[d], at.minus<d>(), minus);
    for (int r = 0; r < 3; ++r) sum[r] = sum[r] + (plus[r] - minus[r]);
}

HWY_INLINE void motion_of(const KernelView& k, const Place& at) {
    const std::int64_t i = at.i;
    Lanes sum[3];
    for (int r = 0; r < 3; ++r) sum[r] = all(0.0f);
    add_stresses<0>(k, at, sum);
    add_stresses<1>(k, at, sum);
    add_stresses<2>(k, at, sum);
    for (int r = 0; r < 3; ++r) sum[r] = all(kFace) * sum[r];
    add_stresses<3>(k, at, sum);
    add_stresses<4>(k, at, sum);
    add_stresses<5>(k, at, sum);
    add_stresses<6>(k, at, sum);
    add_stresses<7>(k, at, sum);
    add_stresses<8>(k, at, sum);
    const Lanes spacing = all(k.spacing_m), decay = all(k.decay);
    const Lanes inverse_mass = load(k.inverse_mass_per_kg + i), gravity_share = load(k.gravity_share + i);
    const Mask present = at.mask(at.group.present), ghost = at.mask(at.group.ghost);
    const Lanes dt = all(k.substep_s);
    Lanes speed2 = all(0.0f);
    for (int r = 0; r < 3; ++r) {
        const auto row = static_cast<std::size_t>(r);
        const Lanes impulse = all(k.substep_s) * (spacing * sum[r] + load(k.own_force_N[row] + i));
        float* v = k.velocity_m_per_s[row] + i;
        const Lanes gravity = all(k.gravity_step_m_per_s[row]) * gravity_share;
        const Lanes velocity = decay * (load(v) + inverse_mass * impulse + gravity);
        // What is no number must stay, for check() to find.
        const Mask moving = hn::AndNot(hn::Lt(hn::Abs(velocity.v), all(kRest_m_per_s).v), present);
        speed2 = speed2 + velocity * velocity;
        store(where(moving, velocity) + where(ghost, impulse), v);
        float* u = k.displacement_m[row] + i;
        const Lanes moved = load(u) + where(moving, dt * velocity);
        store(where(hn::Not(hn::Lt(hn::Abs(moved.v), all(kNowhere_m).v)), moved), u);
    }
    const Mask fast = hn::And(hn::Gt(speed2.v, all(kFast_m_per_s * kFast_m_per_s).v), present);
    if (HWY_UNLIKELY(!hn::AllFalse(D(), fast))) k.fast[&at.group - k.first_group] = 1;
}

void motion(const KernelView& k, Groups groups) {
    for_each_vector(
        groups, [](const Group& group) { return std::uint32_t{group.present} | group.ghost; },
        [&](const Place& at) HWY_ATTR { motion_of(k, at); });
}

/// Groups after which gradients and motion take turns.
constexpr std::int64_t kBatch = 32;

template <tissue::ElasticLaw law>
void both_with(const KernelView& k, Groups all, GroupRange of_gradients, GroupRange of_motion) {
    auto at = [](std::int64_t n) { return static_cast<std::size_t>(n); };
    std::int64_t next = of_motion.begin;
    for (std::int64_t g = of_gradients.begin; g < of_gradients.end; g += kBatch) {
        const std::int64_t g_end = std::min(g + kBatch, of_gradients.end);
        gradients_with<law>(k, all.subspan(at(g), at(g_end - g)));
        // Cells before this one are done, or were never asked for.
        const std::int64_t done = g_end < of_gradients.end ? all[at(g_end)].first : std::int64_t{1} << 40;
        std::int64_t end = next;
        while (end < of_motion.end && all[at(end)].first + kGroupCells + k.reach <= done) ++end;
        if (end > next) motion(k, all.subspan(at(next), at(end - next)));
        next = end;
    }
}

void both(const KernelView& k, Groups all, GroupRange of_gradients, GroupRange of_motion) {
    if (k.law == tissue::ElasticLaw::stable_neo_hookean)
        both_with<tissue::ElasticLaw::stable_neo_hookean>(k, all, of_gradients, of_motion);
    else
        both_with<tissue::ElasticLaw::saint_venant_kirchhoff>(k, all, of_gradients, of_motion);
}

}  // namespace HWY_NAMESPACE
}  // namespace calot::deformation
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace calot::deformation {

HWY_EXPORT(gradients);
HWY_EXPORT(motion);
HWY_EXPORT(both);

void sweep_gradients(const KernelView& view, Groups groups) {
    HWY_DYNAMIC_DISPATCH(gradients)(view, groups);
}
void sweep_motion(const KernelView& view, Groups groups) {
    HWY_DYNAMIC_DISPATCH(motion)(view, groups);
}
void sweep_both(const KernelView& view, Groups all, GroupRange gradients, GroupRange motion) {
    HWY_DYNAMIC_DISPATCH(both)(view, all, gradients, motion);
}

GroupRange inner_groups(const KernelView& view, Groups all, GroupRange gradients) {
    const auto count = static_cast<std::int64_t>(all.size());
    auto first = [&](std::int64_t g) { return std::int64_t{all[static_cast<std::size_t>(g)].first}; };
    GroupRange inner = gradients;
    if (gradients.begin > 0)
        while (inner.begin < inner.end && first(inner.begin) - view.reach < first(gradients.begin)) ++inner.begin;
    if (gradients.end < count)
        while (inner.end > inner.begin && first(inner.end - 1) + kGroupCells + view.reach > first(gradients.end))
            --inner.end;
    return inner;
}

}  // namespace calot::deformation
#endif

#include "language.h"
#include "types.h"
#include "neighbours.h"

// The sweeps of a substep (deformation/kernel.h; its equations and their order of operations, so that a device which
// rounds as the host does gives the same bits). An item is a phyxel or ghost of the list `active`; what a tick calls:
//
//   raise_masses                                           once
//   motion, return_ghost_impulses, (contact.cl),
//   move_ghosts, gradients                                 every substep
//
// What a phyxel costs, once each value is read from memory once and then from caches (without: 91 and 102 values read):
//
//                read          written                  additions and subtractions / multiplications
//   motion       21 floats     6                        100 / 40
//   gradients    17 floats     12, 22 where `whole`     280 / 170

#define FACE_WEIGHT 27.0f  // deformation/links.h; edges weigh 1
#define STIFFER 0.5f       // deformation/kernel.h

// ---- Masses (deformation/stable_mass.h)

/// Masses for tissue as it is deformed now, and an empty report.
KERNEL void raise_masses(struct GpuSweep s, GLOBAL const int* active, int count, GLOBAL const uint* present,
                         GLOBAL const uint* words, GLOBAL const float* stiffening, GLOBAL float* mass,
                         GLOBAL int* report) {
    const int item = GLOBAL_ID;
    if (item == 0) {
        report[0] = 0x7fffffff;
        report[1] = 0;
    }
    if (item >= count) return;
    const int i = active[item], n = s.phyxels.cells;
    if (!test_bit(present, i)) {
        mass[MASS_INVERSE * n + i] = 0.0f;
        mass[MASS_GRAVITY_SHARE * n + i] = 0.0f;
        return;
    }
    float raise = stiffening[i] > STIFFER ? 1.0f + stiffening[i] : 1.0f;
    const uint links = words[WORD_LINKS * n + i];
    for (int k = 0; k < NEIGHBOURHOOD; ++k) {
        if (((links >> k) & 1u) == 0u) continue;
        const int j = i + neighbour_offset(s.phyxels, k);
        if (stiffening[j] > STIFFER && test_bit(present, j)) raise = FMAX(raise, 1.0f + stiffening[j]);
    }
    const float weighing = mass[MASS_WEIGHING * n + i];
    const float moving = FMAX(mass[MASS_MOVING * n + i], raise * mass[MASS_STABLE * n + i]);
    mass[MASS_INVERSE * n + i] = weighing > 0.0f ? 1.0f / moving : 0.0f;
    mass[MASS_GRAVITY_SHARE * n + i] = weighing > 0.0f ? weighing / moving : 0.0f;
}

// ---- Gradients

/// Differences along a direction, and what they add to the hourglass force.
FN void link_differences(GLOBAL const float* u, int n, int i, int offset, uint plus, uint minus, const float* own,
                         float stiffness_plus, float stiffness_minus, float* difference, float* force) {
    for (int r = 0; r < 3; ++r) {
        const float up = plus ? u[r * n + i + offset] - own[r] : 0.0f;
        const float down = minus ? u[r * n + i - offset] - own[r] : 0.0f;
        difference[r] = up - down;
        force[r] = force[r] + (stiffness_plus * up + stiffness_minus * down);
    }
}

/// B [displacement x step], faces weighted, and the hourglass force of a cell.
FN void add_all_links(struct GpuLattice l, GLOBAL const float* u, GLOBAL const float* hourglass, uint links, int i,
                      float* b, float* force) {
    const int n = l.cells;
    const float kappa = hourglass[i];
    float own[3], d[3];
    for (int r = 0; r < 3; ++r) {
        own[r] = u[r * n + i];
        force[r] = 0.0f;
    }
#define LINKS(number, k)                                                                                        \
    {                                                                                                           \
        const int offset = neighbour_offset(l, k);                                                              \
        link_differences(u, n, i, offset, (links >> k) & 1u, (links >> (26 - k)) & 1u, own,                     \
                         kappa + hourglass[i + offset], kappa + hourglass[i - offset], d, force);               \
    }
#define FACE(number, k)                                                    \
    LINKS(number, k)                                                       \
    for (int r = 0; r < 3; ++r) b[3 * r + number] = FACE_WEIGHT * d[r];
    FOR_EACH_FACE(FACE)
#undef FACE
    for (int r = 0; r < 3; ++r) force[r] = FACE_WEIGHT * force[r];
    // An edge step is e[first] + sign e[second].
#define EDGE(number, k, first, sign, second)                               \
    LINKS(number, k)                                                       \
    for (int r = 0; r < 3; ++r) {                                          \
        b[3 * r + first] = b[3 * r + first] + d[r];                        \
        b[3 * r + second] = b[3 * r + second] sign d[r];                   \
    }
    EDGE(3, 17, 0, +, 1)
    EDGE(4, 11, 0, -, 1)
    EDGE(5, 23, 0, +, 2)
    EDGE(6, 5, 0, -, 2)
    EDGE(7, 25, 1, +, 2)
    EDGE(8, 7, 1, -, 2)
#undef EDGE
#undef LINKS
}

/// c = a b with b symmetric (xx xy xz yy yz zz).
FN void multiply_symmetric(const float* a, const float* b, float* c) {
    for (int r = 0; r < 3; ++r) {
        const float x = a[3 * r], y = a[3 * r + 1], z = a[3 * r + 2];
        c[3 * r] = x * b[0] + y * b[1] + z * b[2];
        c[3 * r + 1] = x * b[1] + y * b[3] + z * b[4];
        c[3 * r + 2] = x * b[2] + y * b[4] + z * b[5];
    }
}

/// cof G, row-major.
FN void cofactor(const float* g, float* c) {
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

FN float sum_of_squares(const float* a) {
    float sum = a[0] * a[0];
    for (int e = 1; e < 9; ++e) sum = sum + a[e] * a[e];
    return sum;
}

/// First Piola-Kirchhoff stress (deformation/law.h). Also cof F.
FN void stress(struct GpuSweep s, const float* g, float mu, float lambda, float* p, float* cofactor_f) {
    float cofactor_g[9], difference[9];
    cofactor(g, cofactor_g);
    const float trace = g[0] + g[4] + g[8];
    const float minors = cofactor_g[0] + cofactor_g[4] + cofactor_g[8];
    const float det = g[0] * cofactor_g[0] + g[1] * cofactor_g[1] + g[2] * cofactor_g[2];
    const float change = trace + minors + det;  // J - 1
    for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c) {
            const int rc = 3 * r + c, cr = 3 * c + r;
            const float on_diagonal = r == c ? trace : 0.0f;
            difference[rc] = g[rc] + g[cr] - on_diagonal - cofactor_g[rc];  // F - cof F
            const float f = r == c ? 1.0f + g[rc] : g[rc];
            cofactor_f[rc] = f - difference[rc];
        }
    if (s.law == 0) {
        const float pressure = (lambda + mu) * change;
        for (int e = 0; e < 9; ++e) p[e] = mu * difference[e] + pressure * cofactor_f[e];
        return;
    }
    float second[6];  // S = lambda tr(E) 1 + 2 mu E, xx xy xz yy yz zz
    int e = 0;
    for (int a = 0; a < 3; ++a)
        for (int b = a; b < 3; ++b) {
            const float square = g[a] * g[b] + g[3 + a] * g[3 + b] + g[6 + a] * g[6 + b];
            second[e++] = 0.5f * (g[3 * a + b] + g[3 * b + a] + square);
        }
    const float pressure = lambda * (second[0] + second[3] + second[5]);
    for (e = 0; e < 6; ++e) {
        const float deviatoric = (mu + mu) * second[e];
        second[e] = e == 0 || e == 3 || e == 5 ? deviatoric + pressure : deviatoric;
    }
    float f[9];
    for (e = 0; e < 9; ++e) f[e] = e % 4 == 0 ? 1.0f + g[e] : g[e];
    multiply_symmetric(f, second, p);
    const float bulk = s.volume_stiffness_Pa * change;
    for (e = 0; e < 9; ++e) p[e] = p[e] + bulk * cofactor_f[e];
}

/// How far F stretches: beyond the tear, and how much stiffer than at rest.
FN float find_stretch(struct GpuSweep s, const float* g, const float* cofactor_f, float* stiffening) {
    float f[9];
    for (int e = 0; e < 9; ++e) f[e] = e % 4 == 0 ? 1.0f + g[e] : g[e];
    const float stretch = sum_of_squares(f);
    float stiffer = sum_of_squares(cofactor_f) - 3.0f;
    if (s.law == 1) stiffer = FMAX(stiffer, 1.5f * (stretch - 3.0f));
    *stiffening = FMAX(stiffer, 0.0f);
    return stretch;
}

/// G and M of the cells of a list. `whole`: G is stored, also of ghosts, for whoever embeds points, and how far tissue
/// stretches; 2 = also reported: the lowest cell whose displacement is not finite, and which tissue tears.
KERNEL void gradients(struct GpuSweep s, GLOBAL const int* cells, int count, int whole, GLOBAL const uint* present,
                      GLOBAL const uint* ghost, GLOBAL const uint* words, GLOBAL const float* rest,
                      GLOBAL const float* u, GLOBAL float* gradient, GLOBAL float* moment_stress,
                      GLOBAL float* own_force, GLOBAL float* stiffening, GLOBAL int* report, int room) {
    const int item = GLOBAL_ID;
    if (item >= count) return;
    const int i = cells[item], n = s.phyxels.cells;
    const int is_present = test_bit(present, i), is_ghost = test_bit(ghost, i);
    if (!is_present && !is_ghost) return;
    float b[9], force[3];
    add_all_links(s.phyxels, u, rest + REST_HOURGLASS * n, words[WORD_LINKS * n + i], i, b, force);
    if (whole == 2) {
        for (int r = 0; r < 3; ++r)
            if ((BITS_OF(u[r * n + i]) & 0x7f800000u) == 0x7f800000u) ATOMIC_MIN(report, i);
    }
    if (!is_present && !whole) {  // ghosts have no stress
        for (int r = 0; r < 3; ++r) own_force[r * n + i] = force[r];
        return;
    }
    float inverse[6], g[9], p[9], m[9], cofactor_f[9], step[3];
    const float spacing = s.phyxels.spacing_m, kappa = rest[REST_HOURGLASS * n + i], volume = rest[REST_VOLUME * n + i];
    for (int e = 0; e < 6; ++e) inverse[e] = rest[(REST_MOMENT_INVERSE + e) * n + i];
    for (int e = 0; e < 9; ++e) b[e] = spacing * b[e];
    multiply_symmetric(b, inverse, g);
    stress(s, g, rest[REST_MU * n + i], rest[REST_LAMBDA * n + i], p, cofactor_f);
    for (int e = 0; e < 6; ++e) inverse[e] = volume * inverse[e];
    multiply_symmetric(p, inverse, m);
    for (int e = 0; e < 9; ++e) {
        m[e] = m[e] - kappa * g[e];
        moment_stress[e * n + i] = m[e];
    }
    for (int c = 0; c < 3; ++c) step[c] = rest[(REST_STEP_SUM + c) * n + i];
    for (int r = 0; r < 3; ++r) {
        const float own = m[3 * r] * step[0] + m[3 * r + 1] * step[1] + m[3 * r + 2] * step[2];
        own_force[r * n + i] = spacing * own + force[r];
    }
    if (!whole) return;
    for (int e = 0; e < 9; ++e) gradient[e * n + i] = g[e];
    float stiffer;
    const float stretch = find_stretch(s, g, cofactor_f, &stiffer);
    stiffening[i] = stiffer;
    if (whole == 2 && is_present && !(stretch <= s.most_squared_stretch)) {
        const int place = ATOMIC_ADD(report + 1, 1);
        if (place < room) report[2 + place] = i;
    }
}

// ---- Forces and motion

/// Velocities and displacements after a substep of elastic forces, gravity and damping. Ghosts get the impulse [N s] of
/// the forces on them instead of a velocity.
KERNEL void motion(struct GpuSweep s, GLOBAL const int* active, int count, GLOBAL const uint* present,
                       GLOBAL const uint* ghost, GLOBAL const uint* words, GLOBAL const float* moment_stress,
                       GLOBAL const float* own_force, GLOBAL const float* mass, GLOBAL float* v, GLOBAL float* u) {
    const int item = GLOBAL_ID;
    if (item >= count) return;
    const int i = active[item], n = s.phyxels.cells;
    const int is_present = test_bit(present, i), is_ghost = test_bit(ghost, i);
    if (!is_present && !is_ghost) return;
    const uint links = words[WORD_LINKS * n + i];
    float sum[3] = {0.0f, 0.0f, 0.0f};
#define FACE(number, k)                                                                                         \
    {                                                                                                           \
        const int j = i + neighbour_offset(s.phyxels, k), o = i - neighbour_offset(s.phyxels, k);               \
        for (int r = 0; r < 3; ++r) {                                                                           \
            const float plus = (links >> k) & 1u ? moment_stress[(3 * r + number) * n + j] : 0.0f;              \
            const float minus = (links >> (26 - k)) & 1u ? moment_stress[(3 * r + number) * n + o] : 0.0f;      \
            sum[r] = sum[r] + (plus - minus);                                                                   \
        }                                                                                                       \
    }
    FOR_EACH_FACE(FACE)
#undef FACE
    for (int r = 0; r < 3; ++r) sum[r] = FACE_WEIGHT * sum[r];
#define ALONG(first, sign, second, r, j) \
    (moment_stress[(3 * r + first) * n + j] sign moment_stress[(3 * r + second) * n + j])
#define EDGE(k, first, sign, second)                                                                            \
    {                                                                                                           \
        const int j = i + neighbour_offset(s.phyxels, k), o = i - neighbour_offset(s.phyxels, k);               \
        for (int r = 0; r < 3; ++r) {                                                                           \
            const float plus = (links >> k) & 1u ? ALONG(first, sign, second, r, j) : 0.0f;                     \
            const float minus = (links >> (26 - k)) & 1u ? ALONG(first, sign, second, r, o) : 0.0f;             \
            sum[r] = sum[r] + (plus - minus);                                                                   \
        }                                                                                                       \
    }
    EDGE(17, 0, +, 1)
    EDGE(11, 0, -, 1)
    EDGE(23, 0, +, 2)
    EDGE(5, 0, -, 2)
    EDGE(25, 1, +, 2)
    EDGE(7, 1, -, 2)
#undef EDGE
#undef ALONG
    const float inverse_mass = mass[MASS_INVERSE * n + i], gravity_share = mass[MASS_GRAVITY_SHARE * n + i];
    for (int r = 0; r < 3; ++r) {
        const float impulse = s.substep_s * (s.phyxels.spacing_m * sum[r] + own_force[r * n + i]);
        const float gravity = s.gravity_step_m_per_s[r] * gravity_share;
        const float velocity = s.decay * (v[r * n + i] + inverse_mass * impulse + gravity);
        const int moving = is_present && !(FABS(velocity) < s.rest_m_per_s);
        v[r * n + i] = moving ? velocity : is_present ? 0.0f : impulse;
        if (!is_present) continue;
        const float moved = u[r * n + i] + (moving ? s.substep_s * velocity : 0.0f);
        u[r * n + i] = FABS(moved) < s.nowhere_m ? 0.0f : moved;
    }
}

// ---- Ghosts (deformation/ghosts.h)

/// Hands the impulses in the ghosts' velocities on to the phyxels that they mirror, which have moved. `beside`: phyxels
/// beside ghosts.
KERNEL void return_ghost_impulses(struct GpuSweep s, GLOBAL const int* beside, int count, GLOBAL const uint* present,
                                  GLOBAL const uint* words, GLOBAL const float* mass, GLOBAL float* v,
                                  GLOBAL float* u) {
    const int item = GLOBAL_ID;
    if (item >= count) return;
    const int i = beside[item], n = s.phyxels.cells;
    if (!test_bit(present, i)) return;
    float impulse[3] = {0.0f, 0.0f, 0.0f};
    for (int place = 0; place < NEIGHBOURHOOD; ++place) {
        const int k = s.ascending[place], ghost = i + neighbour_offset(s.phyxels, k);
        const uint mirrored = words[WORD_MIRROR * n + ghost];
        if (((mirrored >> (26 - k)) & 1u) == 0u) continue;
        const float share = 1.0f / (float)POPCOUNT(mirrored);
        for (int r = 0; r < 3; ++r) impulse[r] += share * v[r * n + ghost];
    }
    const float gain = -s.decay * mass[MASS_INVERSE * n + i];
    for (int r = 0; r < 3; ++r) {
        const float more = gain * impulse[r];
        const float velocity = v[r * n + i] + more, moved = u[r * n + i] + s.substep_s * more;
        v[r * n + i] = FABS(velocity) < s.rest_m_per_s ? 0.0f : velocity;
        u[r * n + i] = FABS(moved) < s.nowhere_m ? 0.0f : moved;
    }
}

/// Displacements of ghosts from those of the phyxels that they mirror; their velocities are zero.
KERNEL void move_ghosts(struct GpuSweep s, GLOBAL const int* ghosts, int count, GLOBAL const uint* words,
                        GLOBAL float* u, GLOBAL float* v) {
    const int item = GLOBAL_ID;
    if (item >= count) return;
    const int i = ghosts[item], n = s.phyxels.cells;
    const uint mirrored = words[WORD_MIRROR * n + i];
    const float share = mirrored != 0u ? 1.0f / (float)POPCOUNT(mirrored) : 0.0f;
    for (int r = 0; r < 3; ++r) {
        float sum = 0.0f;
#define ADD(number, k)                                                                          \
    if ((mirrored >> k) & 1u) sum += u[r * n + i + neighbour_offset(s.phyxels, k)];             \
    if ((mirrored >> (26 - k)) & 1u) sum += u[r * n + i - neighbour_offset(s.phyxels, k)];
        FOR_EACH_FACE(ADD)
        FOR_EACH_EDGE(ADD)
#undef ADD
        u[r * n + i] = 0.0f - share * sum;
        v[r * n + i] = 0.0f;
    }
}

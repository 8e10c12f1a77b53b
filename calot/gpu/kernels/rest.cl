#include "language.h"
#include "types.h"
#include "lattice.h"
#include "neighbours.h"

// What phyxels are at rest, where hexels or links changed (deformation/rest.cpp and stable_mass.cpp: their equations
// and order of operations). An item is a cell; rest properties first, then masses, which ask for those of the
// neighbours. Few items: real.

#define FACE_WEIGHT ((real)27)  // deformation/links.h; edges weigh 1

/// Calls VISIT(k, weight) for the live links of a word, in the order of deformation::for_each_link.
#define FOR_EACH_LINK(VISIT)                                                                        \
    for (int number = 0; number < 18; ++number) {                                                   \
        const int k = ordered_link(number);                                                         \
        if ((links >> k) & 1u) VISIT(k, (number < 6 ? FACE_WEIGHT : (real)1))                       \
    }
FN int ordered_link(int number) {
    const int order[9] = {14, 16, 22, 17, 11, 23, 5, 25, 7};
    return number % 2 == 0 ? order[number / 2] : 26 - order[number / 2];
}

FN void step_of(int k, real* step) {
    step[0] = (real)(k % 3 - 1);
    step[1] = (real)(k / 3 % 3 - 1);
    step[2] = (real)(k / 9 - 1);
}
FN real length_of(const real* a) { return sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]); }
FN real least(real a, real b) { return b < a ? b : a; }
FN real greatest(real a, real b) { return a < b ? b : a; }

/// What the hexels of a phyxel make together: count, density, mu, lambda, sums.
FN int content_of(struct GpuTopology t, GLOBAL const real* numbers, GLOBAL const uint* words,
                  GLOBAL const uchar* material, int i, real* sum) {
    const int n = t.phyxels.cells, m = t.hexels_per_edge;
    const u64 word = (u64)words[WORD_OCCUPANCY * n + i] | ((u64)words[(WORD_OCCUPANCY + 1) * n + i] << 32);
    int c[3], hexels = 0;
    cell_coordinates(t.phyxels, i, c);
    for (int k = 0; k < 3; ++k) sum[k] = (real)0;
    for (int bit = 0; bit < m * m * m; ++bit) {
        if (((word >> bit) & 1u) == 0u) continue;
        const int hexel = cell_index(t.hexels, c[0] * m + bit % m, c[1] * m + bit / m % m, c[2] * m + bit / (m * m));
        GLOBAL const real* of = numbers + NUMBER_MATERIALS + 3 * (int)material[hexel];
        ++hexels;
        for (int k = 0; k < 3; ++k) sum[k] += of[k];
    }
    return hexels;
}

/// Smallest and largest eigenvalue of a symmetric matrix, xx xy xz yy yz zz (Smith 1961, trigonometric form).
FN void extreme_eigenvalues(const real* a, real* smallest, real* largest) {
    const real mean = (a[0] + a[3] + a[5]) / (real)3;
    const real x = a[0] - mean, y = a[3] - mean, z = a[5] - mean;
    const real squares = (x * x + y * y + z * z) + (real)2 * (a[1] * a[1] + a[2] * a[2] + a[4] * a[4]);
    const real radius = sqrt(squares / (real)6), third_of_turn = acos((real)-1) * (real)2 / (real)3;
    *smallest = *largest = mean;
    if (radius <= (real)1e-14f * mean) return;
    const real det = x * (y * z - a[4] * a[4]) - a[1] * (a[1] * z - a[4] * a[2]) + a[2] * (a[1] * a[4] - y * a[2]);
    const real half_det = det / (radius * radius * radius) / (real)2;
    const real angle = acos(greatest((real)-1, least((real)1, half_det))) / (real)3;
    *smallest = mean + (real)2 * radius * cos(angle + third_of_turn);
    *largest = mean + (real)2 * radius * cos(angle);
}

/// Row-major inverse of a symmetric matrix, its upper part.
FN void invert(const real* a, real* out) {
    const real xx = a[0], xy = a[1], xz = a[2], yy = a[3], yz = a[4], zz = a[5];
    const real per_det = (real)1 / (xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz));
    out[0] = (yy * zz - yz * yz) * per_det;
    out[1] = -(xy * zz - yz * xz) * per_det;
    out[2] = (xy * yz - yy * xz) * per_det;
    out[3] = (xx * zz - xz * xz) * per_det;
    out[4] = -(xx * yz - xz * xy) * per_det;
    out[5] = (xx * yy - xy * xy) * per_det;
}

/// How much more hourglass control a phyxel gets at a free surface.
FN real surface_factor(real trace, real fill) {
    const real inside = (real)6 * FACE_WEIGHT + (real)24;
    return (real)1 + (real)10 * ((real)1 - trace / inside) * fill * fill;
}

/// A^-1 of a cell as stored, upper part.
FN void stored_inverse(GLOBAL const float* rest, int n, int i, real* inverse) {
    for (int e = 0; e < 6; ++e) inverse[e] = (real)rest[(REST_MOMENT_INVERSE + e) * n + i];
}
/// dG / du of a neighbour along a step: w A^-1 X.
FN void gradient_of_link(const real* inverse, real weighted_spacing, const real* step, real* g) {
    const real x = weighted_spacing * step[0], y = weighted_spacing * step[1], z = weighted_spacing * step[2];
    g[0] = inverse[0] * x + inverse[1] * y + inverse[2] * z;
    g[1] = inverse[1] * x + inverse[3] * y + inverse[4] * z;
    g[2] = inverse[2] * x + inverse[4] * y + inverse[5] * z;
}

/// Moment, volume, constants, hourglass control and pull of phyxels and ghosts, which phyxels a ghost mirrors, and
/// links as bit arrays have them. Cells without stress of their own get none.
KERNEL void refresh_rest(struct GpuTopology t, GLOBAL const int* cells, int count, GLOBAL const real* numbers,
                         GLOBAL const uint* present, GLOBAL const uint* ghost, GLOBAL const uchar* material,
                         GLOBAL uint* words, GLOBAL uint* link_bits, GLOBAL float* rest, GLOBAL float* gradient,
                         GLOBAL float* moment_stress, GLOBAL float* own_force) {
    const int item = GLOBAL_ID;
    if (item >= count) return;
    const int i = cells[item], n = t.phyxels.cells, is_ghost = test_bit(ghost, i), is_present = test_bit(present, i);
    const uint links = words[WORD_LINKS * n + i], bit = 1u << (i & 31);
#define STORE(number, k)                                                                            \
    if ((links >> (k)) & 1u)                                                                        \
        ATOMIC_OR(link_bits + number * t.bit_words + (i >> 5), bit);                                \
    else                                                                                            \
        ATOMIC_AND(link_bits + number * t.bit_words + (i >> 5), ~bit);
    FOR_EACH_FACE(STORE)
    FOR_EACH_EDGE(STORE)
#undef STORE
    if (is_ghost) {
        uint linked = 0u;
        for (int k = 0; k < NEIGHBOURHOOD; ++k)
            if (((links >> k) & 1u) && test_bit(present, i + neighbour_offset(t.phyxels, k))) linked |= 1u << k;
        words[WORD_MIRROR * n + i] = (linked & FACE_LINKS) != 0u ? linked & FACE_LINKS : linked;
    }

    real a[6], step[3], sum[3], inverse[6], step_sum[3];
    for (int e = 0; e < 6; ++e) a[e] = inverse[e] = (real)0;
    for (int r = 0; r < 3; ++r) step_sum[r] = (real)0;
#define ADD(k, weight)                                                                              \
    {                                                                                               \
        step_of(k, step);                                                                           \
        int e = 0;                                                                                  \
        for (int r = 0; r < 3; ++r) {                                                               \
            step_sum[r] += weight * step[r];                                                        \
            for (int c = r; c < 3; ++c) a[e++] += weight * step[r] * step[c];                       \
        }                                                                                           \
    }
    FOR_EACH_LINK(ADD)
#undef ADD
    real volume = (real)0, mu = (real)0, lambda = (real)0, fill = (real)0, hourglass = (real)0;
    if (!is_ghost && is_present) {
        const int m = t.hexels_per_edge, hexels = content_of(t, numbers, words, material, i, sum);
        if (hexels > 0) {
            volume = (real)hexels * numbers[NUMBER_HEXEL_VOLUME];
            mu = sum[1] / (real)hexels;
            lambda = sum[2] / (real)hexels;
            fill = (real)hexels / (real)(m * m * m);
        }
    }
    const int is_there = is_ghost || volume != (real)0;
    real smallest, largest;
    extreme_eigenvalues(a, &smallest, &largest);
    const int is_regular = smallest >= numbers[NUMBER_SINGULAR] * largest && largest > (real)0;
    const real trace = a[0] + a[3] + a[5], squared = numbers[NUMBER_SPACING] * numbers[NUMBER_SPACING];
    if (is_there && is_regular) {
        invert(a, inverse);
        for (int e = 0; e < 6; ++e) inverse[e] = inverse[e] / squared;
        if (!is_ghost) {
            volume *= (real)rest[REST_SHARE * n + i] * least((real)1, trace / (real)rest[REST_TRACE * n + i]);
            const real youngs = mu * ((real)3 * lambda + (real)2 * mu) / (lambda + mu);
            hourglass = numbers[NUMBER_ALPHA] * surface_factor(trace, fill) * youngs * volume / (trace * squared);
        }
    } else {
        volume = (real)0;
    }
    for (int e = 0; e < 6; ++e) rest[(REST_MOMENT_INVERSE + e) * n + i] = (float)inverse[e];
    for (int r = 0; r < 3; ++r) rest[(REST_STEP_SUM + r) * n + i] = (float)step_sum[r];
    rest[REST_VOLUME * n + i] = (float)volume;
    rest[REST_HOURGLASS * n + i] = (float)hourglass;
    rest[REST_MU * n + i] = (float)mu;
    rest[REST_LAMBDA * n + i] = (float)lambda;

    // Pull (deformation/stable_mass.h).
    real own[3] = {(real)0, (real)0, (real)0}, g[3], lengths = (real)0, support = (real)0;
    const real stiffness = (real)rest[REST_STIFFNESS * n + i];
    stored_inverse(rest, n, i, inverse);
#define ADD(k, weight)                                                                              \
    {                                                                                               \
        const int j = i + neighbour_offset(t.phyxels, k);                                           \
        step_of(k, step);                                                                           \
        gradient_of_link(inverse, weight * numbers[NUMBER_SPACING], step, g);                       \
        for (int r = 0; r < 3; ++r) own[r] -= g[r];                                                 \
        support += weight * (test_bit(ghost, j) ? (real)1                                           \
                                                : least((real)1, (real)rest[REST_STIFFNESS * n + j] / stiffness)); \
        lengths += length_of(g);                                                                    \
    }
    FOR_EACH_LINK(ADD)
#undef ADD
    const real share = (real)1 - numbers[NUMBER_SUPPORT] * support / ((real)6 * FACE_WEIGHT + (real)12);
    const real modulus = (real)(rest[REST_LAMBDA * n + i] + 2.0f * rest[REST_MU * n + i]);
    rest[REST_PULL * n + i] = (float)(share * (real)rest[REST_VOLUME * n + i] * modulus * (lengths + length_of(own)));

    if (rest[REST_MOMENT_INVERSE * n + i] == 0.0f) {
        for (int e = 0; e < 9; ++e) gradient[e * n + i] = moment_stress[e * n + i] = 0.0f;
        for (int r = 0; r < 3; ++r) own_force[r * n + i] = 0.0f;
    }
}

/// Sum of pull |g| over the links of a cell: what its neighbours' stresses pull at it [N/m].
FN real neighbours_row(struct GpuLattice l, GLOBAL const real* numbers, GLOBAL const uint* words,
                       GLOBAL const float* rest, int i) {
    const int n = l.cells;
    const uint links = words[WORD_LINKS * n + i];
    real row = (real)0, step[3], g[3], inverse[6];
#define ADD(k, weight)                                                                              \
    {                                                                                               \
        const int j = i + neighbour_offset(l, k);                                                   \
        step_of(k, step);                                                                           \
        stored_inverse(rest, n, j, inverse);                                                        \
        gradient_of_link(inverse, weight * numbers[NUMBER_SPACING], step, g);                       \
        row += (real)rest[REST_PULL * n + j] * length_of(g);                                        \
    }
    FOR_EACH_LINK(ADD)
#undef ADD
    return row;
}

/// Masses that weigh, that move, and that a stable step needs (deformation/stable_mass.h); carriers of a cell's points.
KERNEL void refresh_masses(struct GpuTopology t, GLOBAL const int* cells, int count, GLOBAL const real* numbers,
                           GLOBAL const uint* present, GLOBAL const uint* ghost, GLOBAL const uchar* material,
                           GLOBAL uint* words, GLOBAL const float* rest, GLOBAL float* mass) {
    const int item = GLOBAL_ID;
    if (item >= count) return;
    const int i = cells[item], n = t.phyxels.cells, m = t.hexels_per_edge, is_present = test_bit(present, i);
    const uint links = words[WORD_LINKS * n + i];
    real sum[3], inverse[6], step[3], g[3], own[3] = {(real)0, (real)0, (real)0}, weighing = (real)0, moving = (real)0;
    if (test_bit(ghost, i)) return;
    const int hexels = is_present ? content_of(t, numbers, words, material, i, sum) : 0;
    if (hexels > 0) {
        const real fill = (real)hexels / (real)(m * m * m);
        weighing = sum[0] * numbers[NUMBER_HEXEL_VOLUME];
        moving = weighing * greatest((real)1, numbers[NUMBER_MASS_FLOOR] / fill);
    }
    real row = neighbours_row(t.phyxels, numbers, words, rest, i), ghosts = (real)0;
#define ADD(k, weight)                                                                              \
    {                                                                                               \
        const int j = i + neighbour_offset(t.phyxels, k);                                           \
        const uint mirrored = test_bit(ghost, j) ? words[WORD_MIRROR * n + j] : 0u;                 \
        if ((mirrored >> (26 - (k))) & 1u)                                                          \
            ghosts += neighbours_row(t.phyxels, numbers, words, rest, j) / (real)POPCOUNT(mirrored); \
    }
    FOR_EACH_LINK(ADD)
#undef ADD
    row = row + ghosts;
    stored_inverse(rest, n, i, inverse);
#define ADD(k, weight)                                                                              \
    {                                                                                               \
        const int j = i + neighbour_offset(t.phyxels, k);                                           \
        step_of(k, step);                                                                           \
        gradient_of_link(inverse, weight * numbers[NUMBER_SPACING], step, g);                       \
        for (int r = 0; r < 3; ++r) own[r] -= g[r];                                                 \
        row += (real)2 * weight * ((real)rest[REST_HOURGLASS * n + i] + (real)rest[REST_HOURGLASS * n + j]); \
    }
    FOR_EACH_LINK(ADD)
#undef ADD
    row += (real)rest[REST_PULL * n + i] * length_of(own);
    mass[MASS_WEIGHING * n + i] = (float)weighing;
    mass[MASS_MOVING * n + i] = (float)moving;
    mass[MASS_STABLE * n + i] =
        (float)(row * numbers[NUMBER_SUBSTEP] * numbers[NUMBER_SUBSTEP] / numbers[NUMBER_ROW_SUM]);

    // Carriers: the phyxel itself, what links reach, and corners in two links (deformation/carriers.h).
    uint carriers = 0u;
    if (is_present) {
        const int power[3] = {1, 3, 9};
        carriers = links | (1u << CENTRE);
        for (int corner = 0; corner < NEIGHBOURHOOD; ++corner) {
            const int at[3] = {corner % 3 - 1, corner / 3 % 3 - 1, corner / 9 - 1};
            if (at[0] * at[1] * at[2] == 0) continue;
            for (int axis = 0; axis < 3; ++axis) {
                const int face = CENTRE + at[axis] * power[axis], edge = CENTRE + corner - face;
                for (int way = 0; way < 2; ++way) {
                    const int via = way == 0 ? face : edge, onward = way == 0 ? edge : face;
                    if (((links >> via) & 1u) == 0u) continue;
                    const int middle = i + neighbour_offset(t.phyxels, via);
                    if (((words[WORD_LINKS * n + middle] >> onward) & 1u) ||
                        (test_bit(ghost, middle) && test_bit(ghost, middle + neighbour_offset(t.phyxels, onward))))
                        carriers |= 1u << corner;
                }
            }
        }
    }
    words[WORD_CARRIERS * n + i] = carriers;
}

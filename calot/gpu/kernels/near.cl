#include "language.h"
#include "types.h"
#include "lattice.h"
#include "neighbours.h"
#include "embedding.h"
#include "scan_group.h"

// Surface hexels near the instruments, in the world (deformation/near.cpp): phyxels whose moved centres are near,
// listed by prefix sums; then a group of 64 items for each, an item for each of its hexels; then those within reach are
// listed in the order of phyxels and of hexels within them.

#define HEXELS 64

FN float distance_to(struct GpuCapsule c, const float* p) {
    float d[3], t = 0.0f;
    for (int r = 0; r < 3; ++r) d[r] = p[r] - c.a[r];
    t = d[0] * c.ab[0] + d[1] * c.ab[1] + d[2] * c.ab[2];
    t = FMIN(1.0f, FMAX(0.0f, t * c.per_length2));
    for (int r = 0; r < 3; ++r) d[r] = d[r] - t * c.ab[r];
    return SQRT(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) - c.radius;
}

FN int is_within(struct GpuCapsule c, const float* p, float further) {
    float d[3];
    for (int r = 0; r < 3; ++r) d[r] = p[r] - c.a[r];
    float t = d[0] * c.ab[0] + d[1] * c.ab[1] + d[2] * c.ab[2];
    t = FMIN(FMAX(t * c.per_length2, 0.0f), 1.0f);
    for (int r = 0; r < 3; ++r) d[r] = d[r] - t * c.ab[r];
    const float most = c.radius + (c.reach + further);
    return d[0] * d[0] + d[1] * d[1] + d[2] * d[2] <= most * most;
}

/// 1 for phyxels whose centres are within reach of a capsule.
KERNEL void near_phyxels(struct GpuNear k, GLOBAL const struct GpuCapsules* capsules, GLOBAL const int* active,
                         GLOBAL const uint* present, GLOBAL const float* centres, GLOBAL const float* u,
                         GLOBAL int* is_near) {
    const int item = GLOBAL_ID;
    if (item >= k.active) return;
    const int i = active[item], n = k.embedding.phyxels.cells;
    int near = 0;
    if (test_bit(present, i)) {
        float p[3];
        phyxel_centre(k.embedding, centres, i, p);
        int inside = 1;
        for (int r = 0; r < 3; ++r) {
            p[r] += u[r * n + i];
            if (p[r] < k.low[r] || p[r] > k.high[r]) inside = 0;
        }
        if (inside)
            for (int c = 0; c < capsules->count; ++c) near |= is_within(capsules->item[c], p, k.phyxel_margin);
    }
    is_near[item] = near;
}

/// Lists them; `before` is the prefix sum of is_near, total[0] their number.
KERNEL void list_phyxels(struct GpuNear k, GLOBAL const int* active, GLOBAL const int* before, GLOBAL const int* total,
                         GLOBAL int* list) {
    const int item = GLOBAL_ID;
    if (item >= k.active) return;
    const int next = item + 1 < k.active ? before[item + 1] : total[0];
    if (next > before[item] && before[item] < k.most_phyxels) list[before[item]] = active[item];
}

// The m^3 hexels of a phyxel as a word, bit x + m (y + m z) (deformation/occupancy.h).

FN u64 word_at(GLOBAL const uint* words, int plane, int n, int i) {
    return (u64)words[plane * n + i] | ((u64)words[(plane + 1) * n + i] << 32);
}
FN u64 filled_at(GLOBAL const uint* words, int n, int i) {
    return word_at(words, WORD_OCCUPANCY, n, i) | word_at(words, WORD_HELD, n, i);
}

/// Whether the neighbour of a hexel towards a side of an axis is filled. `c` is its place among the m^3.
FN int neighbour_filled(struct GpuEmbedding e, GLOBAL const uint* words, int phyxel, const int* c, int axis, int side) {
    int at[3] = {c[0], c[1], c[2]};
    int cell = phyxel;
    const int m = e.hexels_per_edge;
    at[axis] += side;
    if (at[axis] < 0 || at[axis] >= m) {
        cell += side * e.phyxels.stride[axis];
        at[axis] -= side * m;
    }
    return (int)((filled_at(words, e.phyxels.cells, cell) >> (at[0] + m * (at[1] + m * at[2]))) & 1u);
}

/// Finds those of a near phyxel's hexels that are at the surface and within reach: bits in `mask` (two words a phyxel),
/// what is to be known of them in `found`, how many in `counts`. Groups of 64 take one near phyxel after another.
KERNEL void near_hexels(struct GpuNear k, GLOBAL const struct GpuCapsules* capsules, GLOBAL const int* list,
                        GLOBAL const int* total, GLOBAL const float* centres, GLOBAL const float* hexel_centres,
                        GLOBAL const float* outwards, GLOBAL const uint* words, GLOBAL const float* u,
                        GLOBAL const float* gradient, GLOBAL const uint* hexel_present, GLOBAL const uint* hexel_held,
                        GLOBAL struct GpuNearHexel* found, GLOBAL uint* mask, GLOBAL int* counts) {
    SHARED int bits[HEXELS];
    const int m = k.embedding.hexels_per_edge, bit = LOCAL_ID, count = IMIN(total[0], k.most_phyxels);
    for (int place = GROUP_ID; place < count; place += GROUPS) {
        const int phyxel = list[place];
        const u64 own = word_at(words, WORD_OCCUPANCY, k.embedding.phyxels.cells, phyxel);
        int within = 0;
        if (bit < m * m * m && ((own >> bit) & 1u) != 0u) {
            const int c[3] = {bit % m, bit / m % m, bit / (m * m)};
            int inside = 1;
            for (int axis = 0; axis < 3; ++axis)
                inside &= neighbour_filled(k.embedding, words, phyxel, c, axis, 1) &
                          neighbour_filled(k.embedding, words, phyxel, c, axis, -1);
            if (!inside) {
                int at[3];
                float centre[3], rest[3], r[3], field[FIELD], moved[3];
                struct GpuNearHexel hexel;
                cell_coordinates(k.embedding.phyxels, phyxel, at);
                for (int axis = 0; axis < 3; ++axis) at[axis] = at[axis] * m + c[axis];
                phyxel_centre(k.embedding, centres, phyxel, centre);
                rest[0] = hexel_centres[at[0]];
                rest[1] = hexel_centres[k.embedding.hexels.size[0] + at[1]];
                rest[2] = hexel_centres[k.embedding.hexels.size[0] + k.embedding.hexels.size[1] + at[2]];
                // Weights belong to the places of hexels in a cell: they are the same in every cell.
                for (int axis = 0; axis < 3; ++axis) r[axis] = ((float)c[axis] + 0.5f) / (float)m - 0.5f;
                if (blend_field(k.embedding, words, u, gradient, phyxel, r, field)) {
                    float bare = 1e9f, distance = 1e9f;
                    for (int axis = 0; axis < 3; ++axis) r[axis] = rest[axis] - centre[axis];
                    displacement_at(field, r, moved);
                    for (int axis = 0; axis < 3; ++axis) hexel.world[axis] = moved[axis] = rest[axis] + moved[axis];
                    for (int n = 0; n < capsules->count; ++n) {
                        const float d = distance_to(capsules->item[n], moved);
                        distance = FMIN(distance, d);
                        within |= d - capsules->item[n].reach <= 0.0f;
                        if (capsules->item[n].bare) bare = FMIN(bare, d);
                    }
                    if (within) {
                        float outward[3] = {0.0f, 0.0f, 0.0f}, F[9], turned[3];
                        hexel.hexel = cell_index(k.embedding.hexels, at[0], at[1], at[2]);
                        for (int row = 0; row < 9; ++row) {
                            const int first = hexel.hexel + k.row_offset[row];
                            const uint filled = (bits_from(hexel_present, first) | bits_from(hexel_held, first)) & 7u;
                            for (int axis = 0; axis < 3; ++axis)
                                outward[axis] += outwards[3 * (8 * row + (int)filled) + axis];
                        }
                        deformation_gradient(field, F);
                        turn_normal(F, outward, turned);
                        for (int axis = 0; axis < 3; ++axis) hexel.outward[axis] = turned[axis];
                        hexel.bare_gap = bare - k.half_hexel;
                        hexel.distance = distance;
                        found[place * HEXELS + bit] = hexel;
                    }
                }
            }
        }
        bits[bit] = within;
        BARRIER;
        if (bit == 0) {
            uint low = 0u, high = 0u;
            for (int n = 0; n < 32; ++n) {
                low |= (uint)bits[n] << n;
                high |= (uint)bits[32 + n] << n;
            }
            mask[2 * place] = low;
            mask[2 * place + 1] = high;
            counts[place] = POPCOUNT(low) + POPCOUNT(high);
        }
        BARRIER;
    }
}

/// Lists what was found, from out[2] on; `before` is the prefix sum of the counts. out[0] and out[1] say how many
/// hexels and phyxels there are.
KERNEL void list_hexels(struct GpuNear k, GLOBAL const int* total, GLOBAL const int* hexels, GLOBAL const uint* mask,
                        GLOBAL const int* before, GLOBAL const struct GpuNearHexel* found,
                        GLOBAL struct GpuNearHexel* out) {
    const int item = GLOBAL_ID, place = item / HEXELS, bit = item % HEXELS;
    if (item == 0) {
        out[0].hexel = hexels[0];
        out[1].hexel = total[0];
    }
    if (place >= IMIN(total[0], k.most_phyxels)) return;
    const uint low = mask[2 * place], high = mask[2 * place + 1];
    const uint own = bit < 32 ? low >> bit : high >> (bit - 32);
    if ((own & 1u) == 0u) return;
    const int earlier = bit < 32 ? POPCOUNT(low & ((1u << bit) - 1u))
                                 : POPCOUNT(low) + POPCOUNT(high & ((1u << (bit - 32)) - 1u));
    if (before[place] + earlier < k.most_hexels) out[2 + before[place] + earlier] = found[item];
}

#include "language.h"

#include "field_parts.h"
#include "field_window.h"

// What comes out of a solve (electric/joule.cpp).

/// Parts: b . x, x . r, for the best multiple of x.
KERNEL void field_weigh(struct GpuLevel fine, GLOBAL float* grid, GLOBAL const float* metal, GLOBAL const float* x,
                        GLOBAL float* parts) {
    SHARED float scratch[2 * MOST_VALUES * SUM_GROUP];
    const int item = GLOBAL_ID, i = fine.first + item;
    float along = 0.0f, missing = 0.0f;
    if (item < level_items(fine)) {
        along = metal[i] * x[i];
        missing = x[i] * vector_of(grid, fine, LEVEL_RIGHT)[i];
    }
    put_sum(scratch, 0, LOCAL_ID, along, 0.0f);
    put_sum(scratch, 1, LOCAL_ID, missing, 0.0f);
    put_part(scratch, 2, parts);
}
KERNEL void field_scale(GLOBAL const float* parts, int groups, GLOBAL struct GpuFieldScalars* s) {
    SHARED float scratch[2 * MOST_VALUES * SUM_GROUP];
    add_parts(scratch, 2, parts, groups);
    if (LOCAL_ID == 0) {
        const float along = sum_of(scratch, 0), curvature = along - sum_of(scratch, 1);
        s->scale = curvature > 0.0f && curvature < 1e30f ? along / curvature : 1.0f;
    }
}

FN float heat_square(float g, float drop) {
    const float flow = g * drop;
    return flow * flow;
}

/// Joule heat of one volt and potential of every cell of the window (electric/joule.cpp); parts of the sums over it:
/// by material of hexels that are present (0: all other cells), then FIELD_OTHERS.
KERNEL void field_heat(struct GpuWindow window, struct GpuLevel fine, struct GpuPoles poles, GLOBAL float* grid,
                       GLOBAL const float* sigma_S_per_m, GLOBAL const float* metal, GLOBAL const float* wire,
                       GLOBAL const float* x, GLOBAL const struct GpuFieldScalars* s, GLOBAL const uchar* material,
                       GLOBAL const uint* present, float per_square_m2, int materials, GLOBAL float* potential,
                       GLOBAL float* joule_S_per_m3, GLOBAL struct GpuFieldSum* parts) {
    SHARED float heats[SUM_GROUP];
    SHARED float squares[SUM_GROUP];
    SHARED float others[FIELD_OTHERS * SUM_GROUP];
    SHARED int slots[SUM_GROUP];
    const int own = LOCAL_ID, item = GLOBAL_ID, i = fine.first + item;
    float heat = 0.0f, in_wire = 0.0f, beyond = 0.0f, current = 0.0f, sigma = 0.0f;
    int slot = 0;
    if (item < level_items(fine)) {
        int a, b, c;
        level_place(fine, item, &a, &b, &c);
        sigma = sigma_S_per_m[i];
        const float phi = x[i], scale = s->scale, level = scale * phi;
        if (sigma > 0.0f) {
            GLOBAL const float* gx = vector_of(grid, fine, LEVEL_GX);
            GLOBAL const float* gy = vector_of(grid, fine, LEVEL_GY);
            GLOBAL const float* gz = vector_of(grid, fine, LEVEL_GZ);
            float sum = heat_square(gx[i], phi - x[i + 1]) + heat_square(gx[i - 1], phi - x[i - 1]);
            sum = sum +
                  (heat_square(gy[i], phi - x[i + fine.row]) + heat_square(gy[i - fine.row], phi - x[i - fine.row]));
            sum = sum + (heat_square(gz[i], phi - x[i + fine.plane]) +
                         heat_square(gz[i - fine.plane], phi - x[i - fine.plane]));
            heat = ((0.5f * (scale * scale)) * sum) / sigma;
            if (metal[i] > 0.0f) {
                const float drop = 1.0f - level;
                current = metal[i] * drop;
                in_wire = wire[i] * (current * drop);
                heat += current * drop - in_wire;
            }
            for (int n = 0; n < 6; ++n) {
                const float share = cell_outer_share(window, poles, a, b, c, n);
                const float all = sigma * share * level * level, inside = 0.5f * share * all;
                heat += inside;
                beyond += all - inside;
            }
        }
        int kept = 0;
        if (in_window(window, a, b, c)) {
            const int hexel = hexel_of(window, a, b, c);
            kept = test_bit(present, hexel);
            if (kept) slot = material[hexel];
        }
        if (a < window.cells && b < window.cells && c < window.cells) {
            const int at = a + window.cells * (b + window.cells * c);
            potential[at] = level;
            joule_S_per_m3[at] = kept ? per_square_m2 * heat : 0.0f;
        }
    }
    heats[own] = heat;
    squares[own] = heat * sigma;
    slots[own] = slot;
    others[FIELD_WIRE * SUM_GROUP + own] = in_wire;
    others[FIELD_BEYOND * SUM_GROUP + own] = beyond;
    others[FIELD_CURRENT * SUM_GROUP + own] = current;
    BARRIER;
    const int sums = materials + FIELD_OTHERS;
    for (int t = own; t < sums; t += SUM_GROUP) {
        float high = 0.0f, low = 0.0f, greatest = 0.0f;
        for (int k = 0; k < SUM_GROUP; ++k) {
            const float value =
                t < materials ? (slots[k] == t ? heats[k] : 0.0f) : others[(t - materials) * SUM_GROUP + k];
            add_pair(&high, &low, value, 0.0f);
            if (t < materials && slots[k] == t) greatest = FMAX(greatest, squares[k]);
        }
        GLOBAL struct GpuFieldSum* part = parts + GROUP_ID * sums + t;
        part->high = high;
        part->low = low;
        part->greatest = greatest;
    }
}
/// A group for every sum.
KERNEL void field_heat_sums(GLOBAL const struct GpuFieldSum* parts, int groups, GLOBAL struct GpuFieldSum* sums) {
    SHARED float scratch[2 * SUM_GROUP];
    SHARED float most[SUM_GROUP];
    const int own = LOCAL_ID, t = GROUP_ID, stride = GROUPS;
    float high = 0.0f, low = 0.0f, greatest = 0.0f;
    for (int k = own; k < groups; k += SUM_GROUP) {
        add_pair(&high, &low, parts[k * stride + t].high, parts[k * stride + t].low);
        greatest = FMAX(greatest, parts[k * stride + t].greatest);
    }
    put_sum(scratch, 0, own, high, low);
    most[own] = greatest;
    sum_group(scratch, 1, own);
    if (own == 0) {
        for (int k = 0; k < SUM_GROUP; ++k) greatest = FMAX(greatest, most[k]);
        sums[t].high = scratch[0];
        sums[t].low = scratch[SUM_GROUP];
        sums[t].greatest = greatest;
    }
}

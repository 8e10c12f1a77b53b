#include "language.h"

#include "heat_types.h"
#include "scan_group.h"
#include "sum_group.h"

// A heat step (docs/physics.md section 6), the same operations in the same order as thermal/kernel_scalar.cpp. A
// work-group is a block of HEAT_BLOCK consecutive cells.
//
// Work-groups of blocks at rest only add up noughts. (They could return at once, but PoCL 3.1 makes wrong code of
// returns before barriers.)
//
//     heat_active   which blocks take part          heat_settle   boiling, temperature, damage
//     heat_tip      the hot wire                    heat_totals   sums, and where lists go
//     heat_flow     Joule heat, conduction, ...     heat_list     what is gas, what boiled off

#define LATENT_HEAT_J_PER_KG 2.26e6f
#define DAMAGE_THRESHOLD_K 316.15f
#define DAMAGE_REFERENCE_K 333.15f
#define DAMAGE_LIMIT 1e6f
#define REST_K 1e-3f

// Counts of a block in one word.
#define COUNT_SPENT 1
#define COUNT_BOILED (1 << 10)
#define COUNT_WARM (1 << 20)
#define COUNT_MASK 1023

/// Whether a block ever held tissue.
FN int populated(struct GpuHeatStep step, GLOBAL const uint* initial, int block) {
    const int begin = step.first + block * HEAT_BLOCK;
    uint any = 0u;
    for (int i = begin; i < begin + HEAT_BLOCK && i < step.last; i += 32) any |= bits_from(initial, i);
    return any != 0u;
}

/// Whether some of a block's cells are between the first and last ones of a plane of the Joule box.
FN int in_joule_box(struct GpuHeatStep step, int block) {
    if (step.joule_size[0] == 0) return 0;
    const int low = block * HEAT_BLOCK, high = low + HEAT_BLOCK - 1;
    for (int plane = low / step.plane; plane <= high / step.plane; ++plane) {
        const int p = plane - step.joule_low[2];
        if (p < 0 || p >= step.joule_size[2]) continue;
        const int begin = plane * step.plane + IMAX(step.joule_low[1], 0) * step.row;
        const int end = plane * step.plane + (step.joule_low[1] + step.joule_size[1]) * step.row;
        if (begin <= high && low < end) return 1;
    }
    return 0;
}

/// Blocks with tissue that are warm, beside a warm one, or get Joule heat.
KERNEL void heat_active(struct GpuHeatStep step, GLOBAL const uint* initial, GLOBAL const int* warm, GLOBAL int* active,
                        GLOBAL struct GpuHeatTotals* totals) {
    const int block = GLOBAL_ID;
    if (block == 0) {
        totals->bad_hexel = HEAT_NONE;
        totals->tip_high = 0.0f;
        totals->tip_low = 0.0f;
    }
    if (block >= step.blocks) return;
    int on = warm[block] != 0 || in_joule_box(step, block);
    // A block moved by `stride` cells lies across one or two blocks.
    for (int axis = 0; axis < 3; ++axis) {
        const int whole = step.stride[axis] / HEAT_BLOCK;
        for (int k = whole; k <= whole + 1; ++k) {
            if (block - k >= 0) on |= warm[block - k];
            if (block + k < step.blocks) on |= warm[block + k];
        }
    }
    active[block] = on != 0 && populated(step, initial, block);
}

/// By one group: what the hot wire gives the hexels that it touches (thermal/tip.h).
KERNEL void heat_tip(struct GpuHeatStep step, GLOBAL const struct GpuTouch* touched, int count, float tip_rise_K,
                     GLOBAL const float* temperature_K, GLOBAL float* enthalpy_J_per_m3, GLOBAL int* active,
                     GLOBAL struct GpuHeatTotals* totals) {
    SHARED float scratch[2 * SUM_GROUP];
    float high = 0.0f, low = 0.0f;
    for (int k = LOCAL_ID; k < count; k += SUM_GROUP) {
        const int i = touched[k].hexel;
        const float rise_K = temperature_K[i] - step.body_K;
        const float before = enthalpy_J_per_m3[i];
        const float after = before + touched[k].passed_J_per_m3K * (tip_rise_K - rise_K);
        enthalpy_J_per_m3[i] = after;
        if (after == before) continue;
        active[(i - step.first) / HEAT_BLOCK] = 1;
        add_pair(&high, &low, before - after, 0.0f);
    }
    put_sum(scratch, 0, LOCAL_ID, high, low);
    sum_group(scratch, 1, LOCAL_ID);
    if (LOCAL_ID == 0) {
        totals->tip_high = scratch[0];
        totals->tip_low = scratch[SUM_GROUP];
    }
}

/// Harmonic mean: the conductance of two half cells in series.
FN float face_conductivity(float a, float b) {
    return a == b ? a : 2.0f * (a * b) / (a + b);
}

/// Share of blood flow that damage leaves (thermal/kernel_scalar.cpp).
FN float flow_left(float damage) {
    const float healthy = 1.0f - FMIN(damage, 1.0f);
    return healthy * healthy * (3.0f - 2.0f * healthy);
}

/// What a face of a hexel's surface counts, in 1/255: 1 / (|nx| + |ny| + |nz|), the normal n told from the 26 cells
/// around it, each with 1 over the square of its distance as its weight (thermal/groups.h). Weights here are six times
/// that, so that sums are exact.
FN float face_share(struct GpuHeatStep step, GLOBAL const uint* present, int cell) {
    int nx = 0, ny = 0, nz = 0;
    for (int z = -1; z <= 1; ++z)
        for (int y = -1; y <= 1; ++y)
            for (int x = -1; x <= 1; ++x) {
                const int square = x * x + y * y + z * z;
                if (square == 0 ||
                    !test_bit(present, cell + x * step.stride[0] + y * step.stride[1] + z * step.stride[2]))
                    continue;
                const int weight = 6 / square;
                nx += weight * x;
                ny += weight * y;
                nz += weight * z;
            }
    const int sum = (nx < 0 ? -nx : nx) + (ny < 0 ? -ny : ny) + (nz < 0 ? -nz : nz);
    if (sum == 0) return 1.0f;
    const float share = SQRT((float)(nx * nx + ny * ny + nz * nz)) / (float)sum;
    return FLOOR(255.0f * share + 0.5f) * (1.0f / 255.0f);
}

/// Joule heat that a step brings to a hexel.
FN float joule_heat(struct GpuHeatStep step, GLOBAL const float* joule_S_per_m3, int cell) {
    if (step.joule_size[0] == 0) return 0.0f;
    const int rest = cell - step.first;
    const int plane = rest / step.plane, in_plane = rest - plane * step.plane, row = in_plane / step.row;
    const int a = in_plane - row * step.row - step.joule_low[0], b = row - step.joule_low[1],
              c = plane - step.joule_low[2];
    if (a < 0 || b < 0 || c < 0 || a >= step.joule_size[0] || b >= step.joule_size[1] || c >= step.joule_size[2])
        return 0.0f;
    return joule_S_per_m3[(c * step.joule_size[1] + b) * step.joule_size[0] + a] * step.joule_V2_s;
}

KERNEL void heat_flow(struct GpuHeatStep step, GLOBAL const struct GpuHeatMaterial* materials,
                      GLOBAL const uchar* material, GLOBAL const uint* present, GLOBAL const uint* held,
                      GLOBAL const int* active, GLOBAL const float* temperature_K, GLOBAL const float* damage,
                      GLOBAL const float* joule_S_per_m3, GLOBAL float* enthalpy_J_per_m3, GLOBAL float* sums) {
    SHARED float scratch[3 * 2 * SUM_GROUP];
    const int item = LOCAL_ID, block = GROUP_ID, i = step.first + GLOBAL_ID;
    float delivered = 0.0f, perfused = 0.0f, surface = 0.0f, surface_rest = 0.0f;
    if (active[block] != 0 && i < step.last && test_bit(present, i)) {
        const int m = material[i];
        const float own_K = temperature_K[i], start = enthalpy_J_per_m3[i];
        const float before = start + joule_heat(step, joule_S_per_m3, i);
        delivered = before - start;
        const float conducts = materials[m].conducted_J_per_m3K;
        float flow = 0.0f;
        int gas = 0, to_held = 0;
        for (int axis = 0; axis < 3; ++axis)
            for (int side = -1; side <= 1; side += 2) {
                const int j = i + side * step.stride[axis];
                if (test_bit(present, j)) {
                    flow += face_conductivity(conducts, materials[material[j]].conducted_J_per_m3K) *
                            (temperature_K[j] - own_K);
                } else if (test_bit(held, j)) {
                    ++to_held;
                } else {
                    ++gas;
                }
            }
        const float rise_K = own_K - step.body_K;
        const float conducted = before + flow;
        const float bled = conducted - materials[m].to_blood_J_per_m3K * flow_left(damage[i]) * rise_K;
        perfused = conducted - bled;
        float next = bled;
        if (gas + to_held > 0 && rise_K != 0.0f) {
            const float share = face_share(step, present, i);
            const float left = bled - materials[m].to_held_J_per_m3K * (share * (float)to_held) * rise_K;
            // Gas takes only heat above body temperature.
            float to_gas =
                rise_K > 0.0f ? materials[m].to_gas_J_per_m3K * (share * (float)gas) * (own_K - step.gas_K) : 0.0f;
            to_gas = FMIN(to_gas, FMAX(left, 0.0f));
            next = left - to_gas;
            surface = bled - left;
            surface_rest = left - next;
        }
        enthalpy_J_per_m3[i] = next;
    }
    put_sum(scratch, 0, item, delivered, 0.0f);
    put_sum(scratch, 1, item, perfused, 0.0f);
    put_sum(scratch, 2, item, surface, surface_rest);
    sum_group(scratch, 3, item);
    if (item < 6) sums[block * 2 * HEAT_SUMS + item] = scratch[item * SUM_GROUP];
}

FN float capacity_of(GLOBAL const struct GpuHeatMaterial* m, float water_kg_per_m3) {
    return m->dry_capacity_J_per_m3K + water_kg_per_m3 * m->water_capacity_J_per_kgK;
}
/// Temperature above T_0 (tissue/phase.h).
FN float rise_of(struct GpuHeatStep step, GLOBAL const struct GpuHeatMaterial* m, float enthalpy, float water) {
    const int wet = !step.threshold && water > 0.0f;
    const float rise = FMIN(enthalpy * (1.0f / capacity_of(m, water)), wet ? step.wet_limit_K : m->dry_limit_K);
    return FABS(rise) < REST_K ? 0.0f : rise;
}
FN int is_spent(struct GpuHeatStep step, GLOBAL const struct GpuHeatMaterial* m, float enthalpy, float water) {
    return enthalpy >= m->spent_J_per_m3 && (step.threshold || !(water > 0.0f));
}

/// Adds up counts (COUNT_*) and pairs of sums of a group.
FN int count_group(LOCAL int* counts, int item, int own) {
    counts[item] = own;
    for (int k = HEAT_BLOCK / 2; k > 0; k /= 2) {
        BARRIER;
        if (item < k) counts[item] += counts[item + k];
    }
    BARRIER;
    return counts[0];
}

KERNEL void heat_settle(struct GpuHeatStep step, GLOBAL const struct GpuHeatMaterial* materials,
                        GLOBAL const uchar* material, GLOBAL const uint* present, GLOBAL const int* active,
                        GLOBAL float* temperature_K, GLOBAL float* enthalpy_J_per_m3, GLOBAL float* water_kg_per_m3,
                        GLOBAL float* peak_temperature_K, GLOBAL float* damage, GLOBAL float* steam_kg_per_m3,
                        GLOBAL int* warm, GLOBAL int* counts, GLOBAL float* sums, GLOBAL struct GpuHeatTotals* totals) {
    SHARED float scratch[2 * 2 * SUM_GROUP];
    SHARED int counted[HEAT_BLOCK];
    const int item = LOCAL_ID, block = GROUP_ID, i = step.first + GLOBAL_ID;
    float gas = 0.0f, latent = 0.0f;
    int found = 0;
    if (active[block] != 0 && i < step.last && test_bit(present, i)) {
        GLOBAL const struct GpuHeatMaterial* m = materials + material[i];
        float enthalpy = enthalpy_J_per_m3[i], water = water_kg_per_m3[i];
        if (!(FABS(enthalpy) < 1e30f)) ATOMIC_MIN(&totals->bad_hexel, i);
        if (step.threshold) {  // water is a function of H
            const float taken = FMAX(enthalpy - m->plateau_J_per_m3, 0.0f);
            water = FMAX(m->water_kg_per_m3 - taken / LATENT_HEAT_J_PER_KG, 0.0f);
            water_kg_per_m3[i] = water;
        } else if (water > 0.0f) {
            // What exceeds the boiling point turns water to steam.
            const float excess = enthalpy - capacity_of(m, water) * step.wet_limit_K;
            if (excess > 0.0f) {
                const float left = FMAX(water - excess / LATENT_HEAT_J_PER_KG, 0.0f), steam = water - left;
                const float next = enthalpy - steam * m->boil_off_J_per_kg;
                gas = enthalpy - next;
                latent = steam * LATENT_HEAT_J_PER_KG;
                steam_kg_per_m3[i] = steam;
                if (steam > 0.0f) found += COUNT_BOILED;
                water = left;
                enthalpy = next;
                water_kg_per_m3[i] = water;
                enthalpy_J_per_m3[i] = enthalpy;
            }
        }
        const float now_K = step.body_K + rise_of(step, m, enthalpy, water);
        temperature_K[i] = now_K;
        if (now_K != step.body_K) found += COUNT_WARM;
        if (is_spent(step, m, enthalpy, water)) found += COUNT_SPENT;
        if (now_K > DAMAGE_THRESHOLD_K) {
            peak_temperature_K[i] = FMAX(peak_temperature_K[i], now_K);
            const float exponent = m->damage_log_rate + m->damage_slope * ((now_K - DAMAGE_REFERENCE_K) / now_K);
            damage[i] = FMIN(damage[i] + EXP(FMIN(exponent, 40.0f)) * step.dt_s, DAMAGE_LIMIT);
        }
    }
    put_sum(scratch, 0, item, gas, 0.0f);
    put_sum(scratch, 1, item, latent, 0.0f);
    sum_group(scratch, 2, item);
    const int all = count_group(counted, item, found);
    if (item < 4) sums[block * 2 * HEAT_SUMS + 2 * HEAT_GAS + item] = scratch[item * SUM_GROUP];
    if (item == 0) {
        counts[block] = all;
        warm[block] = all / COUNT_WARM != 0;
    }
}

/// What heat_settle knows of a state that somebody else made.
KERNEL void heat_look(struct GpuHeatStep step, GLOBAL const struct GpuHeatMaterial* materials,
                      GLOBAL const uchar* material, GLOBAL const uint* present, GLOBAL float* temperature_K,
                      GLOBAL const float* enthalpy_J_per_m3, GLOBAL const float* water_kg_per_m3,
                      GLOBAL float* steam_kg_per_m3, GLOBAL int* warm, GLOBAL int* counts, GLOBAL float* sums) {
    SHARED int counted[HEAT_BLOCK];
    const int item = LOCAL_ID, block = GROUP_ID, i = step.first + GLOBAL_ID;
    int found = 0;
    if (i < step.last) {
        float now_K = step.body_K;
        if (test_bit(present, i)) {
            GLOBAL const struct GpuHeatMaterial* m = materials + material[i];
            const float enthalpy = enthalpy_J_per_m3[i], water = water_kg_per_m3[i];
            now_K += rise_of(step, m, enthalpy, water);
            if (now_K != step.body_K) found += COUNT_WARM;
            if (is_spent(step, m, enthalpy, water)) found += COUNT_SPENT;
        }
        temperature_K[i] = now_K;
        steam_kg_per_m3[i] = 0.0f;
    }
    const int all = count_group(counted, item, found);
    if (item < 2 * HEAT_SUMS) sums[block * 2 * HEAT_SUMS + item] = 0.0f;
    if (item == 0) {
        counts[block] = all;
        warm[block] = all / COUNT_WARM != 0;
    }
}

/// By one group: sums of all blocks, and what lies before each block's part of the lists. Each item takes a run of
/// blocks.
KERNEL void heat_totals(struct GpuHeatStep step, GLOBAL const int* counts, GLOBAL const float* sums, GLOBAL int* places,
                        GLOBAL struct GpuHeatTotals* totals) {
    SHARED float scratch[HEAT_SUMS * 2 * SUM_GROUP];
    SHARED int spent_scan[SCAN_GROUP];
    SHARED int boiled_scan[SCAN_GROUP];
    const int item = LOCAL_ID, run = (step.blocks + SUM_GROUP - 1) / SUM_GROUP;
    const int begin = IMIN(item * run, step.blocks), end = IMIN(begin + run, step.blocks);
    float high[HEAT_SUMS], low[HEAT_SUMS];
    for (int s = 0; s < HEAT_SUMS; ++s) high[s] = low[s] = 0.0f;
    int spent = 0, boiled = 0;
    for (int block = begin; block < end; ++block) {
        spent += counts[block] & COUNT_MASK;
        boiled += counts[block] / COUNT_BOILED & COUNT_MASK;
        for (int s = 0; s < HEAT_SUMS; ++s) {
            GLOBAL const float* sum = sums + (block * HEAT_SUMS + s) * 2;
            add_pair(&high[s], &low[s], sum[0], sum[1]);
        }
    }
    for (int s = 0; s < HEAT_SUMS; ++s) put_sum(scratch, s, item, high[s], low[s]);
    sum_group(scratch, HEAT_SUMS, item);
    scan_group(spent_scan, item, spent);
    scan_group(boiled_scan, item, boiled);
    int spent_at = spent_scan[item] - spent, boiled_at = boiled_scan[item] - boiled;
    for (int block = begin; block < end; ++block) {
        places[2 * block] = spent_at;
        places[2 * block + 1] = boiled_at;
        spent_at += counts[block] & COUNT_MASK;
        boiled_at += counts[block] / COUNT_BOILED & COUNT_MASK;
    }
    if (item == SUM_GROUP - 1) {
        totals->spent = spent_at;
        totals->boiled = boiled_at;
    }
    if (item < HEAT_SUMS) {
        totals->high[item] = scratch[2 * item * SUM_GROUP];
        totals->low[item] = scratch[(2 * item + 1) * SUM_GROUP];
    }
}

/// Lists, in the order of cells, what is gas with its enthalpy, and what boiled with its steam.
KERNEL void heat_list(struct GpuHeatStep step, GLOBAL const struct GpuHeatMaterial* materials,
                      GLOBAL const uchar* material, GLOBAL const uint* present, GLOBAL const int* counts,
                      GLOBAL const int* places, GLOBAL const float* enthalpy_J_per_m3,
                      GLOBAL const float* water_kg_per_m3, GLOBAL float* steam_kg_per_m3,
                      GLOBAL struct GpuHexelValue* spent_list, int spent_room, GLOBAL struct GpuHexelValue* boiled_list,
                      int boiled_room) {
    SHARED int scan[SCAN_GROUP];
    const int item = LOCAL_ID, block = GROUP_ID, i = step.first + GLOBAL_ID;
    int spent = 0, boiled = 0;
    if ((counts[block] & (COUNT_WARM - 1)) != 0 && i < step.last && test_bit(present, i)) {
        spent = is_spent(step, materials + material[i], enthalpy_J_per_m3[i], water_kg_per_m3[i]);
        boiled = steam_kg_per_m3[i] > 0.0f;
    }
    scan_group(scan, item, spent * COUNT_SPENT + boiled * COUNT_BOILED);
    const int before = scan[item] - spent * COUNT_SPENT - boiled * COUNT_BOILED;
    if (spent) {
        const int at = places[2 * block] + (before & COUNT_MASK);
        if (at < spent_room) {
            spent_list[at].hexel = i;
            spent_list[at].value = enthalpy_J_per_m3[i];
        }
    }
    if (boiled) {
        const int at = places[2 * block + 1] + before / COUNT_BOILED;
        if (at < boiled_room) {
            boiled_list[at].hexel = i;
            boiled_list[at].value = steam_kg_per_m3[i];
        }
        steam_kg_per_m3[i] = 0.0f;
    }
}

/// Takes hexels out.
KERNEL void heat_remove(GLOBAL const int* hexels, int count, GLOBAL uint* present, GLOBAL float* enthalpy_J_per_m3,
                        GLOBAL float* water_kg_per_m3) {
    if (GLOBAL_ID >= count) return;
    const int i = hexels[GLOBAL_ID];
    ATOMIC_AND(&present[i >> 5], ~(1u << (i & 31)));
    enthalpy_J_per_m3[i] = 0.0f;
    water_kg_per_m3[i] = 0.0f;
}

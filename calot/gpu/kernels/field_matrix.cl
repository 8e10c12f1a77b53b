#include "language.h"

#include "field_level.h"
#include "field_window.h"
#include "sum_group.h"

// The electric field about the tip (docs/physics.md section 5), from the tissue to the matrix: what
// electric/assemble.cpp and multigrid.cpp do, cell by cell.

#define DAMPING 0.85f  // electric/kernels.h: kDamping

/// Conductivity of a hexel (electric/kernels.h).
FN float conductivity(GLOBAL const struct GpuConductor* conductors, float wet_limit_K, GLOBAL const float* rest_S_per_m,
                      GLOBAL const uchar* material, GLOBAL const uint* present, GLOBAL const uint* held,
                      GLOBAL const float* enthalpy_J_per_m3, GLOBAL const float* water_kg_per_m3, int hexel) {
    const int there = test_bit(present, hexel);
    if (!there && !test_bit(held, hexel)) return 0.0f;
    const float enthalpy = enthalpy_J_per_m3[hexel], rest = rest_S_per_m[hexel];
    if (!there || enthalpy == 0.0f) return rest;
    GLOBAL const struct GpuConductor* m = conductors + material[hexel];
    const float water = water_kg_per_m3[hexel];
    const float capacity = m->dry_capacity_J_per_m3K + water * m->water_capacity_J_per_kgK;
    const float rise = FMIN(enthalpy * (1.0f / capacity), wet_limit_K);
    const float wet = rest * (1.0f + m->slope_per_K * rise);
    const float missing = (m->alive_water_kg_per_m3 - water) * m->per_water_m3_per_kg;
    return wet - (wet - m->dry_S_per_m) * missing;
}

/// Conductivities of the window, 0 beyond the lattice; no metal yet.
KERNEL void field_gather(struct GpuWindow window, struct GpuLevel fine, GLOBAL const struct GpuConductor* conductors,
                         float wet_limit_K, GLOBAL const float* rest_S_per_m, GLOBAL const uchar* material,
                         GLOBAL const uint* present, GLOBAL const uint* held, GLOBAL const float* enthalpy_J_per_m3,
                         GLOBAL const float* water_kg_per_m3, GLOBAL float* sigma_S_per_m, GLOBAL float* metal,
                         GLOBAL float* wire, GLOBAL int* entered, GLOBAL struct GpuFieldScalars* scalars) {
    const int item = GLOBAL_ID;
    if (item == 0) {
        scalars->contacts = 0;
        scalars->arcs = 0;
    }
    if (item >= level_items(fine)) return;
    int a, b, c;
    level_place(fine, item, &a, &b, &c);
    const int i = fine.first + item;
    sigma_S_per_m[i] = in_window(window, a, b, c)
                           ? conductivity(conductors, wet_limit_K, rest_S_per_m, material, present, held,
                                          enthalpy_J_per_m3, water_kg_per_m3, hexel_of(window, a, b, c))
                           : 0.0f;
    metal[i] = 0.0f;
    wire[i] = 0.0f;
    entered[i] = 0;
}

/// Marks cells that current enters.
KERNEL void field_enter(GLOBAL const struct GpuEntry* entries, int count, GLOBAL const float* sigma_S_per_m,
                        GLOBAL int* entered) {
    if (GLOBAL_ID >= count) return;
    const int cell = entries[GLOBAL_ID].cell;
    if (sigma_S_per_m[cell] > 0.0f) entered[cell] = 1;
}

/// Arcs keep dried tissue conducting in hexels at the metal and in those behind their faces.
KERNEL void field_burn(struct GpuWindow window, struct GpuLevel fine, float arc_S_per_m,
                       GLOBAL const float* rest_S_per_m, GLOBAL const int* entered, GLOBAL float* sigma_S_per_m) {
    const int item = GLOBAL_ID, i = fine.first + item;
    if (item >= level_items(fine) || !(sigma_S_per_m[i] > 0.0f)) return;
    int a, b, c;
    level_place(fine, item, &a, &b, &c);
    int burnt = entered[i];
    if (a > 0) burnt |= entered[i - 1];
    if (a + 1 < fine.row) burnt |= entered[i + 1];
    if (b > 0) burnt |= entered[i - fine.row];
    if (b + 1 < fine.rows) burnt |= entered[i + fine.row];
    burnt |= entered[i - fine.plane] | entered[i + fine.plane];
    if (burnt) sigma_S_per_m[i] = FMAX(sigma_S_per_m[i], FMIN(rest_S_per_m[hexel_of(window, a, b, c)], arc_S_per_m));
}

/// Faces of an entry that look at gas on the metal's side, and more where the metal ends (electric/assemble.cpp).
FN float face_weight(struct GpuLevel fine, float edge, GLOBAL const float* outward, GLOBAL const float* sigma,
                     GLOBAL const int* entered, int cell) {
    const int step[3] = {1, fine.row, fine.plane};
    float faces = 0.0f;
    for (int axis = 0; axis < 3; ++axis)
        for (int side = -1; side <= 1; side += 2) {
            const int out = side * step[axis];
            if (sigma[cell + out] > 0.0f || (float)side * outward[axis] < 0.0f) continue;
            faces += 1.0f;
            for (int along = 0; along < 3; ++along)
                for (int k = -1; k <= 1; k += 2) {
                    const int beside = cell + k * step[along];
                    if (along != axis && sigma[beside] > 0.0f && !(sigma[beside + out] > 0.0f) && !entered[beside])
                        faces += edge;
                }
        }
    return FMIN(FMAX(faces, 1.0f), 3.0f + 4.0f * edge);
}

/// Metal to the centre of every entry: char, arc and half a cell in series.
KERNEL void field_connect(struct GpuLevel fine, struct GpuMetal p, GLOBAL const struct GpuEntry* entries, int count,
                          GLOBAL const float* sigma_S_per_m, GLOBAL const int* entered, GLOBAL float* metal,
                          GLOBAL float* wire, GLOBAL struct GpuFieldScalars* scalars) {
    if (GLOBAL_ID >= count) return;
    GLOBAL const struct GpuEntry* entry = entries + GLOBAL_ID;
    const int cell = entry->cell;
    if (!entered[cell]) return;
    const float faces = face_weight(fine, p.edge, entry->outward, sigma_S_per_m, entered, cell);
    const int arcs = entry->gap_m > p.contact_gap_m;
    const float arc = arcs ? p.arc + p.arc_per_m * entry->gap_m : 0.0f;
    const float inverse = 1.0f / (2.0f * sigma_S_per_m[cell] * faces) + p.film / faces + arc;
    metal[cell] = 1.0f / inverse;
    wire[cell] = p.wire_share * arc / inverse;
    if (arcs)
        ATOMIC_ADD(&scalars->arcs, 1);
    else
        ATOMIC_ADD(&scalars->contacts, 1);
}

FN float in_series(float here, float there) {
    return (2.0f * here) * there / FMAX(here + there, 1e-30f);
}

/// g between cells, and what couples each with metal and the far return.
KERNEL void field_faces(struct GpuWindow window, struct GpuLevel fine, struct GpuPoles poles,
                        GLOBAL const float* sigma_S_per_m, GLOBAL const float* metal, GLOBAL float* grid) {
    const int item = GLOBAL_ID, i = fine.first + item;
    if (item >= level_items(fine)) return;
    int a, b, c;
    level_place(fine, item, &a, &b, &c);
    const float here = sigma_S_per_m[i];
    float ground = metal[i];
    if (here > 0.0f)
        for (int n = 0; n < 6; ++n) ground += here * cell_outer_share(window, poles, a, b, c, n);
    // The last cell of a row is followed by the next row, the last row by the next plane.
    vector_of(grid, fine, LEVEL_GX)[i] = a + 1 < fine.row ? in_series(here, sigma_S_per_m[i + 1]) : 0.0f;
    vector_of(grid, fine, LEVEL_GY)[i] = b + 1 < fine.rows ? in_series(here, sigma_S_per_m[i + fine.row]) : 0.0f;
    vector_of(grid, fine, LEVEL_GZ)[i] = in_series(here, sigma_S_per_m[i + fine.plane]);
    vector_of(grid, fine, LEVEL_GROUND)[i] = ground;
}

FN void set_weight(struct GpuLevel l, GLOBAL float* grid, int i) {
    GLOBAL const float* gx = vector_of(grid, l, LEVEL_GX);
    GLOBAL const float* gy = vector_of(grid, l, LEVEL_GY);
    GLOBAL const float* gz = vector_of(grid, l, LEVEL_GZ);
    float sum = vector_of(grid, l, LEVEL_GROUND)[i] + (gx[i] + gx[i - 1]);
    sum = sum + (gy[i] + gy[i - l.row]);
    sum = sum + (gz[i] + gz[i - l.plane]);
    vector_of(grid, l, LEVEL_WEIGHT)[i] = sum > 0.0f ? DAMPING / sum : 0.0f;
}
KERNEL void field_weights(struct GpuLevel l, GLOBAL float* grid) {
    if (GLOBAL_ID < level_items(l)) set_weight(l, grid, l.first + GLOBAL_ID);
}

/// Galerkin sum of 2x2x2 cells.
FN void aggregate_cell(struct GpuLevel fine, struct GpuLevel coarse, GLOBAL float* grid, int item) {
    int a, b, c;
    level_place(coarse, item, &a, &b, &c);
    if (a >= coarse.cells || b >= coarse.cells || c >= coarse.cells) return;
    const int f = level_cell(fine, 2 * a, 2 * b, 2 * c), i = coarse.first + item, y = fine.row, z = fine.plane;
    GLOBAL const float* gx = vector_of(grid, fine, LEVEL_GX) + f;
    GLOBAL const float* gy = vector_of(grid, fine, LEVEL_GY) + f;
    GLOBAL const float* gz = vector_of(grid, fine, LEVEL_GZ) + f;
    GLOBAL const float* ground = vector_of(grid, fine, LEVEL_GROUND) + f;
    vector_of(grid, coarse, LEVEL_GX)[i] = (gx[1] + gx[1 + y]) + (gx[1 + z] + gx[1 + y + z]);
    vector_of(grid, coarse, LEVEL_GY)[i] = (gy[y] + gy[y + z]) + (gy[y + 1] + gy[y + z + 1]);
    vector_of(grid, coarse, LEVEL_GZ)[i] = (gz[z] + gz[y + z]) + (gz[z + 1] + gz[y + z + 1]);
    vector_of(grid, coarse, LEVEL_GROUND)[i] = ((ground[0] + ground[y]) + (ground[z] + ground[y + z])) +
                                               ((ground[1] + ground[1 + y]) + (ground[1 + z] + ground[1 + y + z]));
}
KERNEL void field_aggregate(struct GpuLevel fine, struct GpuLevel coarse, GLOBAL float* grid) {
    if (GLOBAL_ID < level_items(coarse)) aggregate_cell(fine, coarse, grid, GLOBAL_ID);
}
/// By one group: the matrices of all small levels.
KERNEL void field_aggregate_small(struct GpuLevels levels, GLOBAL float* grid) {
    for (int l = levels.small; l < levels.count; ++l) {
        const int items = level_items(levels.level[l]);
        for (int k = LOCAL_ID; k < items; k += SUM_GROUP) aggregate_cell(levels.level[l - 1], levels.level[l], grid, k);
        BARRIER;
        for (int k = LOCAL_ID; k < items; k += SUM_GROUP) set_weight(levels.level[l], grid, levels.level[l].first + k);
        BARRIER;
    }
}

/// The last potential as a first guess; cells that the window has not seen before take that of the nearest.
KERNEL void field_guess(struct GpuLevel fine, int cells, int shift_a, int shift_b, int shift_c,
                        GLOBAL const float* potential, GLOBAL float* grid, GLOBAL float* x) {
    const int item = GLOBAL_ID;
    if (item >= level_items(fine)) return;
    int a, b, c;
    level_place(fine, item, &a, &b, &c);
    const int last = cells - 1;
    a = IMIN(IMAX(a + shift_a, 0), last);
    b = IMIN(IMAX(b + shift_b, 0), last);
    c = IMIN(IMAX(c + shift_c, 0), last);
    const int i = fine.first + item;
    x[i] = vector_of(grid, fine, LEVEL_WEIGHT)[i] > 0.0f ? potential[a + cells * (b + cells * c)] : 0.0f;
}

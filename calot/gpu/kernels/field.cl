#include "language.h"

#include "field_types.h"
#include "sum_group.h"

// The electric field about the tip (docs/physics.md section 5): what electric/assemble.cpp, multigrid.cpp and joule.cpp
// do, cell by cell. One work-item is one cell of a level, padding at the ends of rows included; cells without an
// unknown have no weight.

#define DAMPING 0.85f      // electric/kernels.h: kDamping
#define CORRECTION 1.6f    // kCorrection
#define ADDED 2.0f         // kAdded
#define COARSEST_SWEEPS 4  // even: each pair ends where it began

FN int level_items(struct GpuLevel l) {
    return l.row * l.rows * l.rows;
}
FN int level_cell(struct GpuLevel l, int a, int b, int c) {
    return l.first + a + b * l.row + c * l.plane;
}
FN void level_place(struct GpuLevel l, int item, int* a, int* b, int* c) {
    *c = item / l.plane;
    const int in_plane = item - *c * l.plane;
    *b = in_plane / l.row;
    *a = in_plane - *b * l.row;
}
FN GLOBAL float* vector_of(GLOBAL float* grid, struct GpuLevel l, int which) {
    return grid + l.at + which * l.length;
}

// --- From the tissue to the matrix

FN int in_window(struct GpuWindow w, int a, int b, int c) {
    return a >= w.begin[0] && b >= w.begin[1] && c >= w.begin[2] && a < w.end[0] && b < w.end[1] && c < w.end[2];
}
FN int hexel_of(struct GpuWindow w, int a, int b, int c) {
    return w.base + a + b * w.stride[0] + c * w.stride[1];
}

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

/// Of the conductance of half a cell and beyond, in units of sigma: share of an outer face (electric/poles.h).
FN float outer_share(struct GpuPoles poles, const float* face, int axis, float side) {
    float d1 = 0.0f, d2 = 0.0f;
    for (int k = 0; k < 3; ++k) {
        d1 += (face[k] - poles.source[k]) * (face[k] - poles.source[k]);
        d2 += (face[k] - poles.sink[k]) * (face[k] - poles.sink[k]);
    }
    const float through = FMAX(0.0f, side * (face[axis] - poles.source[axis]));
    if (!poles.placed) return through / (d1 + 0.5f * through);
    d2 = FMAX(d2, 1.0f);
    const float i1 = 1.0f / SQRT(d1), i2 = 1.0f / SQRT(d2);
    const float slope = FMAX(0.0f, through * i1 / d1 - side * (face[axis] - poles.sink[axis]) * i2 / d2);
    const float level = i1 - i2 + poles.rest;
    return level > 0.0f ? slope / (level + 0.5f * slope) : 0.0f;
}
/// The share of face n (-a, +a, -b, ...) of a cell; 0 where it is no outer face.
FN float cell_outer_share(struct GpuWindow w, struct GpuPoles poles, int a, int b, int c, int n) {
    const int place[3] = {a, b, c};
    const int axis = n / 2, up = n & 1;
    if (!in_window(w, a, b, c) || place[axis] != (up ? w.end[axis] - 1 : w.begin[axis])) return 0.0f;
    float face[3] = {(float)a, (float)b, (float)c};
    face[axis] += up ? 0.5f : -0.5f;
    return outer_share(poles, face, axis, up ? 1.0f : -1.0f);
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

// --- Conjugate gradients. Sums of groups are parts, which one group adds up. When the residual is small enough, `done`
// is set and further iterations change nothing. (Their groups come to every barrier all the same: see heat.cl.)

FN float row_times(struct GpuLevel l, GLOBAL float* grid, GLOBAL const float* z, int i) {
    GLOBAL const float* gx = vector_of(grid, l, LEVEL_GX);
    GLOBAL const float* gy = vector_of(grid, l, LEVEL_GY);
    GLOBAL const float* gz = vector_of(grid, l, LEVEL_GZ);
    const float here = z[i];
    float flow = gx[i] * (here - z[i + 1]) + gx[i - 1] * (here - z[i - 1]);
    flow = flow + (gy[i] * (here - z[i + l.row]) + gy[i - l.row] * (here - z[i - l.row]));
    flow = flow + (gz[i] * (here - z[i + l.plane]) + gz[i - l.plane] * (here - z[i - l.plane]));
    return flow + vector_of(grid, l, LEVEL_GROUND)[i] * here;
}

#define MOST_VALUES 3

/// Writes the sums of a group's values.
FN void put_part(LOCAL float* scratch, int values, GLOBAL float* parts) {
    sum_group(scratch, values, LOCAL_ID);
    if (LOCAL_ID < 2 * values) parts[GROUP_ID * 2 * values + LOCAL_ID] = scratch[LOCAL_ID * SUM_GROUP];
}
/// By one group: sums of all parts, in scratch as sum_group leaves them.
FN void add_parts(LOCAL float* scratch, int values, GLOBAL const float* parts, int groups) {
    for (int v = 0; v < values; ++v) {
        float high = 0.0f, low = 0.0f;
        for (int k = LOCAL_ID; k < groups; k += SUM_GROUP)
            add_pair(&high, &low, parts[(k * values + v) * 2], parts[(k * values + v) * 2 + 1]);
        put_sum(scratch, v, LOCAL_ID, high, low);
    }
    sum_group(scratch, values, LOCAL_ID);
}
FN float sum_of(LOCAL const float* scratch, int v) {
    return scratch[2 * v * SUM_GROUP] + scratch[(2 * v + 1) * SUM_GROUP];
}

/// scratch = A x; parts: x . A x, b . x, b . b.
KERNEL void field_begin(struct GpuLevel fine, GLOBAL float* grid, GLOBAL const float* metal, GLOBAL const float* x,
                        GLOBAL float* parts) {
    SHARED float scratch[2 * MOST_VALUES * SUM_GROUP];
    const int item = GLOBAL_ID, i = fine.first + item;
    float curvature = 0.0f, along = 0.0f, norm = 0.0f;
    if (item < level_items(fine)) {
        const float value = row_times(fine, grid, x, i), b = metal[i];
        vector_of(grid, fine, LEVEL_SCRATCH)[i] = value;
        curvature = x[i] * value;
        along = b * x[i];
        norm = b * b;
    }
    put_sum(scratch, 0, LOCAL_ID, curvature, 0.0f);
    put_sum(scratch, 1, LOCAL_ID, along, 0.0f);
    put_sum(scratch, 2, LOCAL_ID, norm, 0.0f);
    put_part(scratch, 3, parts);
}
KERNEL void field_begin_scalars(GLOBAL const float* parts, int groups, float relative_residual,
                                GLOBAL struct GpuFieldScalars* s) {
    SHARED float scratch[2 * MOST_VALUES * SUM_GROUP];
    add_parts(scratch, 3, parts, groups);
    if (LOCAL_ID == 0) {
        const float curvature = sum_of(scratch, 0), along = sum_of(scratch, 1);
        s->alpha = curvature > 0.0f && curvature < 1e30f ? along / curvature : 0.0f;
        s->right_norm2 = sum_of(scratch, 2);
        s->goal = relative_residual * relative_residual * s->right_norm2;
        s->rho = 0.0f;
        s->beta = 0.0f;
        s->product = 0.0f;
        s->scale = 1.0f;
        s->done = 0;
        s->broken = 0;
        s->iterations = 0;
    }
}
/// x = alpha x, r = b - alpha scratch; parts: r . r, r . weight r.
KERNEL void field_start(struct GpuLevel fine, GLOBAL float* grid, GLOBAL const float* metal, GLOBAL float* x,
                        GLOBAL const struct GpuFieldScalars* s, GLOBAL float* parts) {
    SHARED float scratch[2 * MOST_VALUES * SUM_GROUP];
    const int item = GLOBAL_ID, i = fine.first + item;
    float residual = 0.0f, weighted = 0.0f;
    if (item < level_items(fine)) {
        const float r = metal[i] - s->alpha * vector_of(grid, fine, LEVEL_SCRATCH)[i];
        x[i] = s->alpha * x[i];
        vector_of(grid, fine, LEVEL_RIGHT)[i] = r;
        residual = r * r;
        weighted = r * (vector_of(grid, fine, LEVEL_WEIGHT)[i] * r);
    }
    put_sum(scratch, 0, LOCAL_ID, residual, 0.0f);
    put_sum(scratch, 1, LOCAL_ID, weighted, 0.0f);
    put_part(scratch, 2, parts);
}
/// Norms of the residual, after `steps` more iterations.
KERNEL void field_norms(GLOBAL const float* parts, int groups, int steps, GLOBAL struct GpuFieldScalars* s) {
    SHARED float scratch[2 * MOST_VALUES * SUM_GROUP];
    const int on = s->done == 0;
    add_parts(scratch, 2, parts, groups);
    if (on && LOCAL_ID == 0) {
        s->residual = sum_of(scratch, 0);
        s->weighted = sum_of(scratch, 1);
        s->iterations += steps;
        s->done = !(s->residual > s->goal);
    }
}

// --- The coarse cycle

/// Sum of 2x2x2 values to the right-hand side of the coarse level, and one sweep of Jacobi from zero.
FN void set_right(struct GpuLevel coarse, GLOBAL float* grid, int i, float sum) {
    const float weight = vector_of(grid, coarse, LEVEL_WEIGHT)[i], right = weight > 0.0f ? sum : 0.0f;
    vector_of(grid, coarse, LEVEL_RIGHT)[i] = right;
    vector_of(grid, coarse, LEVEL_SOLUTION)[i] = weight * right;
}
/// Residual of the finest level to the next.
KERNEL void field_restrict(struct GpuLevel fine, struct GpuLevel coarse, GLOBAL float* grid,
                           GLOBAL const struct GpuFieldScalars* s) {
    const int item = GLOBAL_ID, i = coarse.first + item;
    if (s->done != 0 || item >= level_items(coarse)) return;
    int a, b, c;
    level_place(coarse, item, &a, &b, &c);
    float sum = 0.0f;
    if (a < coarse.cells && b < coarse.cells && c < coarse.cells) {
        GLOBAL const float* r = vector_of(grid, fine, LEVEL_RIGHT) + level_cell(fine, 2 * a, 2 * b, 2 * c);
        const int y = fine.row, z = fine.plane;
        sum = ((r[0] + r[y]) + (r[z] + r[y + z])) + ((r[1] + r[y + 1]) + (r[z + 1] + r[y + z + 1]));
    }
    set_right(coarse, grid, i, sum);
}
/// What the sweep leaves of a level's right-hand side, to the next.
FN void descend_cell(struct GpuLevel fine, struct GpuLevel coarse, GLOBAL float* grid, int item) {
    int a, b, c;
    level_place(coarse, item, &a, &b, &c);
    float sum = 0.0f;
    if (a < coarse.cells && b < coarse.cells && c < coarse.cells) {
        GLOBAL const float* right = vector_of(grid, fine, LEVEL_RIGHT);
        GLOBAL const float* z = vector_of(grid, fine, LEVEL_SOLUTION);
        const int f = level_cell(fine, 2 * a, 2 * b, 2 * c);
        for (int k = 0; k < 8; ++k) {
            const int j = f + (k & 1) + (k >> 1 & 1) * fine.row + (k >> 2) * fine.plane;
            sum += right[j] - row_times(fine, grid, z, j);
        }
    }
    set_right(coarse, grid, coarse.first + item, sum);
}
KERNEL void field_descend(struct GpuLevel fine, struct GpuLevel coarse, GLOBAL float* grid,
                          GLOBAL const struct GpuFieldScalars* s) {
    if (s->done == 0 && GLOBAL_ID < level_items(coarse)) descend_cell(fine, coarse, grid, GLOBAL_ID);
}

/// Value of a cell with the correction of the coarser level.
FN float corrected(struct GpuLevel l, GLOBAL const float* z, struct GpuLevel coarse, GLOBAL const float* correction,
                   int a, int b, int c) {
    return z[level_cell(l, a, b, c)] + CORRECTION * correction[level_cell(coarse, a / 2, b / 2, c / 2)];
}
/// scratch = Jacobi sweep from the corrected solution; returns right . scratch of the cell.
FN float ascend_cell(struct GpuLevel l, struct GpuLevel coarse, int result, GLOBAL float* grid, int item) {
    const int i = l.first + item;
    const float weight = vector_of(grid, l, LEVEL_WEIGHT)[i];
    GLOBAL float* out = vector_of(grid, l, LEVEL_SCRATCH);
    out[i] = 0.0f;
    if (!(weight > 0.0f)) return 0.0f;
    int a, b, c;
    level_place(l, item, &a, &b, &c);
    GLOBAL const float* z = vector_of(grid, l, LEVEL_SOLUTION);
    GLOBAL const float* e = vector_of(grid, coarse, result);
    GLOBAL const float* gx = vector_of(grid, l, LEVEL_GX);
    GLOBAL const float* gy = vector_of(grid, l, LEVEL_GY);
    GLOBAL const float* gz = vector_of(grid, l, LEVEL_GZ);
    const float here = corrected(l, z, coarse, e, a, b, c);
    float flow = gx[i] * (here - corrected(l, z, coarse, e, a + 1, b, c)) +
                 gx[i - 1] * (here - corrected(l, z, coarse, e, a - 1, b, c));
    flow = flow + (gy[i] * (here - corrected(l, z, coarse, e, a, b + 1, c)) +
                   gy[i - l.row] * (here - corrected(l, z, coarse, e, a, b - 1, c)));
    flow = flow + (gz[i] * (here - corrected(l, z, coarse, e, a, b, c + 1)) +
                   gz[i - l.plane] * (here - corrected(l, z, coarse, e, a, b, c - 1)));
    flow = flow + vector_of(grid, l, LEVEL_GROUND)[i] * here;
    const float right = vector_of(grid, l, LEVEL_RIGHT)[i], value = here + weight * (right - flow);
    out[i] = value;
    return right * value;
}
/// The way back up through a large level. `result`: which vector of the coarser level has its solution.
KERNEL void field_ascend(struct GpuLevel l, struct GpuLevel coarse, int result, GLOBAL float* grid,
                         GLOBAL const struct GpuFieldScalars* s, GLOBAL float* parts) {
    SHARED float scratch[2 * MOST_VALUES * SUM_GROUP];
    float product = 0.0f;
    if (s->done == 0 && GLOBAL_ID < level_items(l)) product = ascend_cell(l, coarse, result, grid, GLOBAL_ID);
    put_sum(scratch, 0, LOCAL_ID, product, 0.0f);
    put_part(scratch, 1, parts);
}

/// By one group: the cycle over all small levels, whose right-hand side and first sweep the larger one has set. The
/// solution of the first of them is in its scratch, or in its solution if it is the coarsest.
KERNEL void field_small_cycle(struct GpuLevels levels, GLOBAL float* grid, GLOBAL struct GpuFieldScalars* s) {
    SHARED float scratch[2 * MOST_VALUES * SUM_GROUP];
    const int on = s->done == 0;
    const int coarsest = levels.count - 1;
    for (int l = levels.small; l < coarsest; ++l) {
        BARRIER;
        const int items = on ? level_items(levels.level[l + 1]) : 0;
        for (int k = LOCAL_ID; k < items; k += SUM_GROUP) descend_cell(levels.level[l], levels.level[l + 1], grid, k);
    }
    float product = 0.0f;
    for (int sweep = 0; sweep < COARSEST_SWEEPS; ++sweep) {
        BARRIER;
        const struct GpuLevel last = levels.level[coarsest];
        GLOBAL const float* from = vector_of(grid, last, sweep % 2 == 0 ? LEVEL_SOLUTION : LEVEL_SCRATCH);
        GLOBAL float* to = vector_of(grid, last, sweep % 2 == 0 ? LEVEL_SCRATCH : LEVEL_SOLUTION);
        const int items = on ? level_items(last) : 0;
        product = 0.0f;
        for (int k = LOCAL_ID; k < items; k += SUM_GROUP) {
            const int i = last.first + k;
            const float right = vector_of(grid, last, LEVEL_RIGHT)[i];
            to[i] = from[i] + vector_of(grid, last, LEVEL_WEIGHT)[i] * (right - row_times(last, grid, from, i));
            product += right * to[i];
        }
    }
    for (int l = coarsest - 1; l >= levels.small; --l) {
        BARRIER;
        product = 0.0f;
        const int result = l + 1 == coarsest ? LEVEL_SOLUTION : LEVEL_SCRATCH,
                  items = on ? level_items(levels.level[l]) : 0;
        for (int k = LOCAL_ID; k < items; k += SUM_GROUP)
            product += ascend_cell(levels.level[l], levels.level[l + 1], result, grid, k);
    }
    put_sum(scratch, 0, LOCAL_ID, product, 0.0f);
    sum_group(scratch, 1, LOCAL_ID);
    if (on && LOCAL_ID == 0) s->product = sum_of(scratch, 0);
}

/// r . z of the preconditioned residual: added Jacobi and coarse correction need no sweep of their own for it. Without
/// parts the product of the coarse level is in the scalars already.
KERNEL void field_beta(GLOBAL const float* parts, int groups, GLOBAL struct GpuFieldScalars* s) {
    SHARED float scratch[2 * MOST_VALUES * SUM_GROUP];
    const int on = s->done == 0;
    add_parts(scratch, 1, parts, groups);
    if (on && LOCAL_ID == 0) {
        const float product = groups > 0 ? sum_of(scratch, 0) : s->product;
        const float rho = ADDED * s->weighted + CORRECTION * product;
        s->beta = s->rho > 0.0f ? rho / s->rho : 0.0f;
        s->rho = rho;
    }
}
/// p = z + beta p.
KERNEL void field_direction(struct GpuLevel fine, struct GpuLevel coarse, int result, GLOBAL float* grid,
                            GLOBAL const struct GpuFieldScalars* s, GLOBAL float* p) {
    const int item = GLOBAL_ID, i = fine.first + item;
    if (s->done != 0 || item >= level_items(fine)) return;
    const float weight = vector_of(grid, fine, LEVEL_WEIGHT)[i];
    float value = 0.0f;
    if (weight > 0.0f) {
        int a, b, c;
        level_place(fine, item, &a, &b, &c);
        const float own = (ADDED * weight) * vector_of(grid, fine, LEVEL_RIGHT)[i];
        const float z = own + CORRECTION * vector_of(grid, coarse, result)[level_cell(coarse, a / 2, b / 2, c / 2)];
        value = z + s->beta * p[i];
    }
    p[i] = value;
}
/// scratch = A p; part: p . A p.
KERNEL void field_apply(struct GpuLevel fine, GLOBAL float* grid, GLOBAL const float* p,
                        GLOBAL const struct GpuFieldScalars* s, GLOBAL float* parts) {
    SHARED float scratch[2 * MOST_VALUES * SUM_GROUP];
    const int item = GLOBAL_ID, i = fine.first + item;
    float curvature = 0.0f;
    if (s->done == 0 && item < level_items(fine)) {
        const float value = row_times(fine, grid, p, i);
        vector_of(grid, fine, LEVEL_SCRATCH)[i] = value;
        curvature = p[i] * value;
    }
    put_sum(scratch, 0, LOCAL_ID, curvature, 0.0f);
    put_part(scratch, 1, parts);
}
KERNEL void field_alpha(GLOBAL const float* parts, int groups, GLOBAL struct GpuFieldScalars* s) {
    SHARED float scratch[2 * MOST_VALUES * SUM_GROUP];
    const int on = s->done == 0;
    add_parts(scratch, 1, parts, groups);
    if (on && LOCAL_ID == 0) {
        const float curvature = sum_of(scratch, 0);
        const int works = curvature > 0.0f && s->rho > 0.0f;
        s->alpha = works ? s->rho / curvature : 0.0f;
        if (!works) s->broken = s->done = 1;
    }
}
/// x += alpha p, r -= alpha scratch; parts: r . r, r . weight r.
KERNEL void field_advance(struct GpuLevel fine, GLOBAL float* grid, GLOBAL const float* p, GLOBAL float* x,
                          GLOBAL const struct GpuFieldScalars* s, GLOBAL float* parts) {
    SHARED float scratch[2 * MOST_VALUES * SUM_GROUP];
    const int item = GLOBAL_ID, i = fine.first + item;
    float residual = 0.0f, weighted = 0.0f;
    if (s->done == 0 && item < level_items(fine)) {
        const float r = vector_of(grid, fine, LEVEL_RIGHT)[i] - s->alpha * vector_of(grid, fine, LEVEL_SCRATCH)[i];
        x[i] = x[i] + s->alpha * p[i];
        vector_of(grid, fine, LEVEL_RIGHT)[i] = r;
        residual = r * r;
        weighted = r * (vector_of(grid, fine, LEVEL_WEIGHT)[i] * r);
    }
    put_sum(scratch, 0, LOCAL_ID, residual, 0.0f);
    put_sum(scratch, 1, LOCAL_ID, weighted, 0.0f);
    put_part(scratch, 2, parts);
}

// --- What comes out

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

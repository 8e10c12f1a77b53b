#include "language.h"

#include "field_parts.h"

// The coarse cycle of the preconditioner (electric/multigrid.h): damped Jacobi from zero on the way down, correction
// and damped Jacobi on the way up.

#define CORRECTION 1.6f    // electric/kernels.h: kCorrection
#define COARSEST_SWEEPS 4  // even: each pair ends where it began

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

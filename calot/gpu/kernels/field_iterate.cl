#include "language.h"

#include "field_parts.h"

// Conjugate gradients (electric/multigrid.h). When the residual is small enough, `done` is set and further iterations
// change nothing. (Their groups come to every barrier all the same: see heat.cl.)

#define CORRECTION 1.6f  // electric/kernels.h: kCorrection
#define ADDED 2.0f       // kAdded

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

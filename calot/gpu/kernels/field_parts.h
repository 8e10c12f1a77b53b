// A level's matrix, and sums over it: those of groups are parts, which one group adds up.

#ifndef CALOT_FIELD_PARTS_H
#define CALOT_FIELD_PARTS_H

#include "field_level.h"
#include "sum_group.h"

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

#endif

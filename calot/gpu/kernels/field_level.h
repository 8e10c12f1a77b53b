// Grids of the field: one work-item is one cell of a level, padding at the ends of rows included. Cells without an
// unknown have no weight.

#ifndef CALOT_FIELD_LEVEL_H
#define CALOT_FIELD_LEVEL_H

#include "field_types.h"

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

#endif

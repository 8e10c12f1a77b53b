// Structs that host and kernels share. Members are 32 bits wide each, so that they lie alike everywhere.

#ifndef CALOT_GPU_TYPES_H
#define CALOT_GPU_TYPES_H

/// base/lattice.h: a box of cells. Axis 0 = x, 1 = y, 2 = z.
struct GpuLattice {
    float origin_m[3];
    float spacing_m;
    int size[3];
    int stride[3];
    int first, last, cells;
    int fast, middle, slow;  ///< axes by stride
};

#endif

// What surface.cl and its host share.

#ifndef CALOT_GPU_SURFACE_TYPES_H
#define CALOT_GPU_SURFACE_TYPES_H

/// surface/block_grid.h: points are hexel centres with a ring of empty ones about them, in blocks of 8^3. Axis 0 is the
/// lattice's fastest, 1 and 2 the next ones in cyclic order.
struct GpuBlocks {
    int blocks[3];
    int size[3];        ///< hexels
    int stride[3];      ///< of hexels; the first is 1
    int axis[3];        ///< of the lattice
    int coordinate[3];  ///< where an axis begins in the array of points' coordinates
    int first;          ///< hexel (0, 0, 0)
    float spacing_m;
};

#endif

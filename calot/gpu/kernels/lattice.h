// Places in a lattice (base/lattice.h).

#ifndef CALOT_GPU_LATTICE_H
#define CALOT_GPU_LATTICE_H

FN int cell_index(struct GpuLattice l, int x, int y, int z) {
    return l.first + x * l.stride[0] + y * l.stride[1] + z * l.stride[2];
}
/// Coordinates of an index in [first, last).
FN void cell_coordinates(struct GpuLattice l, int index, int* c) {
    const int rest = index - l.first;
    const int plane = rest / l.stride[l.slow], in_plane = rest - plane * l.stride[l.slow];
    const int row = in_plane / l.stride[l.middle];
    c[l.slow] = plane;
    c[l.middle] = row;
    c[l.fast] = in_plane - row * l.stride[l.middle];
}

#endif

// The 27 cells about a phyxel (deformation/neighbours.h).

#ifndef CALOT_NEIGHBOURS_H
#define CALOT_NEIGHBOURS_H

#define NEIGHBOURHOOD 27
#define CENTRE 13

FN int neighbour_offset(struct GpuLattice l, int k) {
    return (k % 3 - 1) * l.stride[0] + (k / 3 % 3 - 1) * l.stride[1] + (k / 9 - 1) * l.stride[2];
}

// The nine positive directions of tissue::kLinkDirections: places in the neighbourhood. Towards the other side: 26 - k.
#define FOR_EACH_FACE(VISIT) VISIT(0, 14) VISIT(1, 16) VISIT(2, 22)
#define FOR_EACH_EDGE(VISIT) VISIT(3, 17) VISIT(4, 11) VISIT(5, 23) VISIT(6, 5) VISIT(7, 25) VISIT(8, 7)
#define FACE_LINKS 0x00415410u  // bits 4 10 12 14 16 22

#endif

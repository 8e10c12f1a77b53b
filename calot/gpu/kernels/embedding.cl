#include "language.h"
#include "types.h"
#include "lattice.h"
#include "neighbours.h"
#include "embedding.h"

// Places points in the world: gas, marks, surface vertices (deformation::embed_points). `most` items are launched,
// counts[0] of them are points, so that a count may stay on the device. Places lie as x y z, one after another; F is
// column-major, nine numbers a point, written where it is wanted.
KERNEL void embed_points(struct GpuEmbedding e, GLOBAL const float* centres, GLOBAL const uint* words,
                         GLOBAL const float* u, GLOBAL const float* gradient, GLOBAL const float* rest,
                         GLOBAL const int* owner_hexel, GLOBAL const int* counts, int most, GLOBAL float* world,
                         GLOBAL float* F_out, int wants_F) {
    const int item = GLOBAL_ID;
    if (item >= most || item >= counts[0]) return;
    float place[3], moved[3], field[FIELD], F[9];
    for (int axis = 0; axis < 3; ++axis) place[axis] = rest[3 * item + axis];
    embed_point(e, centres, words, u, gradient, owner_of(e, owner_hexel[item]), place, moved, field);
    for (int axis = 0; axis < 3; ++axis) world[3 * item + axis] = moved[axis];
    if (!wants_F) return;
    deformation_gradient(field, F);
    for (int k = 0; k < 9; ++k) F_out[9 * item + k] = F[k];
}

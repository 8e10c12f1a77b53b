#include "language.h"
#include "surface_types.h"

// The surface from presence bits: volume field, marching cubes, compaction by prefix sums. The rules and their reasons
// are those of surface/field.h, cubes.h and block_grid.h; what comes out is in the same order.
//
//   edges      cut edges and triangles of every row of points, what lies before it in its block, sums of blocks
//   (scans)    where each block's vertices and triangles begin
//   list       which edge each vertex is on
//   vertices   field at both ends of the edge, place, normal, owner
//   triangles  indices of each row of cubes
//
// Rows: 8 z + y of a block, 64 a block. Cut edges of a row: bit 8 axis + x.

#define BLOCK 8
#define ROWS 64
#define REACH 3
#define CASE_BYTES 16  // triangles, then three edges each

/// Presence of the 32 points from x on in row (y, z).
FN uint points_from(GLOBAL const uint* present, struct GpuBlocks g, int x, int y, int z) {
    const int hx = x - 1, hy = y - 1, hz = z - 1;
    if (hy < 0 || hz < 0 || hy >= g.size[1] || hz >= g.size[2] || hx >= g.size[0] || hx <= -32) return 0u;
    uint bits = bits_from(present, g.first + hx + hy * g.stride[1] + hz * g.stride[2]);
    if (hx < 0) bits = bits >> (-hx) << (-hx);
    if (g.size[0] - hx < 32) bits &= (1u << (g.size[0] - hx)) - 1u;
    return bits;
}

/// The four lines of nine corners of a row of cubes.
struct Corners {
    uint here, next, above, next_above;
};
FN struct Corners corners_of(GLOBAL const uint* present, struct GpuBlocks g, int block, int row) {
    const int x = BLOCK * (block % g.blocks[0]), y = BLOCK * (block / g.blocks[0] % g.blocks[1]) + (row & 7),
              z = BLOCK * (block / g.blocks[0] / g.blocks[1]) + (row >> 3);
    struct Corners c;
    c.here = points_from(present, g, x, y, z) & 0x1ffu;
    c.next = points_from(present, g, x, y + 1, z) & 0x1ffu;
    c.above = points_from(present, g, x, y, z + 1) & 0x1ffu;
    c.next_above = points_from(present, g, x, y + 1, z + 1) & 0x1ffu;
    return c;
}

/// Cubes of the row that the surface cuts.
FN uint cut_cubes(struct Corners c) {
    const uint any = c.here | c.next | c.above | c.next_above, all = c.here & c.next & c.above & c.next_above;
    return (any | (any >> 1)) & ~(all & (all >> 1)) & 0xffu;
}
FN int case_of(struct Corners c, int x) {
    return (int)(((c.here >> x) & 3u) | (((c.next >> x) & 3u) << 2) | (((c.above >> x) & 3u) << 4) |
                 (((c.next_above >> x) & 3u) << 6));
}
FN int lowest_bit(uint word) {
    return POPCOUNT((word & (0u - word)) - 1u);
}

/// A group a block, an item a row. before: vertices in the rows before, and triangles << 16.
KERNEL void surface_edges(GLOBAL const uint* present, struct GpuBlocks g, GLOBAL const uchar* cases, GLOBAL uint* cut,
                          GLOBAL uint* before, GLOBAL int* vertices, GLOBAL int* triangles) {
    SHARED uint sums[ROWS];
    const int row = LOCAL_ID;
    const struct Corners c = corners_of(present, g, GROUP_ID, row);
    const uint edges = ((c.here ^ (c.here >> 1)) & 0xffu) | (((c.here ^ c.next) & 0xffu) << 8) |
                       (((c.here ^ c.above) & 0xffu) << 16);
    uint count = 0u;
    for (uint rest = cut_cubes(c); rest != 0u; rest &= rest - 1u)
        count += (uint)cases[CASE_BYTES * case_of(c, lowest_bit(rest))];
    const uint own = (uint)POPCOUNT(edges) | (count << 16);
    sums[row] = own;
    BARRIER;
    for (int step = 1; step < ROWS; step *= 2) {
        const uint other = row >= step ? sums[row - step] : 0u;
        BARRIER;
        sums[row] += other;
        BARRIER;
    }
    cut[GLOBAL_ID] = edges;
    before[GLOBAL_ID] = sums[row] - own;
    if (row == ROWS - 1) {
        vertices[GROUP_ID] = (int)(sums[row] & 0xffffu);
        triangles[GROUP_ID] = (int)(sums[row] >> 16);
    }
}

/// Edge of every vertex: 32 row + bit, rows counted over all blocks.
KERNEL void surface_list(GLOBAL const uint* cut, GLOBAL const uint* before, GLOBAL const int* first_vertex, int rows,
                         GLOBAL int* edges) {
    const int row = GLOBAL_ID;
    if (row >= rows) return;
    int place = first_vertex[row / ROWS] + (int)(before[row] & 0xffffu);
    for (uint rest = cut[row]; rest != 0u; rest &= rest - 1u) edges[place++] = 32 * row + lowest_bit(rest);
}

/// The field in units of L and the slope at a point (surface/field.h). Weighted sums are exact integers; `rows` holds
/// those of a row of seven points at each squared distance, for every pattern: slope weight, field weight, and both
/// times dx.
struct FieldPoint {
    float value;
    float slope[3];
};
CONSTANT int kTableOf[11] = {0, 1, 2, -1, 3, 4, -1, -1, 5, 6, 7};
#define FULL_WEIGHT 155121

FN struct FieldPoint field_at(GLOBAL const uint* present, struct GpuBlocks g, GLOBAL const int* rows, int x, int y,
                              int z) {
    int weight = 0, mean_x = 0, mean_y = 0, mean_z = 0, slope_x = 0, slope_y = 0, slope_z = 0;
    uint here = 0u;
    for (int dz = -REACH; dz <= REACH; ++dz)
        for (int dy = -REACH; dy <= REACH; ++dy) {
            const int d2 = dy * dy + dz * dz;
            if (d2 > 10) continue;
            const uint bits = points_from(present, g, x - REACH, y + dy, z + dz) & 127u;
            if (d2 == 0) here = (bits >> REACH) & 1u;
            GLOBAL const int* sums = rows + 4 * (128 * kTableOf[d2] + (int)bits);
            slope_y += dy * sums[0];
            slope_z += dz * sums[0];
            weight += sums[1];
            mean_y += dy * sums[1];
            mean_z += dz * sums[1];
            slope_x += sums[2];
            mean_x += sums[3];
        }
    const float mx = (float)mean_x, my = (float)mean_y, mz = (float)mean_z;
    const float length = SQRT(mx * mx + my * my + mz * mz);
    const float share = 1.0f - (2.0f / 155121.0f) * (float)weight;
    struct FieldPoint p;
    if (here != 0u)
        p.value = FMIN(FMIN(share, length / (float)weight - 0.5f), -0.05f);
    else
        p.value = FMAX(FMAX(share, 0.5f - length / (float)(FULL_WEIGHT - weight)), 0.05f);
    p.slope[0] = (float)slope_x;
    p.slope[1] = (float)slope_y;
    p.slope[2] = (float)slope_z;
    return p;
}

/// An item a vertex (surface/vertex_batch.h). position_m and normal: three numbers a vertex, of the lattice's axes.
KERNEL void surface_vertices(GLOBAL const uint* present, struct GpuBlocks g, GLOBAL const int* rows,
                             GLOBAL const float* coordinate_m, GLOBAL const int* edges, int count,
                             GLOBAL float* position_m, GLOBAL float* normal, GLOBAL int* owner) {
    const int v = GLOBAL_ID;
    if (v >= count) return;
    const int row = edges[v] >> 5, axis = (edges[v] & 31) >> 3, block = row / ROWS;
    int p[3], q[3];
    p[0] = BLOCK * (block % g.blocks[0]) + (edges[v] & 7);
    p[1] = BLOCK * (block / g.blocks[0] % g.blocks[1]) + (row & 7);
    p[2] = BLOCK * (block / g.blocks[0] / g.blocks[1]) + ((row >> 3) & 7);
    for (int k = 0; k < 3; ++k) q[k] = p[k] + (k == axis ? 1 : 0);
    const struct FieldPoint lower = field_at(present, g, rows, p[0], p[1], p[2]);
    const struct FieldPoint upper = field_at(present, g, rows, q[0], q[1], q[2]);

    const float a = lower.value, b = upper.value;
    const float t = a / (a - b), rest = 1.0f - t;
    const float outward = a < 0.0f ? 1.0f : -1.0f;
    float n[3];
    for (int k = 0; k < 3; ++k) {
        const int from = (axis + k) % 3;
        n[k] = -(rest * lower.slope[from] + t * upper.slope[from]);
    }
    n[0] = outward * FMAX(outward * n[0], 0.0f);
    const float squares = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
    const float per_length = squares > 0.0f ? 1.0f / SQRT(squares) : 0.0f;
    if (squares > 0.0f)
        for (int k = 0; k < 3; ++k) n[k] = n[k] * per_length;
    else {
        n[0] = outward;
        n[1] = n[2] = 0.0f;
    }
    for (int k = 0; k < 3; ++k) {
        const float here_m = coordinate_m[g.coordinate[k] + p[k]];
        position_m[3 * v + g.axis[k]] = k == axis ? here_m + g.spacing_m * t : here_m;
        normal[3 * v + g.axis[(axis + k) % 3]] = n[k];
    }
    const int from_lower = g.first + (p[0] - 1) + (p[1] - 1) * g.stride[1] + (p[2] - 1) * g.stride[2];
    owner[v] = from_lower + (a >= 0.0f ? g.stride[axis] : 0);
}

/// An item a row of cubes.
KERNEL void surface_triangles(GLOBAL const uint* present, struct GpuBlocks g, GLOBAL const uchar* cases,
                              GLOBAL const uint* cut, GLOBAL const uint* before, GLOBAL const int* first_vertex,
                              GLOBAL const int* first_triangle, int rows, GLOBAL int* index) {
    const int row = GLOBAL_ID;
    if (row >= rows) return;
    const int block = row / ROWS;
    const struct Corners c = corners_of(present, g, block, row % ROWS);
    int triangle = first_triangle[block] + (int)(before[row] >> 16);
    for (uint rest = cut_cubes(c); rest != 0u; rest &= rest - 1u) {
        const int x = lowest_bit(rest);
        GLOBAL const uchar* cube = cases + CASE_BYTES * case_of(c, x);
        for (int k = 0; k < (int)cube[0]; ++k, ++triangle)
            for (int corner = 0; corner < 3; ++corner) {
                // Where the edge begins: it may be in any of the seven blocks above.
                const int edge = (int)cube[1 + 3 * k + corner], axis = edge >> 2;
                int q[3];
                q[0] = x;
                q[1] = row & 7;
                q[2] = (row >> 3) & 7;
                q[(axis + 1) % 3] += edge & 1;
                q[(axis + 2) % 3] += (edge >> 1) & 1;
                const int theirs = block + (q[0] >> 3) + g.blocks[0] * ((q[1] >> 3) + g.blocks[1] * (q[2] >> 3));
                const int r = ROWS * theirs + BLOCK * (q[2] & 7) + (q[1] & 7), bit = BLOCK * axis + (q[0] & 7);
                index[3 * triangle + corner] = first_vertex[theirs] + (int)(before[r] & 0xffffu) +
                                               POPCOUNT(cut[r] & ((1u << bit) - 1u));
            }
    }
}

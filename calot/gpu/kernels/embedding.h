// Displacement anywhere from phyxels (deformation/embedding.h, deformation/carriers.h).

#ifndef CALOT_EMBEDDING_H
#define CALOT_EMBEDDING_H

#define FIELD 12  // a (3), G (9, row-major) of a displacement field a + G r, r from the owner's centre

/// The shape of Shepard's weights: (1 - r^2 / R^2)^3, r in phyxel spacings.
FN float embedding_kernel(struct GpuEmbedding e, float squared) {
    const float t = 1.0f - squared * e.per_squared_radius;
    return t > 0.0f ? t * t * t : 0.0f;
}

/// Phyxel cell that owns a hexel cell.
FN int owner_of(struct GpuEmbedding e, int hexel) {
    int c[3];
    cell_coordinates(e.hexels, hexel, c);
    return cell_index(e.phyxels, c[0] / e.hexels_per_edge, c[1] / e.hexels_per_edge, c[2] / e.hexels_per_edge);
}

/// Rest position of a phyxel's centre. `centres`: coordinates along x, then y, then z, as the host rounds them.
FN void phyxel_centre(struct GpuEmbedding e, GLOBAL const float* centres, int phyxel, float* centre) {
    int c[3];
    cell_coordinates(e.phyxels, phyxel, c);
    centre[0] = centres[c[0]];
    centre[1] = centres[e.phyxels.size[0] + c[1]];
    centre[2] = centres[e.phyxels.size[0] + e.phyxels.size[1] + c[2]];
}

/// The k-th field of an owner's neighbourhood.
FN void carrier_field(struct GpuEmbedding e, GLOBAL const float* u, GLOBAL const float* gradient, int owner, int k,
                      float* field) {
    const int n = e.phyxels.cells, j = owner + neighbour_offset(e.phyxels, k);
    const float s = e.phyxels.spacing_m;
    const float x = s * (float)(k % 3 - 1), y = s * (float)(k / 3 % 3 - 1), z = s * (float)(k / 9 - 1);
    for (int r = 0; r < 3; ++r) {
        const float gx = gradient[3 * r * n + j], gy = gradient[(3 * r + 1) * n + j],
                    gz = gradient[(3 * r + 2) * n + j];
        field[r] = u[r * n + j] - (gx * x + gy * y + gz * z);
        field[3 + 3 * r] = gx;
        field[4 + 3 * r] = gy;
        field[5 + 3 * r] = gz;
    }
}

/// Adds the k-th carrier to a blend.
FN float add_carrier(struct GpuEmbedding e, GLOBAL const float* u, GLOBAL const float* gradient, int owner, int k,
                     float weight, float* sum) {
    float field[FIELD];
    if (weight == 0.0f) return 0.0f;
    carrier_field(e, u, gradient, owner, k, field);
    for (int c = 0; c < FIELD; ++c) sum[c] += weight * field[c];
    return weight;
}

FN float carrier_weight(struct GpuEmbedding e, const float* r, int k) {
    const float x = r[0] - (float)(k % 3 - 1), y = r[1] - (float)(k / 3 % 3 - 1), z = r[2] - (float)(k / 9 - 1);
    return embedding_kernel(e, x * x + y * y + z * z);
}

/// The blended field about a point of `owner`, a phyxel; `r` = the point from the owner's centre, in spacings. Returns
/// 0 where nothing carries it. Orders of sums are the host's: the owner, face and edge neighbours, corners.
FN int blend_field(struct GpuEmbedding e, GLOBAL const uint* words, GLOBAL const float* u, GLOBAL const float* gradient,
                   int owner, const float* r, float* sum) {
    const uint corners = 0x05140145u;  // cells 0 2 6 8 18 20 24 26
    const uint carriers = words[WORD_CARRIERS * e.phyxels.cells + owner];
    float total = 0.0f;
    if (carriers == 0u) return 0;
    for (int c = 0; c < FIELD; ++c) sum[c] = 0.0f;
    total += add_carrier(e, u, gradient, owner, CENTRE, carrier_weight(e, r, CENTRE), sum);
    for (int pass = 0; pass < 2; ++pass) {
        uint rest = carriers & (pass == 0 ? ~corners & ~(1u << CENTRE) : corners);
        for (; rest != 0u; rest &= rest - 1u) {
            const int k = POPCOUNT((rest & (0u - rest)) - 1u);
            total += add_carrier(e, u, gradient, owner, k, carrier_weight(e, r, k), sum);
        }
    }
    if (total <= 0.0f) {  // far outside the owner's cell: it alone carries the point
        carrier_field(e, u, gradient, owner, CENTRE, sum);
        return 1;
    }
    const float inverse = 1.0f / total;
    for (int c = 0; c < FIELD; ++c) sum[c] *= inverse;
    return 1;
}

/// Displacement a + G r, r in metres.
FN void displacement_at(const float* f, const float* r, float* displacement) {
    for (int row = 0; row < 3; ++row)
        displacement[row] = f[row] + (f[3 + 3 * row] * r[0] + f[4 + 3 * row] * r[1] + f[5 + 3 * row] * r[2]);
}

/// F = 1 + G, column-major.
FN void deformation_gradient(const float* f, float* F) {
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            F[3 * column + row] = row == column ? 1.0f + f[3 + 3 * row + column] : f[3 + 3 * row + column];
}

/// Places a material point in the world. `field` is left for deformation_gradient; zeros where nothing carries the
/// point.
FN void embed_point(struct GpuEmbedding e, GLOBAL const float* centres, GLOBAL const uint* words, GLOBAL const float* u,
                    GLOBAL const float* gradient, int owner, const float* rest, float* world, float* field) {
    float centre[3], r[3], moved[3];
    phyxel_centre(e, centres, owner, centre);
    for (int axis = 0; axis < 3; ++axis) r[axis] = (rest[axis] - centre[axis]) * e.per_spacing;
    if (!blend_field(e, words, u, gradient, owner, r, field)) {
        for (int c = 0; c < FIELD; ++c) field[c] = 0.0f;
        for (int axis = 0; axis < 3; ++axis) world[axis] = rest[axis];
        return;
    }
    for (int axis = 0; axis < 3; ++axis) r[axis] = rest[axis] - centre[axis];
    displacement_at(field, r, moved);
    for (int axis = 0; axis < 3; ++axis) world[axis] = rest[axis] + moved[axis];
}

/// A rest normal turned into the world by cof F = J F^-T, normalised; 0 where it has no length (deformation/near.cpp).
FN void turn_normal(const float* F, const float* n, float* out) {
    const float kBalanced = 1e-3f;  // rounding of sums that cancel
    float columns[9], length;
    for (int c = 0; c < 3; ++c) {
        const float* a = F + 3 * ((c + 1) % 3);
        const float* b = F + 3 * ((c + 2) % 3);
        columns[3 * c] = a[1] * b[2] - b[1] * a[2];
        columns[3 * c + 1] = a[2] * b[0] - b[2] * a[0];
        columns[3 * c + 2] = a[0] * b[1] - b[0] * a[1];
    }
    for (int r = 0; r < 3; ++r) out[r] = columns[r] * n[0] + columns[3 + r] * n[1] + columns[6 + r] * n[2];
    length = SQRT(out[0] * out[0] + out[1] * out[1] + out[2] * out[2]);
    for (int r = 0; r < 3; ++r) out[r] = length > kBalanced ? out[r] / length : 0.0f;
}

#endif

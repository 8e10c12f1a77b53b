// Where the window lies among hexels, and its outer faces.

#ifndef CALOT_FIELD_WINDOW_H
#define CALOT_FIELD_WINDOW_H

#include "field_types.h"

FN int in_window(struct GpuWindow w, int a, int b, int c) {
    return a >= w.begin[0] && b >= w.begin[1] && c >= w.begin[2] && a < w.end[0] && b < w.end[1] && c < w.end[2];
}
FN int hexel_of(struct GpuWindow w, int a, int b, int c) {
    return w.base + a + b * w.stride[0] + c * w.stride[1];
}

/// Of the conductance of half a cell and beyond, in units of sigma: share of an outer face (electric/poles.h).
FN float outer_share(struct GpuPoles poles, const float* face, int axis, float side) {
    float d1 = 0.0f, d2 = 0.0f;
    for (int k = 0; k < 3; ++k) {
        d1 += (face[k] - poles.source[k]) * (face[k] - poles.source[k]);
        d2 += (face[k] - poles.sink[k]) * (face[k] - poles.sink[k]);
    }
    const float through = FMAX(0.0f, side * (face[axis] - poles.source[axis]));
    if (!poles.placed) return through / (d1 + 0.5f * through);
    d2 = FMAX(d2, 1.0f);
    const float i1 = 1.0f / SQRT(d1), i2 = 1.0f / SQRT(d2);
    const float slope = FMAX(0.0f, through * i1 / d1 - side * (face[axis] - poles.sink[axis]) * i2 / d2);
    const float level = i1 - i2 + poles.rest;
    return level > 0.0f ? slope / (level + 0.5f * slope) : 0.0f;
}
/// The share of face n (-a, +a, -b, ...) of a cell; 0 where it is no outer face.
FN float cell_outer_share(struct GpuWindow w, struct GpuPoles poles, int a, int b, int c, int n) {
    const int place[3] = {a, b, c};
    const int axis = n / 2, up = n & 1;
    if (!in_window(w, a, b, c) || place[axis] != (up ? w.end[axis] - 1 : w.begin[axis])) return 0.0f;
    float face[3] = {(float)a, (float)b, (float)c};
    face[axis] += up ? 0.5f : -0.5f;
    return outer_share(poles, face, axis, up ? 1.0f : -1.0f);
}

#endif

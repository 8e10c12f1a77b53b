// What host and field kernels share (field.h).

#ifndef CALOT_GPU_FIELD_TYPES_H
#define CALOT_GPU_FIELD_TYPES_H

#define FIELD_MOST_LEVELS 10

/// A grid of the hierarchy (electric/level.h): cells in rows, rows in planes, as on the host.
struct GpuLevel {
    int cells, rows, row, plane, first, length;
    int at;  ///< of its vectors in the array that holds those of all levels
};
/// Vectors of a level, one after another.
enum {
    LEVEL_GX,
    LEVEL_GY,
    LEVEL_GZ,
    LEVEL_GROUND,
    LEVEL_WEIGHT,
    LEVEL_RIGHT,
    LEVEL_SOLUTION,
    LEVEL_SCRATCH,
    LEVEL_VECTORS
};
struct GpuLevels {
    int count;
    int small;  ///< from here on one group does all levels by itself
    struct GpuLevel level[FIELD_MOST_LEVELS];
};

/// The window (electric/window.h), and how its cells lie among hexels: base + a + b stride[0] + c stride[1].
struct GpuWindow {
    int cells;
    int begin[3], end[3];  ///< the part on the lattice
    int base, stride[2];
};

/// Of a material (electric/kernels.h, Conductivity).
struct GpuConductor {
    float slope_per_K, dry_S_per_m, dry_capacity_J_per_m3K, water_capacity_J_per_kgK, alive_water_kg_per_m3,
        per_water_m3_per_kg;
};

/// A hexel that current may enter.
struct GpuEntry {
    int cell;  ///< of the finest level
    float gap_m;
    float outward[3];  ///< along the window's axes
};
/// What lies between metal and hexels (electric/contact.h). Resistances are times the spacing: m/S.
struct GpuMetal {
    float film, arc, arc_per_m;  ///< of char on one face; of an arc, and more per metre of gap
    float contact_gap_m, wire_share, edge;
};

/// Where current comes from and goes to (electric/poles.h).
struct GpuPoles {
    float source[3], sink[3];
    float rest;
    int placed;
};

/// Scalars of the iteration.
struct GpuFieldScalars {
    float alpha, beta, rho, product;
    float residual, weighted, right_norm2, goal;  ///< goal: of `residual`
    float scale;                                  ///< best multiple of the potential
    int done, broken, iterations;
    int contacts, arcs;
};

/// Sums over the heat, after those by material: in the wire, beyond the window, current out of the metal.
enum { FIELD_WIRE, FIELD_BEYOND, FIELD_CURRENT, FIELD_OTHERS };
struct GpuFieldSum {
    float high, low;
    float greatest;  ///< of heat times conductivity
};

#endif

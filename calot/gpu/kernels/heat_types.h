// What host and heat kernels share (heat.h).

#ifndef CALOT_GPU_HEAT_TYPES_H
#define CALOT_GPU_HEAT_TYPES_H

/// Cells of a block, the unit of work and of rest: a work-group.
#define HEAT_BLOCK 256

/// Of each material, as thermal/properties.h has them.
struct GpuHeatMaterial {
    float conducted_J_per_m3K, to_gas_J_per_m3K, to_held_J_per_m3K, to_blood_J_per_m3K;
    float dry_capacity_J_per_m3K, water_capacity_J_per_kgK, dry_limit_K, boil_off_J_per_kg;
    float plateau_J_per_m3, spent_J_per_m3, water_kg_per_m3;
    float damage_log_rate, damage_slope;
};

/// One heat step. Axes are fastest, middle, slowest.
struct GpuHeatStep {
    int first, last, blocks;  ///< of the lattice; block 0 begins at its first cell
    int stride[3];            ///< along x, y, z
    int row, plane;           ///< stride along the middle and slowest axis
    int axes[3];              ///< which of x, y, z is the fastest, middle, slowest
    int threshold;            ///< PhaseModel::threshold
    float body_K, gas_K, wet_limit_K, dt_s;
    int joule_low[3], joule_size[3];  ///< box of Joule heat; no size: none
    float joule_V2_s;                 ///< from the heat of one volt to what the step brings: V^2 s
};

/// A hexel that the wire touches.
struct GpuTouch {
    int hexel;
    float passed_J_per_m3K;  ///< a step, per kelvin between them
};

/// An entry of the lists that come back.
struct GpuHexelValue {
    int hexel;
    float value;
};

/// What a block did in a step: sums per cubic metre of hexel, as high and low part.
enum { HEAT_DELIVERED, HEAT_PERFUSION, HEAT_SURFACE, HEAT_GAS, HEAT_LATENT, HEAT_SUMS };

/// What comes back from every step.
struct GpuHeatTotals {
    int spent, boiled;  ///< lengths of the lists
    int bad_hexel;      ///< the first whose enthalpy is no longer a number; HEAT_NONE
    float high[HEAT_SUMS], low[HEAT_SUMS];
    float tip_high, tip_low;  ///< from tissue into the wire
};
#define HEAT_NONE 0x7fffffff

#endif

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

// Planes over the phyxel lattice (deformation/work.h), each of GpuLattice::cells floats.
#define REST_MOMENT_INVERSE 0  // A^-1, xx xy xz yy yz zz
#define REST_STEP_SUM 6        // sum of w X / s over live links
#define REST_VOLUME 9
#define REST_HOURGLASS 10
#define REST_MU 11
#define REST_LAMBDA 12
#define REST_PULL 13           // of own stress at neighbours
#define REST_SHARE 14          // constant: volume that a phyxel stands for over that of its hexels, as sampled
#define REST_TRACE 15          // constant: of the moment matrix as sampled, in spacings^2
#define REST_STIFFNESS 16      // constant: v (lambda + 2 mu) of the whole phyxel
#define REST_PLANES 17
#define MASS_WEIGHING 0
#define MASS_MOVING 1
#define MASS_STABLE 2
#define MASS_INVERSE 3
#define MASS_GRAVITY_SHARE 4
#define MASS_PLANES 5

// Words over the phyxel lattice. Bits of a neighbourhood: cell k is (k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1) away.
#define WORD_LINKS 0    // live links
#define WORD_MIRROR 1   // of a ghost: phyxels that it mirrors
#define WORD_CARRIERS 2 // what carries the points of a phyxel's cell; 0 = the phyxel is gone
#define WORD_OCCUPANCY 3  // hexels of the main component, low and high half
#define WORD_HELD 5       // held cells of the cell
#define WORD_PLANES 7

// Numbers of the rest properties' kernels (rest.cl): real each.
#define NUMBER_SPACING 0
#define NUMBER_HEXEL_VOLUME 1
#define NUMBER_MASS_FLOOR 2
#define NUMBER_SINGULAR 3
#define NUMBER_ALPHA 4
#define NUMBER_SUBSTEP 5
#define NUMBER_ROW_SUM 6
#define NUMBER_SUPPORT 7
#define NUMBER_MATERIALS 8  // from here on density, mu, lambda of each

/// What the sweeps of a substep have in common (deformation/kernel.h).
struct GpuSweep {
    struct GpuLattice phyxels;
    int law;  ///< 0 stable neo-Hookean, 1 Saint Venant-Kirchhoff
    float volume_stiffness_Pa;
    float most_squared_stretch;
    float substep_s;
    float decay;
    float gravity_step_m_per_s[3];
    int ascending[27];  ///< cells of the neighbourhood in the order of their places in arrays
};

/// What topology needs to know (deformation/occupancy.h): words are a low and a high half.
struct GpuTopology {
    struct GpuLattice hexels, phyxels;
    int hexels_per_edge;
    int bit_words;  ///< of a bit array over phyxels
    int shift[3];   ///< bits between neighbours
    unsigned int low[3][2], high[3][2];  ///< layers with coordinate 0 and m - 1
    unsigned int all[2];
};

/// What embedding needs to know (deformation/embedding.h).
struct GpuEmbedding {
    struct GpuLattice hexels, phyxels;
    int hexels_per_edge;
    float per_spacing;         ///< 1 / phyxel spacing
    float per_squared_radius;  ///< 1 / R^2, in phyxel spacings
};

/// A contact point (deformation/contact.h).
struct GpuContactPoint {
    float normal[3];  ///< 0 = held
    float tool_velocity[3];
    float stiffness, gap, most_force;
    float away[3], away_rest[3];  ///< the second: of a held point at rest, what rounding left over
    float impulse[3];
    float sum[3], sum_rest[3];  ///< of impulses since the tick began, and what rounding left over
    int first, end;             ///< rows
};

/// All contact points together.
struct GpuContact {
    int points, rows, stride;
    int cells;  ///< of the phyxel lattice
    float friction, substep_s;
};

/// A capsule of an instrument (deformation/near_kernel.h).
struct GpuCapsule {
    float a[3], ab[3];
    float per_length2, radius;
    float reach;  ///< hexels within this of its surface are near
    int bare;
};
#define MOST_CAPSULES 16
struct GpuCapsules {
    int count;
    struct GpuCapsule item[MOST_CAPSULES];
};

/// The search for near hexels.
struct GpuNear {
    struct GpuEmbedding embedding;
    float low[3], high[3];  ///< about all capsules, for centres of phyxels
    float phyxel_margin;    ///< how much further phyxels are looked for
    float half_hexel;
    int row_offset[9];  ///< rows of three hexels about one
    int active;         ///< phyxels and ghosts
    int most_phyxels, most_hexels;
};
struct GpuNearHexel {
    int hexel;
    float world[3];
    float bare_gap, distance;
    float outward[3];
};

#endif

#include "language.h"
#include "types.h"

// Contacts of instruments and what a grasper holds, inside a substep (deformation/contact.h has the law; sums run in
// the order of deformation/contact_reference.cpp). The host says which points there are and which phyxels carry them:
// rows of `psi`, a line for each point. One group of 256 items solves all of them.

#define MOST_POINTS 48  // deformation::kMaxPoints
#define LANES 16        // deformation::kContactLanes
#define CONTACT_GROUP 256

/// Sum of LANES partial sums, as a tree; lane 0 of each has it then.
FN void add_lanes(LOCAL float* partial, int item) {
    for (int width = LANES / 2; width > 0; width /= 2) {
        BARRIER;
        if (item % LANES < width) partial[item] = partial[item] + partial[item + width];
    }
    BARRIER;
}

/// W_cd = sum psi_c psi_d / m. LANES items for each pair of points, c * MOST_POINTS + d.
KERNEL void couple_points(struct GpuContact k, GLOBAL const struct GpuContactPoint* points, GLOBAL const int* phyxel,
                          GLOBAL const float* psi, GLOBAL const float* mass, GLOBAL float* coupling) {
    SHARED float partial[CONTACT_GROUP];
    const int pair = GLOBAL_ID / LANES, lane = GLOBAL_ID % LANES, c = pair / MOST_POINTS, d = pair % MOST_POINTS;
    const int wanted = c < k.points && d <= c;
    float sum = 0.0f;
    if (wanted) {
        const int first = IMAX(points[c].first, points[d].first), end = IMIN(points[c].end, points[d].end);
        for (int row = first + lane; row < end && row < k.rows; row += LANES)
            sum = sum + psi[c * k.stride + row] * mass[MASS_INVERSE * k.cells + phyxel[row]] * psi[d * k.stride + row];
    }
    partial[LOCAL_ID] = sum;
    add_lanes(partial, LOCAL_ID);
    if (wanted && lane == 0) coupling[c * MOST_POINTS + d] = coupling[d * MOST_POINTS + c] = partial[LOCAL_ID];
}

/// Where held points are: adds their displacement to `away`. An item is a point.
KERNEL void place_held(struct GpuContact k, GLOBAL struct GpuContactPoint* points, GLOBAL const int* phyxel,
                       GLOBAL const float* psi, GLOBAL const float* u) {
    const int c = GLOBAL_ID;
    if (c >= k.points) return;
    if (points[c].normal[0] != 0.0f || points[c].normal[1] != 0.0f || points[c].normal[2] != 0.0f) return;
    float moved[3] = {0.0f, 0.0f, 0.0f};
    for (int row = points[c].first; row < points[c].end && row < k.rows; ++row) {
        const float share = psi[c * k.stride + row];
        for (int r = 0; r < 3; ++r)
            if (share != 0.0f) moved[r] += share * u[r * k.cells + phyxel[row]];
    }
    for (int r = 0; r < 3; ++r)
        points[c].away[r] = (float)((real)points[c].away[r] + (real)points[c].away_rest[r] + (real)moved[r]);
}

FN float dot3(const float* a, const float* b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

// What a point's law asks for, close at hand.
#define LAW_WORDS 12
struct Law {
    float normal[3], tool_velocity[3], stiffness, gap, most_force, away[3];
};

/// One point's law, with all other points as they are (deformation/contact_law.h).
FN void impulse_of(const LOCAL float* law, const float* velocity, const float* before, float coupling, float friction,
                   float dt, float* impulse) {
    struct Law p;
    float relative[3], wanted[3];
    for (int r = 0; r < 3; ++r) {
        p.normal[r] = law[r];
        p.tool_velocity[r] = law[3 + r];
        p.away[r] = law[9 + r];
    }
    p.stiffness = law[6];
    p.gap = law[7];
    p.most_force = law[8];
    for (int r = 0; r < 3; ++r) relative[r] = velocity[r] - p.tool_velocity[r];
    if (p.normal[0] == 0.0f && p.normal[1] == 0.0f && p.normal[2] == 0.0f) {  // held
        const float factor = -p.stiffness * dt / (1.0f + p.stiffness * dt * dt * coupling);
        for (int r = 0; r < 3; ++r) wanted[r] = (p.away[r] + dt * (relative[r] - coupling * before[r])) * factor;
        const float most = p.most_force * dt, length2 = dot3(wanted, wanted);
        const float share = length2 > most * most ? most / SQRT(length2) : 1.0f;
        for (int r = 0; r < 3; ++r) impulse[r] = wanted[r] * share;
        return;
    }
    const float closing = dot3(relative, p.normal), normal_before = dot3(before, p.normal);
    const float without = closing - coupling * normal_before;
    const float push = -p.stiffness * dt * (p.gap + dt * without) / (1.0f + p.stiffness * dt * dt * coupling);
    if (!(push > 0.0f)) {
        for (int r = 0; r < 3; ++r) impulse[r] = 0.0f;
        return;
    }
    const float per_coupling = 1.0f / coupling;
    for (int r = 0; r < 3; ++r)
        wanted[r] = (before[r] - normal_before * p.normal[r]) - (relative[r] - closing * p.normal[r]) * per_coupling;
    const float most = friction * push, length2 = dot3(wanted, wanted);
    if (length2 > most * most) {
        const float share = most / SQRT(length2);
        for (int r = 0; r < 3; ++r) wanted[r] *= share;
    }
    for (int r = 0; r < 3; ++r) impulse[r] = push * p.normal[r] + wanted[r];
}

/// Adds to a sum and keeps what rounding loses (Kahan).
FN void add_exactly(GLOBAL float* sum, GLOBAL float* rest, float value) {
    const float more = value - *rest, total = *sum + more;
    *rest = (total - *sum) - more;
    *sum = total;
}

/// Makes velocities obey the contacts, `sweeps` times over all points in their order, and displacements with them.
KERNEL void solve_contacts(struct GpuContact k, int sweeps, GLOBAL struct GpuContactPoint* points,
                           GLOBAL const int* phyxel, GLOBAL const float* psi, GLOBAL const float* mass,
                           GLOBAL const float* coupling, GLOBAL float* v, GLOBAL float* u) {
    SHARED float partial[CONTACT_GROUP];
    SHARED float velocity[3 * MOST_POINTS];
    SHARED float impulse[3 * MOST_POINTS];
    SHARED float law[LAW_WORDS * MOST_POINTS];
    SHARED float own_coupling[MOST_POINTS];
    SHARED float more[3];
    const int item = LOCAL_ID, lane = item % LANES;

    // Velocities of the points from those of the rows, LANES items for each sum.
    for (int first = 0; first < 3 * k.points; first += CONTACT_GROUP / LANES) {
        const int which = first + item / LANES, c = which / 3, r = which % 3;
        float sum = 0.0f;
        if (which < 3 * k.points) {
            for (int row = points[c].first + lane; row < points[c].end && row < k.rows; row += LANES)
                sum = sum + psi[c * k.stride + row] * v[r * k.cells + phyxel[row]];
        }
        partial[item] = sum;
        add_lanes(partial, item);
        if (which < 3 * k.points && lane == 0) velocity[r * MOST_POINTS + c] = partial[item];
        BARRIER;
    }
    if (item < k.points) {
        for (int r = 0; r < 3; ++r) {
            impulse[r * MOST_POINTS + item] = points[item].impulse[r];
            law[LAW_WORDS * item + r] = points[item].normal[r];
            law[LAW_WORDS * item + 3 + r] = points[item].tool_velocity[r];
            law[LAW_WORDS * item + 9 + r] = points[item].away[r];
        }
        law[LAW_WORDS * item + 6] = points[item].stiffness;
        law[LAW_WORDS * item + 7] = points[item].gap;
        law[LAW_WORDS * item + 8] = points[item].most_force;
        own_coupling[item] = coupling[item * MOST_POINTS + item];
    }
    BARRIER;

    // What the impulses of the substep before do. An item is a point.
    if (item < k.points) {
        for (int c = 0; c < k.points; ++c)
            for (int r = 0; r < 3; ++r)
                velocity[r * MOST_POINTS + item] += coupling[c * MOST_POINTS + item] * impulse[r * MOST_POINTS + c];
    }
    BARRIER;

    for (int turn = 0; turn < sweeps * k.points; ++turn) {
        const int c = turn % k.points;
        if (item == 0) {
            const float own = own_coupling[c];
            float at[3], before[3], after[3];
            for (int r = 0; r < 3; ++r) {
                at[r] = velocity[r * MOST_POINTS + c];
                before[r] = after[r] = impulse[r * MOST_POINTS + c];
            }
            if (own > 0.0f)  // else nothing that moves carries it
                impulse_of(law + LAW_WORDS * c, at, before, own, k.friction, k.substep_s, after);
            for (int r = 0; r < 3; ++r) {
                more[r] = after[r] - before[r];
                impulse[r * MOST_POINTS + c] = after[r];
            }
        }
        BARRIER;
        if (item < k.points) {
            for (int r = 0; r < 3; ++r)
                velocity[r * MOST_POINTS + item] += coupling[c * MOST_POINTS + item] * more[r];
        }
        BARRIER;
    }

    // Impulses on the rows: sum psi_c p_c.
    for (int row = item; row < k.rows; row += CONTACT_GROUP) {
        float sum[3] = {0.0f, 0.0f, 0.0f};
        for (int c = 0; c < k.points; ++c) {
            if (row < points[c].first || row >= points[c].end) continue;
            for (int r = 0; r < 3; ++r) sum[r] += psi[c * k.stride + row] * impulse[r * MOST_POINTS + c];
        }
        const float inverse_mass = mass[MASS_INVERSE * k.cells + phyxel[row]];
        for (int r = 0; r < 3; ++r) {
            const float gain = inverse_mass * sum[r];
            v[r * k.cells + phyxel[row]] += gain;
            u[r * k.cells + phyxel[row]] += k.substep_s * gain;
        }
    }

    if (item < k.points) {
        float moved[3], normal[3];
        for (int r = 0; r < 3; ++r) {
            moved[r] = k.substep_s * (velocity[r * MOST_POINTS + item] - points[item].tool_velocity[r]);
            normal[r] = points[item].normal[r];
        }
        points[item].gap += dot3(moved, normal);
        for (int r = 0; r < 3; ++r) {
            points[item].away[r] += moved[r];
            points[item].impulse[r] = impulse[r * MOST_POINTS + item];
            add_exactly(&points[item].sum[r], &points[item].sum_rest[r], impulse[r * MOST_POINTS + item]);
        }
    }
}

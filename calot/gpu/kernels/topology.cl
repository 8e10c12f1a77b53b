#include "language.h"
#include "types.h"
#include "lattice.h"
#include "neighbours.h"

// Burning changes topology (deformation/topology.h has the rules, holding.h and occupancy.h how they are told on
// words).
// An item is a phyxel that lost hexels, or one of its links. Links are bits at both ends: WORD_LINKS. Faces come first,
// in a kernel of their own, since edges hold where faces do. Searching what hangs on nothing any more follows chains of
// cells: the host does it, on its own bits, and names the phyxels that fall.

FN u64 join(uint low, uint high) { return (u64)low | ((u64)high << 32); }
FN u64 layer(const uint* halves) { return join(halves[0], halves[1]); }
FN u64 word_of(GLOBAL const uint* words, int plane, int n, int i) {
    return join(words[plane * n + i], words[(plane + 1) * n + i]);
}

FN u64 moved_up(struct GpuTopology t, u64 w, int axis) { return (w & ~layer(t.high[axis])) << t.shift[axis]; }
FN u64 moved_down(struct GpuTopology t, u64 w, int axis) { return (w & ~layer(t.low[axis])) >> t.shift[axis]; }

/// Everything in `inside` that faces join to `seed`.
FN u64 flood(struct GpuTopology t, u64 seed, u64 inside) {
    u64 filled = seed & inside, before = 0;
    while (before != filled) {
        before = filled;
        for (int axis = 0; axis < 3; ++axis)
            filled |= (moved_up(t, filled, axis) | moved_down(t, filled, axis)) & inside;
    }
    return filled;
}

/// The component with most hexels; of equals, the one with the lowest bit.
FN u64 largest_component(struct GpuTopology t, u64 word) {
    u64 best = 0, rest = word;
    while (rest != 0) {
        const u64 component = flood(t, rest & (~rest + 1), rest);
        if (POPCOUNT64(component) > POPCOUNT64(best)) best = component;
        rest &= ~component;
    }
    return best;
}

/// Takes hexels that are gone out of the words and keeps the largest components. A phyxel without any is gone.
KERNEL void keep_main(struct GpuTopology t, GLOBAL const int* touched, int count, GLOBAL const uint* hexel_present,
                      GLOBAL uint* words, GLOBAL uint* present, GLOBAL float* u, GLOBAL float* v) {
    const int item = GLOBAL_ID;
    if (item >= count) return;
    const int i = touched[item], n = t.phyxels.cells, m = t.hexels_per_edge;
    int c[3];
    cell_coordinates(t.phyxels, i, c);
    u64 word = word_of(words, WORD_OCCUPANCY, n, i);
    for (int bit = 0; bit < m * m * m; ++bit) {
        const int hexel = cell_index(t.hexels, c[0] * m + bit % m, c[1] * m + bit / m % m, c[2] * m + bit / (m * m));
        if (!test_bit(hexel_present, hexel)) word &= ~((u64)1 << bit);
    }
    const u64 kept = largest_component(t, word);
    words[WORD_OCCUPANCY * n + i] = (uint)kept;
    words[(WORD_OCCUPANCY + 1) * n + i] = (uint)(kept >> 32);
    if (kept != 0) return;
    ATOMIC_AND(present + (i >> 5), ~(1u << (i & 31)));
    for (int r = 0; r < 3; ++r) u[r * n + i] = v[r * n + i] = 0.0f;
}

/// Whether a face link may live: the components of the two cells touch.
FN int face_holds(struct GpuTopology t, GLOBAL const uint* ghost, GLOBAL const uint* words, int below, int axis) {
    const int n = t.phyxels.cells, above = below + t.phyxels.stride[axis];
    const int ghost_below = test_bit(ghost, below), ghost_above = test_bit(ghost, above);
    u64 a = word_of(words, WORD_OCCUPANCY, n, below), b = word_of(words, WORD_OCCUPANCY, n, above);
    const u64 held_a = word_of(words, WORD_HELD, n, below), held_b = word_of(words, WORD_HELD, n, above);
    // Towards a ghost, a phyxel also counts with the held cells of its own cell that it touches. A ghost without held
    // cells fills its cell.
    const u64 a_with_held = flood(t, a, a | held_a), b_with_held = flood(t, b, b | held_b);
    if (ghost_below) a = held_a != 0 ? held_a : layer(t.all);
    else if (ghost_above) a = a_with_held;
    if (ghost_above) b = held_b != 0 ? held_b : layer(t.all);
    else if (ghost_below) b = b_with_held;
    return (((a & layer(t.high[axis])) >> (t.shift[axis] * (t.hexels_per_edge - 1))) & b) != 0;
}

/// Links of a cell while others cut some of them.
FN uint links_now(GLOBAL uint* words, int n, int i) { return ATOMIC_OR(words + WORD_LINKS * n + i, 0u); }

/// Cuts the link towards cell k of the neighbourhood, at both ends.
FN void cut(struct GpuLattice l, GLOBAL uint* words, int i, int k) {
    ATOMIC_AND(words + WORD_LINKS * l.cells + i, ~(1u << k));
    ATOMIC_AND(words + WORD_LINKS * l.cells + i + neighbour_offset(l, k), ~(1u << (26 - k)));
}

/// Six items for each phyxel.
KERNEL void sever_faces(struct GpuTopology t, GLOBAL const int* touched, int count, GLOBAL const uint* ghost,
                        GLOBAL uint* words) {
    const int item = GLOBAL_ID;
    if (item >= 6 * count) return;
    const int axis = item % 6 / 2, k = axis == 0 ? 14 : axis == 1 ? 16 : 22;  // towards the positive side
    const int below = touched[item / 6] - (item % 2 == 0 ? 0 : t.phyxels.stride[axis]);
    if (((links_now(words, t.phyxels.cells, below) >> k) & 1u) == 0u) return;
    if (!face_holds(t, ghost, words, below, axis)) cut(t.phyxels, words, below, k);
}

/// Whether two cells are linked or are both parts of what holds.
FN int are_connected(struct GpuLattice l, GLOBAL const uint* ghost, GLOBAL uint* words, int i, int k) {
    return (int)((links_now(words, l.cells, i) >> k) & 1u) ||
           (test_bit(ghost, i) && test_bit(ghost, i + neighbour_offset(l, k)));
}

/// Whether an edge link may live: one of its two paths over faces does.
FN int edge_holds(struct GpuLattice l, GLOBAL const uint* ghost, GLOBAL uint* words, int i, int k) {
    const int power[3] = {1, 3, 9};
    const int step[3] = {k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1};
    for (int axis = 0; axis < 3; ++axis) {
        if (step[axis] == 0) continue;
        const int first = CENTRE + step[axis] * power[axis], second = CENTRE + k - first;
        if (are_connected(l, ghost, words, i, first) &&
            are_connected(l, ghost, words, i + neighbour_offset(l, first), second))
            return 1;
    }
    return 0;
}

/// 24 items for each phyxel: its edge links, and those between its face neighbours, over it.
KERNEL void sever_edges(struct GpuTopology t, GLOBAL const int* touched, int count, GLOBAL const uint* ghost,
                        GLOBAL uint* words) {
    const int item = GLOBAL_ID;
    if (item >= 24 * count) return;
    const int edges[12] = {1, 3, 5, 7, 9, 11, 15, 17, 19, 21, 23, 25};
    const int k = edges[item % 24 / 2], step_x = k % 3 - 1, step_y = k / 3 % 3 - 1;
    int i = touched[item / 24];
    if (item % 2 == 1) i -= step_x != 0 ? step_x * t.phyxels.stride[0] : step_y * t.phyxels.stride[1];
    if (((links_now(words, t.phyxels.cells, i) >> k) & 1u) == 0u) return;
    if (!edge_holds(t.phyxels, ghost, words, i, k)) cut(t.phyxels, words, i, k);
}

/// Phyxels that hang on nothing: they and all their links go.
KERNEL void drop_phyxels(struct GpuTopology t, GLOBAL const int* fallen, int count, GLOBAL uint* words,
                         GLOBAL uint* present, GLOBAL float* u, GLOBAL float* v) {
    const int item = GLOBAL_ID;
    if (item >= count) return;
    const int i = fallen[item], n = t.phyxels.cells;
    const uint links = links_now(words, n, i);
    for (int k = 0; k < NEIGHBOURHOOD; ++k)
        if ((links >> k) & 1u) cut(t.phyxels, words, i, k);
    words[WORD_OCCUPANCY * n + i] = words[(WORD_OCCUPANCY + 1) * n + i] = 0u;
    ATOMIC_AND(present + (i >> 5), ~(1u << (i & 31)));
    for (int r = 0; r < 3; ++r) u[r * n + i] = v[r * n + i] = 0.0f;
}

/// Hexels that fell leave; from `first` on, `values` gets what they hold.
KERNEL void drop_hexels(GLOBAL const int* hexels, int count, int first, GLOBAL uint* present, GLOBAL float* enthalpy,
                        GLOBAL float* values) {
    const int item = GLOBAL_ID;
    if (item >= count) return;
    const int i = hexels[item];
    ATOMIC_AND(present + (i >> 5), ~(1u << (i & 31)));
    values[first + item] = enthalpy[i];
    enthalpy[i] = 0.0f;
}

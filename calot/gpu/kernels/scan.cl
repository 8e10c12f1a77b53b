#include "language.h"
#include "scan_group.h"

// Prefix sums (scan.h). Three steps: sums of groups; one group adds those up, a block at a time; each group adds what
// lies before it. Integers, so that the order does not matter.

KERNEL void popcounts(GLOBAL const uint* words, int count, GLOBAL int* counts) {
    const int i = GLOBAL_ID;
    if (i < count) counts[i] = POPCOUNT(words[i]);
}

/// Sum of every group of SCAN_GROUP numbers.
KERNEL void group_sums(GLOBAL const int* numbers, int count, GLOBAL int* sums) {
    SHARED int scratch[SCAN_GROUP];
    const int i = GLOBAL_ID;
    scan_group(scratch, LOCAL_ID, i < count ? numbers[i] : 0);
    if (LOCAL_ID == SCAN_GROUP - 1) sums[GROUP_ID] = scratch[SCAN_GROUP - 1];
}

/// By one group alone: turns sums into what lies before each, and writes the total.
KERNEL void scan_sums(GLOBAL int* sums, int groups, GLOBAL int* total) {
    SHARED int scratch[SCAN_GROUP];
    int before = 0;
    for (int first = 0; first < groups; first += SCAN_GROUP) {
        const int i = first + LOCAL_ID;
        const int own = i < groups ? sums[i] : 0;
        scan_group(scratch, LOCAL_ID, own);
        if (i < groups) sums[i] = before + scratch[LOCAL_ID] - own;
        before += scratch[SCAN_GROUP - 1];
        BARRIER;
    }
    if (LOCAL_ID == 0) total[0] = before;
}

/// Turns numbers into the sums of all before each.
KERNEL void scan_numbers(GLOBAL int* numbers, int count, GLOBAL const int* sums) {
    SHARED int scratch[SCAN_GROUP];
    const int i = GLOBAL_ID;
    const int own = i < count ? numbers[i] : 0;
    scan_group(scratch, LOCAL_ID, own);
    if (i < count) numbers[i] = sums[GROUP_ID] + scratch[LOCAL_ID] - own;
}

/// Lists the places of set bits, ascending, up to `room` of them; `before` is the scan of popcounts.
KERNEL void list_bits(GLOBAL const uint* words, int count, GLOBAL const int* before, GLOBAL int* list, int room) {
    const int i = GLOBAL_ID;
    if (i >= count) return;
    int place = before[i];
    for (uint rest = words[i]; rest != 0u && place < room; rest &= rest - 1u)
        list[place++] = 32 * i + POPCOUNT((rest & (0u - rest)) - 1u);
}

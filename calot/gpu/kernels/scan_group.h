// Sums within a group of SCAN_GROUP items.

#ifndef CALOT_SCAN_GROUP_H
#define CALOT_SCAN_GROUP_H

#define SCAN_GROUP 256

/// scratch[k] = sum of the values of items 0 .. k of the group.
FN void scan_group(LOCAL int* scratch, int item, int value) {
    scratch[item] = value;
    BARRIER;
    for (int step = 1; step < SCAN_GROUP; step *= 2) {
        const int other = item >= step ? scratch[item - step] : 0;
        BARRIER;
        scratch[item] += other;
        BARRIER;
    }
}

#endif

// Sums over a group of SUM_GROUP items, in a fixed order and without loss: each is a pair of floats, what the first
// cannot hold is in the second.

#ifndef CALOT_SUM_GROUP_H
#define CALOT_SUM_GROUP_H

#define SUM_GROUP 256

/// (high, low) += (more, rest)
FN void add_pair(float* high, float* low, float more, float rest) {
    const float sum = *high + more, part = sum - *high;
    *low += ((*high - (sum - part)) + (more - part)) + rest;
    *high = sum;
}

/// scratch holds `values` arrays of highs and lows of every item, [values][2][SUM_GROUP]; afterwards those of item 0
/// are the sums.
FN void sum_group(LOCAL float* scratch, int values, int item) {
    for (int step = SUM_GROUP / 2; step > 0; step /= 2) {
        BARRIER;
        if (item < step)
            for (int v = 0; v < values; ++v) {
                LOCAL float* highs = scratch + 2 * v * SUM_GROUP;
                LOCAL float* lows = highs + SUM_GROUP;
                float high = highs[item], low = lows[item];
                add_pair(&high, &low, highs[item + step], lows[item + step]);
                highs[item] = high;
                lows[item] = low;
            }
    }
    BARRIER;
}

/// Sets item's value v.
FN void put_sum(LOCAL float* scratch, int v, int item, float high, float low) {
    scratch[2 * v * SUM_GROUP + item] = high;
    scratch[(2 * v + 1) * SUM_GROUP + item] = low;
}

#endif

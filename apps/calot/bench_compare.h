#pragma once
// What moved against an earlier run.

#include <string>
#include <vector>

#include "bench_json.h"
#include "bench_statistics.h"

namespace calot::app {

struct Comparison {
    std::string name;
    double earlier_us = 0.0, later_us = 0.0;  ///< medians
    Change change;
    /// "faster", "slower", "the same" (within 3 %, for sure), "unclear"
    std::string verdict() const;
};

/// Of everything that both have. Repetition k of one is paired with repetition k of the other: kernels after division
/// by the yardstick of the same moment, so that a slower machine does not look like slower code; ticks block by block,
/// as both runs simulate the same.
std::vector<Comparison> compare(const SampleSet& earlier, const SampleSet& later);

std::string comparison_text(const std::vector<Comparison>& comparisons);

}  // namespace calot::app

#pragma once
// Results as JSON, and what a comparison needs of an earlier file.

#include <map>
#include <string>
#include <vector>

#include "bench_results.h"

namespace calot::app {

/// machine, ceilings, kernels, tick, paper, scale; and "samples", one entry a repetition, for comparisons.
std::string bench_json(const BenchResults& results);

/// Times that two runs have in common are compared pair by pair.
struct Samples {
    std::vector<double> us;
    std::vector<double> yardstick_us;  ///< empty for ticks
};
using SampleSet = std::map<std::string, Samples>;

SampleSet samples_of(const BenchResults& results);
/// Throws InputError when the file cannot be read or holds no results of a benchmark.
SampleSet read_samples(const std::string& path);

}  // namespace calot::app

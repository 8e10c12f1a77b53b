#pragma once
// The loops that bench_ceilings.cpp times: as wide as the machine can.

#include <cstdint>

namespace calot::app {

/// Sum of an array, so that it must be read. `floats` is a multiple of 128.
float read_all(const float* from, std::int64_t floats);
void copy_all(const float* from, float* to, std::int64_t floats);

/// Independent chains of multiplications and additions; returns how many operations that were. `sink` takes the result.
std::int64_t multiply_and_add(std::int64_t rounds, float* sink);
std::int64_t multiply_add_fused(std::int64_t rounds, float* sink);

}  // namespace calot::app

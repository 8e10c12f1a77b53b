#pragma once
// What the machine gives at best, measured in the same run as what is compared with it.

#include "bench_jobs.h"
#include "bench_results.h"

namespace calot::app {

/// Adds to `ceilings`, or betters what is there: other programs may have taken part of the machine at the time.
void measure_ceilings(const std::vector<int>& threads, bool quick, Ceilings& ceilings, const Jobs::Report& report);

/// Bandwidth for reading a working set of so many bytes: of the measured ones, the next larger.
double read_bytes_per_us(const Ceilings& ceilings, int threads, double working_set_bytes);
/// Operations in a microsecond, multiplications and additions separate.
double operations_per_us(const Ceilings& ceilings, int threads);

/// A fixed piece of arithmetic of some ten microseconds, within registers. Returns its time [us].
double yardstick_us();

}  // namespace calot::app

#pragma once
// Times a kernel, its reference and the yardstick in turn.

#include <functional>
#include <string>

#include "bench_jobs.h"
#include "bench_results.h"

namespace calot::app {

/// What one call of a kernel must do at least: the model behind its floor.
struct Floor {
    double operations = 0.0;  ///< additions and multiplications
    double bytes = 0.0;       ///< read and written, each array once
};

struct KernelCase {
    std::string name;
    std::int64_t size = 0;
    std::string unit;
    int threads = 1;
    double target_us = 0.0;
    Floor floor;
    std::function<void()> run;        ///< one call, timed
    std::function<void()> reference;  ///< empty: there is none
    std::function<void()> reset;      ///< before every batch of calls, not timed; may be empty
    int most_calls = 1 << 20;         ///< in a batch, before it must be reset
    double per_call = 1.0;            ///< kernels in a call: times are divided by it
};

/// `seconds` is about how long it may take.
KernelResult measure(const KernelCase& kernel, double seconds, const Jobs::Report& report);

/// floor_us from operations and bytes.
void set_floor(const Ceilings& ceilings, KernelResult& kernel);

}  // namespace calot::app

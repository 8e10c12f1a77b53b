#include "bench_measure.h"

#include <algorithm>
#include <chrono>

#include "bench_ceilings.h"
#include "bench_statistics.h"
#include "calot/base/parallel.h"

namespace calot::app {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// One batch [us a call].
double time_batch(const std::function<void()>& reset, const std::function<void()>& body, int calls) {
    if (reset) reset();
    const auto start = Clock::now();
    for (int k = 0; k < calls; ++k) body();
    return seconds_since(start) * 1e6 / calls;
}

constexpr double kBatch_us = 300.0;  ///< short, so that some batches are not disturbed, yet long for the clock
constexpr int kFewest = 5, kMost = 200;

int calls_for(double us, int most) {
    return std::clamp(static_cast<int>(kBatch_us / std::max(us, 0.01)), 1, most);
}

}  // namespace

KernelResult measure(const KernelCase& kernel, double seconds, const Jobs::Report& report) {
    const ThreadLimit limit(kernel.threads);
    KernelResult result;
    result.name = kernel.name;
    result.size = kernel.size;
    result.unit = kernel.unit;
    result.threads = kernel.threads;
    result.target_us = kernel.target_us;

    time_batch(kernel.reset, kernel.run, 1);  // warms caches and branch predictors
    // What must be reset in between is measured over all calls up to there: later ones may take longer.
    const int calls =
        kernel.reset ? kernel.most_calls : calls_for(time_batch(kernel.reset, kernel.run, 1), kernel.most_calls);
    std::vector<double> reference_us;
    const auto start = Clock::now();
    for (int k = 0; k < kMost; ++k) {
        const double spent = seconds_since(start) / seconds;
        if (k >= kFewest && spent > 1.0) break;
        if (!report(std::max(spent, static_cast<double>(k) / kMost))) break;
        result.yardstick_us.push_back(yardstick_us());
        result.samples_us.push_back(time_batch(kernel.reset, kernel.run, calls) / kernel.per_call);
        if (kernel.reference && (reference_us.empty() || k % 4 == 3))
            reference_us.push_back(time_batch(kernel.reset, kernel.reference, 1) / kernel.per_call);
    }
    result.us = least(result.samples_us);
    result.reference_us = least(reference_us);
    result.operations = kernel.floor.operations;
    result.bytes = kernel.floor.bytes;
    return result;
}

void set_floor(const Ceilings& ceilings, KernelResult& kernel) {
    const double operations = operations_per_us(ceilings, kernel.threads),
                 bytes = read_bytes_per_us(ceilings, kernel.threads, kernel.bytes);
    const double by_operations = operations > 0.0 ? kernel.operations / operations : 0.0,
                 by_bytes = bytes > 0.0 ? kernel.bytes / bytes : 0.0;
    kernel.floor_us = std::max(by_operations, by_bytes);
    kernel.floor_of_bytes = by_bytes > by_operations;
}

}  // namespace calot::app

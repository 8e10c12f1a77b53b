#pragma once
// What ticks and kernels cost on a device, with transfers and launches apart.

#include "bench_suites.h"
#include "calot/simulation/setup.h"

namespace calot::app {

/// Launches, transfers and memory of the device itself.
void add_device_limits(const BenchPlan& plan, Jobs& jobs, BenchResults& results);
/// The kernels of all rooms on it.
void add_device_kernels(const BenchPlan& plan, Jobs& jobs, BenchResults& results);

/// Runs so many ticks of a setup that computes on a device, with its clocks on. `report` is told shares of it.
DeviceCost cost_of_ticks(const std::shared_ptr<const simulation::Setup>& setup, std::int64_t ticks,
                         const std::string& title, const Jobs::Report& report);

}  // namespace calot::app

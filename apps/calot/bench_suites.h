#pragma once
// The suites of `calot bench`: each adds its jobs, which write into `results`.

#include <functional>
#include <optional>
#include <vector>

#include "bench_jobs.h"
#include "bench_measure.h"
#include "bench_results.h"
#include "calot/gpu/choose.h"

namespace calot::app {

struct BenchPlan {
    int threads = 1;          ///< the most that are used
    double simulated_s = 30;  ///< of each scene
    int passes = 1;           ///< over each scene
    bool quick = false;
    std::optional<gpu::DeviceInfo> device;  ///< ticks and kernels run there

    /// Seconds for a kernel.
    double per_kernel_s() const { return quick ? 0.1 : 2.0; }
    /// One thread, and all of them.
    std::vector<int> thread_counts() const { return threads > 1 ? std::vector<int>{1, threads} : std::vector<int>{1}; }
};

void add_kernels(const BenchPlan& plan, Jobs& jobs, BenchResults& results);
void add_embedding_kernels(const BenchPlan& plan, Jobs& jobs, BenchResults& results);
void add_surface(const BenchPlan& plan, Jobs& jobs, BenchResults& results);
void add_ticks(const BenchPlan& plan, Jobs& jobs, BenchResults& results);
void add_scale(const BenchPlan& plan, Jobs& jobs, BenchResults& results);
void add_paper(const BenchPlan& plan, Jobs& jobs, BenchResults& results);

/// One substep of elasticity in a block of exactly so many phyxels.
KernelCase deformation_step(std::int64_t phyxels, int threads, double target_us, bool with_reference);

/// A kernel that is set up when its turn comes, so that bodies do not take memory from one another.
inline void add_kernel(const BenchPlan& plan, Jobs& jobs, BenchResults& results, const std::string& label,
                       std::function<KernelCase()> make) {
    jobs.add(label, plan.per_kernel_s() + 0.3, [&results, plan, make = std::move(make)](const Jobs::Report& report) {
        results.kernels.push_back(measure(make(), plan.per_kernel_s(), report));
    });
}

}  // namespace calot::app

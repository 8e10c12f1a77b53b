#pragma once
// What `calot bench` finds out. Written as JSON (bench_json.cpp) and as a page (bench_html.cpp).

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "calot/simulation/step.h"

namespace calot::app {

/// The machine and how it was used.
struct Machine {
    std::string processor, system, compiler, instruction_set;
    int cores = 0;
    double memory_GB = 0.0;
    std::string scheduling;      ///< of the measuring threads
    bool memory_locked = false;  ///< pages cannot be swapped out
    double load = 0.0;           ///< of the last minute, when the run began: others disturb a measurement
};

/// Bandwidth of a working set, all threads together.
struct Bandwidth {
    double megabytes = 0.0;
    int threads = 1;
    double read_GB_per_s = 0.0;
    double copy_GB_per_s = 0.0;  ///< bytes read and bytes written
};
/// Single precision, additions and multiplications counted one by one.
struct ArithmeticRate {
    int threads = 1;
    double separate_GFlop_per_s = 0.0;  ///< as Calot's kernels do it, so that all instruction sets give the same bytes
    double fused_GFlop_per_s = 0.0;
};
/// What the machine gives at best.
struct Ceilings {
    std::vector<Bandwidth> bandwidth;
    std::vector<ArithmeticRate> arithmetic;
    double parallel_for_us = 0.0;  ///< an empty loop over all threads
};

/// One kernel at one size. Times are per call.
struct KernelResult {
    std::string name;
    std::int64_t size = 0;
    std::string unit;  ///< of the size: "phyxels", ...
    int threads = 1;
    double us = 0.0;                       ///< least of all repetitions
    double reference_us = 0.0;             ///< of the scalar reference, one thread; 0 = there is none
    double operations = 0.0, bytes = 0.0;  ///< of a call, counted; 0 = not counted
    double floor_us = 0.0;                 ///< by them, 0 = none
    bool floor_of_bytes = false;
    double target_us = 0.0;  ///< 0 = none
    // One entry a repetition, for comparisons. The yardstick is a fixed piece of arithmetic, timed in turn with the
    // kernel: what slows both down is the machine.
    std::vector<double> samples_us, yardstick_us;
};

/// What happened in one tick.
struct TickEvent {
    std::int64_t tick = 0;
    double us = 0.0;
    std::array<float, simulation::kStages> stages_us{};
    bool pedal = false;
    std::int64_t removed = 0, severed = 0, contacts = 0, near = 0, gas = 0;
    std::string cause;  ///< in words
};

struct StageTimes {
    double mean = 0.0, median = 0.0, p99 = 0.0, max = 0.0;
};

/// One scene, tick by tick.
struct TickResult {
    std::string scene, title;
    std::int64_t phyxels = 0, hexels = 0;
    int threads = 1;
    double simulated_s = 0.0;
    double median_us = 0.0, p99_us = 0.0, p999_us = 0.0, max_us = 0.0, mean_us = 0.0;
    /// The same scene run `passes` times, the figures above are of the first. Every pass does the same work in a tick;
    /// what the shortest takes is the program's, what others take longer is the machine's. Of these shortest [us]:
    int passes = 1;
    StageTimes least{};
    double burning_p99_us = 0.0;  ///< of ticks with the pedal down
    std::int64_t burning_ticks = 0;
    std::int64_t late = 0;  ///< ticks longer than the time that they stand for
    std::int64_t removed = 0, severed = 0;
    std::int64_t most_removed_in_a_second = 0;
    double target_p99_us = 0.0;
    std::array<StageTimes, simulation::kStages> stages_us{};
    std::vector<TickEvent> worst;  ///< the longest ticks, longest first
    /// Share of ticks per bin of a logarithmic scale: bins of a stage, then of the whole tick.
    std::vector<double> bin_edges_us;
    std::array<std::vector<std::int64_t>, simulation::kStages + 1> histogram;
    /// Of every hundred milliseconds of simulated time. Runs are bit for bit the same, so that these can be paired.
    std::vector<double> block_median_us, block_p99_us;
};

struct PaperRow {
    std::string table;  ///< "Table 1", ...
    std::int64_t size = 0;
    std::string stage;
    double ours_ms = 0.0;
    double published_ms = 0.0;  ///< 0 = the paper gives none
};

/// A picture on the page, PNG.
struct Picture64 {
    std::string figure, caption, base64;
};

/// Force against time while pressing and releasing.
struct PressCurve {
    std::string name;
    std::vector<std::array<double, 3>> points;  ///< time s, depth mm, force N
};

struct ScaleResult {
    std::vector<std::int64_t> sizes;  ///< hexels, all of them warm
    std::vector<double> us;
    std::array<std::vector<double>, simulation::kStages> stages_us;
    double exponent = 0.0;  ///< us ~ sizes^exponent
    int threads = 1;
};

/// What a call or a tick on a device is made of, on average.
struct DeviceCost {
    std::string name;
    std::int64_t size = 0;
    std::string unit;
    double us = 0.0;                              ///< by the host's clock, waiting included
    double kernels_us = 0.0, transfers_us = 0.0;  ///< by the device's
    double launches = 0.0, reads = 0.0;           ///< of reads each waits for the device
    double bytes_up = 0.0, bytes_down = 0.0;
    std::vector<std::pair<std::string, double>> kernel_us;  ///< by kernel, longest first
};

/// `--backend gpu`.
struct DeviceBench {
    std::string name;            ///< empty: the CPU computed
    double launch_us = 0.0;      ///< of one kernel among many
    double round_trip_us = 0.0;  ///< of one kernel and four bytes back
    double up_GB_per_s = 0.0, down_GB_per_s = 0.0;
    double copy_GB_per_s = 0.0;  ///< within the device, bytes read and bytes written
    std::vector<DeviceCost> costs;
};

struct BenchResults {
    Machine machine;
    Ceilings ceilings;
    std::vector<KernelResult> kernels;
    std::vector<TickResult> tick;
    std::vector<PaperRow> paper;
    std::vector<Picture64> pictures;
    std::vector<PressCurve> press;
    ScaleResult scale;
    DeviceBench device;
    std::vector<std::string> notes;
    double wall_s = 0.0;
    bool quick = false;
};

}  // namespace calot::app

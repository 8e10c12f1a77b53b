// `calot bench`: measures speed, writes figures, a page, and what moved against an earlier run.

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <thread>

#include <fmt/format.h>

#include "bench_ceilings.h"
#include "bench_compare.h"
#include "bench_gpu.h"
#include "bench_html.h"
#include "bench_json.h"
#include "bench_machine.h"
#include "bench_suites.h"
#include "calot/base/error.h"
#include "calot/base/parallel.h"
#include "commands.h"
#include "interrupt.h"
#include "output_directory.h"

namespace calot::app {

namespace {

namespace fs = std::filesystem;

bool wanted(const BenchOptions& options, const char* suite) {
    return options.suites.empty() ||
           std::find(options.suites.begin(), options.suites.end(), suite) != options.suites.end();
}

Jobs plan_jobs(const BenchOptions& options, const BenchPlan& plan, BenchResults& results) {
    Jobs jobs;
    const auto ceilings = [plan, &results](const Jobs::Report& report) {
        measure_ceilings(plan.thread_counts(), plan.quick, results.ceilings, report);
    };
    jobs.add("ceilings of the machine", plan.quick ? 0.3 : 3.0, ceilings);
    if (plan.device) {
        add_device_limits(plan, jobs, results);
        if (wanted(options, "kernels")) add_device_kernels(plan, jobs, results);
        if (wanted(options, "tick")) add_ticks(plan, jobs, results);
    } else {
        if (wanted(options, "kernels")) add_kernels(plan, jobs, results);
        if (wanted(options, "surface")) add_surface(plan, jobs, results);
        if (wanted(options, "tick")) add_ticks(plan, jobs, results);
        if (wanted(options, "scale")) add_scale(plan, jobs, results);
        if (wanted(options, "paper")) add_paper(plan, jobs, results);
    }
    jobs.add("ceilings once more", plan.quick ? 0.3 : 3.0, ceilings);
    jobs.add("floors", 0.01, [&results](const Jobs::Report&) {
        for (KernelResult& kernel : results.kernels) set_floor(results.ceilings, kernel);
    });
    return jobs;
}

void print_kernels(const BenchResults& results) {
    if (results.kernels.empty()) return;
    fmt::print("\n{:<34}{:>12}{:>9}{:>12}{:>12}{:>9}{:>12}{:>11}\n", "kernel", "size", "threads", "us", "floor us",
               "of it", "reference", "to reach");
    for (const KernelResult& k : results.kernels)
        fmt::print("{:<34}{:>12}{:>9}{:>12.2f}{:>12}{:>9}{:>12}{:>11}\n", k.name, grouped_number(k.size), k.threads,
                   k.us, k.floor_us > 0.0 ? fmt::format("{:.2f}", k.floor_us) : "",
                   k.floor_us > 0.0 ? fmt::format("{:.0f} %", 100.0 * k.floor_us / k.us) : "",
                   k.reference_us > 0.0 ? fmt::format("x {:.1f}", k.reference_us / k.us) : "",
                   k.target_us > 0.0 ? fmt::format("{:g}", k.target_us) : "");
}

void print_ticks(const BenchResults& results) {
    if (results.tick.empty()) return;
    fmt::print("\n{:<40}{:>9}{:>11}{:>9}{:>10}{:>10}{:>10}{:>10}{:>6}{:>16}\n", "ticks of 1 ms, us", "phyxels",
               "hexels", "threads", "median", "99 %", "99.9 %", "longest", "late", "99 % of least");
    for (const TickResult& t : results.tick)
        fmt::print("{:<40}{:>9}{:>11}{:>9}{:>10.1f}{:>10.1f}{:>10.1f}{:>10.1f}{:>6}{:>16}\n", t.title,
                   grouped_number(t.phyxels), grouped_number(t.hexels), t.threads, t.median_us, t.p99_us, t.p999_us,
                   t.max_us, t.late, t.passes > 1 ? fmt::format("{:.1f}", t.least.p99) : "");
    for (const TickResult& t : results.tick)
        if (!t.worst.empty())
            fmt::print("  longest of {}: {:.0f} us at {:.3f} s: {}\n", t.title, t.worst.front().us,
                       1e-3 * static_cast<double>(t.worst.front().tick), t.worst.front().cause);
}

void print_device(const DeviceBench& device) {
    if (device.name.empty()) return;
    fmt::print("\n{}: a launch {:.1f} us, with four bytes back {:.1f} us; {:.1f} GB/s up, {:.1f} down, {:.1f} within\n",
               device.name, device.launch_us, device.round_trip_us, device.up_GB_per_s, device.down_GB_per_s,
               device.copy_GB_per_s);
    fmt::print("{:<40}{:>12}{:>11}{:>11}{:>11}{:>10}{:>8}{:>11}{:>11}\n", "on the device, us", "size", "whole",
               "kernels", "transfers", "launches", "waits", "bytes up", "down");
    for (const DeviceCost& c : device.costs)
        fmt::print("{:<40}{:>12}{:>11.1f}{:>11.1f}{:>11.1f}{:>10.1f}{:>8.1f}{:>11.0f}{:>11.0f}\n", c.name,
                   grouped_number(c.size), c.us, c.kernels_us, c.transfers_us, c.launches, c.reads, c.bytes_up,
                   c.bytes_down);
    for (const DeviceCost& c : device.costs) {
        std::string longest;
        for (std::size_t k = 0; k < std::min<std::size_t>(5, c.kernel_us.size()); ++k)
            longest += fmt::format("{}{} {:.1f}", k == 0 ? "" : ", ", c.kernel_us[k].first, c.kernel_us[k].second);
        if (!longest.empty()) fmt::print("  {}: {}\n", c.name, longest);
    }
}

void print_paper(const BenchResults& results) {
    if (results.paper.empty()) return;
    fmt::print("\n{:<10}{:>11}  {:<42}{:>12}{:>14}\n", "paper", "size", "stage", "ours ms", "published ms");
    for (const PaperRow& row : results.paper)
        fmt::print("{:<10}{:>11}  {:<42}{:>12.4f}{:>14}\n", row.table, grouped_number(row.size), row.stage, row.ours_ms,
                   row.published_ms > 0.0 ? fmt::format("{:g}", row.published_ms) : "");
}

void print_scale(const BenchResults& results) {
    if (results.scale.sizes.empty()) return;
    fmt::print("\nall hexels warm, {} thread(s):", results.scale.threads);
    for (std::size_t k = 0; k < results.scale.sizes.size(); ++k)
        fmt::print("  {} {:.0f} us", grouped_number(results.scale.sizes[k]), results.scale.us[k]);
    fmt::print("\nthe time of a tick grows as n^{:.2f} over the larger half\n", results.scale.exponent);
}

void print_results(const BenchResults& results) {
    const Machine& m = results.machine;
    fmt::print("{}, {} cores, {}, {}\n", m.processor, m.cores, m.instruction_set, m.scheduling);
    for (const ArithmeticRate& a : results.ceilings.arithmetic)
        fmt::print("{} thread(s): {:.0f} GFlop/s ({:.0f} fused)", a.threads, a.separate_GFlop_per_s,
                   a.fused_GFlop_per_s);
    fmt::print("\n");
    print_kernels(results);
    print_ticks(results);
    print_device(results.device);
    print_scale(results);
    print_paper(results);
    for (const std::string& note : results.notes) fmt::print("note: {}\n", note);
}

/// Written beside, then renamed: nothing half-written under the final name.
void write_whole(const std::string& path, const std::string& content) {
    const std::string partial = path + ".partial";
    write_file(partial, content);
    fs::rename(partial, path);
}

/// Before minutes of work: can results be written there?
void check_writable(const std::string& path) {
    const fs::path parent = fs::path(path).parent_path();
    std::error_code error;
    if (!parent.empty() && !fs::is_directory(parent, error))
        throw InputError(path, 0, 0, "its directory does not exist", "create it, or write elsewhere");
    if (fs::is_directory(path, error)) throw InputError(path, 0, 0, "this is a directory", "give the name of a file");
}

}  // namespace

int bench(const BenchOptions& options) {
    catch_interrupts();
    std::string json = options.json, html = options.html;
    if (json.empty() && html.empty()) {
        fs::create_directories("out/bench");
        json = "out/bench/bench.json";
        html = "out/bench/bench.html";
    }
    for (const std::string& path : {json, html})
        if (!path.empty()) check_writable(path);
    // The earlier file is read first: it may be the one that is written.
    const SampleSet earlier = options.compare.empty() ? SampleSet{} : read_samples(options.compare);

    BenchPlan plan;
    plan.threads =
        options.threads > 0 ? options.threads : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    plan.quick = options.quick;
    plan.simulated_s = options.seconds > 0.0 ? options.seconds : options.quick ? 1.8 : 30.0;
    plan.passes = options.passes > 0                                               ? options.passes
                  : options.quick || options.backend.kind != gpu::BackendKind::cpu ? 1
                                                                                   : 3;

    if (options.backend.kind != gpu::BackendKind::cpu) {
        // Scenes of all sizes are measured: `auto` asks for a GPU, not for a size.
        const gpu::BackendChoice choice = gpu::choose_backend(options.backend, gpu::devices(), gpu::kWorthADevice);
        plan.device = choice.device;
        fmt::print(stderr, "calot: backend: {}\n", choice.why);
        for (const std::string& suite : options.suites)
            if (plan.device && suite != "kernels" && suite != "tick")
                throw InputError(fmt::format("the suite {} is of the CPU", suite),
                                 "with --backend gpu there are kernels and tick");
    }

    BenchResults results;
    results.quick = options.quick;
    results.machine = describe_machine();
    if (options.real_time) ask_for_real_time(results.machine);
    const auto start = std::chrono::steady_clock::now();
    BenchProgress progress(options.progress);
    const bool complete = plan_jobs(options, plan, results).run(progress);
    results.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (!complete) {
        fmt::print(stderr, "calot: interrupted; nothing was written\n");
        return kInterrupted;
    }

    const std::vector<Comparison> comparisons = compare(earlier, samples_of(results));
    print_results(results);
    if (!options.compare.empty()) fmt::print("\n{}", comparison_text(comparisons));
    if (!json.empty()) write_whole(json, bench_json(results));
    if (!html.empty()) write_whole(html, bench_html(results, comparisons));
    if (!html.empty()) fmt::print("\nlook at {}\n", html);
    if (!json.empty()) fmt::print("{}figures: {}\n", html.empty() ? "\n" : "", json);
    return kDone;
}

}  // namespace calot::app

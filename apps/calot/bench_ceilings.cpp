#include "bench_ceilings.h"

#include <algorithm>
#include <chrono>
#include <functional>

#include "bench_ceilings_simd.h"
#include "calot/base/array.h"
#include "calot/base/parallel.h"

namespace calot::app {

namespace {

using Clock = std::chrono::steady_clock;

volatile float kept = 0.0f;  ///< results go here, so that nothing is optimised away

/// Least of several runs [us].
double least_us(int runs, const std::function<void()>& body) {
    double best = 1e300;
    for (int k = 0; k < runs; ++k) {
        const auto start = Clock::now();
        body();
        best = std::min(best, std::chrono::duration<double, std::micro>(Clock::now() - start).count());
    }
    return best;
}

Bandwidth measure_bandwidth(double megabytes, int threads, bool quick) {
    const ThreadLimit limit(threads);
    // One piece a thread, in whole groups of 128 floats.
    const auto piece = static_cast<std::int64_t>(megabytes * 1e6 / 4.0 / threads) / 128 * 128;
    Array<float> from(static_cast<std::size_t>(piece * threads), 1.0f), to(from.size() / 2, 0.0f);
    // Small sets are gone through often, so that the clock does not show.
    const int passes = std::max(1, static_cast<int>((quick ? 4.0 : 16.0) / megabytes));
    const int runs = quick ? 5 : 15;
    Bandwidth result{megabytes, threads, 0.0, 0.0};
    const double bytes = 4.0 * static_cast<double>(piece) * threads * passes;
    result.read_GB_per_s = 1e-3 * bytes / least_us(runs, [&] {
                               parallel_for("bench.read", 0, threads, 1, [&](std::int64_t k, std::int64_t) {
                                   for (int pass = 0; pass < passes; ++pass)
                                       kept = read_all(&from[static_cast<std::size_t>(k * piece)], piece);
                               });
                           });
    // Half of the set is copied to the other half.
    result.copy_GB_per_s = 1e-3 * bytes / least_us(runs, [&] {
                               parallel_for("bench.copy", 0, threads, 1, [&](std::int64_t k, std::int64_t) {
                                   const auto at = static_cast<std::size_t>(k * piece / 2);
                                   for (int pass = 0; pass < passes; ++pass) copy_all(&from[at], &to[at], piece / 2);
                               });
                           });
    return result;
}

ArithmeticRate measure_arithmetic(int threads, bool quick) {
    const ThreadLimit limit(threads);
    const std::int64_t rounds = quick ? 100'000 : 400'000;
    ArithmeticRate rate{threads, 0.0, 0.0};
    auto measure = [&](std::int64_t (*loop)(std::int64_t, float*)) {
        std::int64_t operations = 0;
        const double us = least_us(quick ? 5 : 15, [&] {
            parallel_for("bench.arithmetic", 0, threads, 1, [&](std::int64_t k, std::int64_t) {
                float sink = 0.0f;
                const std::int64_t done = loop(rounds, &sink);
                kept = sink;
                if (k == 0) operations = done;
            });
        });
        return 1e-3 * static_cast<double>(operations * threads) / us;
    };
    rate.separate_GFlop_per_s = measure(multiply_and_add);
    rate.fused_GFlop_per_s = measure(multiply_add_fused);
    return rate;
}

double measure_parallel_for_us(int threads) {
    const ThreadLimit limit(threads);
    constexpr int kLoops = 1000;
    return least_us(10,
                    [&] {
                        for (int k = 0; k < kLoops; ++k)
                            parallel_for("bench.empty", 0, threads, 1, [](std::int64_t, std::int64_t) {});
                    }) /
           kLoops;
}

void take_better(const Bandwidth& measured, Ceilings& ceilings) {
    for (Bandwidth& b : ceilings.bandwidth)
        if (b.megabytes == measured.megabytes && b.threads == measured.threads) {
            b.read_GB_per_s = std::max(b.read_GB_per_s, measured.read_GB_per_s);
            b.copy_GB_per_s = std::max(b.copy_GB_per_s, measured.copy_GB_per_s);
            return;
        }
    ceilings.bandwidth.push_back(measured);
}

void take_better(const ArithmeticRate& measured, Ceilings& ceilings) {
    for (ArithmeticRate& a : ceilings.arithmetic)
        if (a.threads == measured.threads) {
            a.separate_GFlop_per_s = std::max(a.separate_GFlop_per_s, measured.separate_GFlop_per_s);
            a.fused_GFlop_per_s = std::max(a.fused_GFlop_per_s, measured.fused_GFlop_per_s);
            return;
        }
    ceilings.arithmetic.push_back(measured);
}

}  // namespace

void measure_ceilings(const std::vector<int>& threads, bool quick, Ceilings& ceilings, const Jobs::Report& report) {
    // Within the caches of a core, of all cores, and beyond.
    const std::vector<double> sizes =
        quick ? std::vector<double>{0.25, 4.0} : std::vector<double>{0.25, 1.0, 4.0, 16.0, 64.0, 256.0};
    double done = 0.0;
    const double all = static_cast<double>(threads.size() * (sizes.size() + 1));
    for (const int count : threads) {
        for (const double megabytes : sizes) {
            take_better(measure_bandwidth(megabytes, count, quick), ceilings);
            if (!report(++done / all)) return;
        }
        take_better(measure_arithmetic(count, quick), ceilings);
        if (!report(++done / all)) return;
    }
    const double us = measure_parallel_for_us(threads.back());
    ceilings.parallel_for_us = ceilings.parallel_for_us > 0.0 ? std::min(ceilings.parallel_for_us, us) : us;
}

double read_bytes_per_us(const Ceilings& ceilings, int threads, double working_set_bytes) {
    const Bandwidth* best = nullptr;
    for (const Bandwidth& b : ceilings.bandwidth) {
        if (b.threads != threads) continue;
        best = &b;
        if (b.megabytes * 1e6 >= working_set_bytes) break;
    }
    return best ? best->read_GB_per_s * 1e3 : 0.0;
}

double operations_per_us(const Ceilings& ceilings, int threads) {
    for (const ArithmeticRate& rate : ceilings.arithmetic)
        if (rate.threads == threads) return rate.separate_GFlop_per_s * 1e3;
    return 0.0;
}

double yardstick_us() {
    float sink = 0.0f;
    const auto start = Clock::now();
    multiply_and_add(4000, &sink);
    const double us = std::chrono::duration<double, std::micro>(Clock::now() - start).count();
    kept = sink;
    return us;
}

}  // namespace calot::app

#pragma once
// Parallel loops by name, over oneTBB. Chunks are fixed by the caller and never depend on the number of threads, so
// that any reduction over chunks in order gives the same bytes for any number of threads.

#include <array>
#include <cassert>
#include <cstdint>

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/task_arena.h>

namespace calot {

/// Threads that parallel loops use while this object lives (process-wide).
class ThreadLimit {
  public:
    explicit ThreadLimit(int threads) : control_(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads)) {}

  private:
    tbb::global_control control_;
};

/// Calls body(begin, end) for consecutive chunks of `chunk` elements of [begin, end). Chunks run in any order, at the
/// same time; a body may write only what belongs to its chunk. `name` is "room.stage" for profilers.
template <class Body>
void parallel_for([[maybe_unused]] const char* name, std::int64_t begin, std::int64_t end, std::int64_t chunk, const Body& body) {
    assert(chunk > 0);
    const std::int64_t chunks = (end - begin + chunk - 1) / chunk;
    auto run_chunk = [&](std::int64_t k) {
        const std::int64_t low = begin + k * chunk;
        const std::int64_t high = low + chunk < end ? low + chunk : end;
        body(low, high);
    };
    if (chunks <= 1 || tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism) == 1) {
        for (std::int64_t k = 0; k < chunks; ++k) run_chunk(k);
        return;
    }
    tbb::parallel_for(std::int64_t{0}, chunks, run_chunk, tbb::simple_partitioner{});
}

/// Calls both, at the same time if a thread is free; one may not touch what the other writes.
template <class First, class Second>
void parallel_pair([[maybe_unused]] const char* name, const First& first, const Second& second) {
    if (tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism) == 1) {
        first();
        second();
        return;
    }
    tbb::parallel_invoke(first, second);
}

/// Sum of body(begin, end) over the chunks, added in the order of the chunks: the same bytes for any number of
/// threads. At most 4096 chunks.
template <class Body>
double parallel_sum(const char* name, std::int64_t begin, std::int64_t end, std::int64_t chunk, const Body& body) {
    std::array<double, 4096> partial;
    const std::int64_t chunks = (end - begin + chunk - 1) / chunk;
    assert(chunks <= static_cast<std::int64_t>(partial.size()));
    parallel_for(name, begin, end, chunk, [&](std::int64_t low, std::int64_t high) {
        partial[static_cast<std::size_t>((low - begin) / chunk)] = body(low, high);
    });
    double total = 0.0;
    for (std::int64_t k = 0; k < chunks; ++k) total += partial[static_cast<std::size_t>(k)];
    return total;
}

}  // namespace calot

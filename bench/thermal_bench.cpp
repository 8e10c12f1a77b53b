// Heat: a dense step (every block active) by the production kernels and by the scalar reference, and a burn, where only
// warm blocks work.

#include <benchmark/benchmark.h>

#include "calot/anatomy/block.h"
#include "calot/base/parallel.h"
#include "calot/base/random.h"
#include "calot/thermal/heat.h"
#include "calot/tissue/sampling.h"

namespace {

using namespace calot;

struct Body {
    tissue::Model model;
    tissue::State state;
    tissue::Exchange exchange;
    thermal::Work work;

    /// A block of fat, at 37 to 42 C where `warm`, as hot as it gets without damage or boiling.
    Body(const benchmark::State& run, bool warm, int refresh_ticks = 1)
        : model(tissue::sample(anatomy::make_block({.size_m = 0.6e-3 * Vec3(run.range(0), run.range(1), run.range(2))}),
                               {})),
          state(tissue::State::make(model)) {
        model.thermal.refresh_ticks = refresh_ticks;
        Random random(1);
        for (std::int64_t i = model.hexels.first; warm && i < model.hexels.last; ++i)
            if (state.hexel_present.test(i))
                state.enthalpy_J_per_m3[static_cast<std::size_t>(i)] = static_cast<float>(random.uniform(0.0, 1e7));
        tissue::reserve_exchange(model, exchange);
        work = thermal::make_work(model, state);
    }
    void step() {
        exchange.gas.clear();
        exchange.removed_hexels.clear();
        thermal::conduct(model, state, exchange, work);
        thermal::remove_vaporised(model, state, exchange, work);
        ++state.tick;
    }
    void report(benchmark::State& run) const {
        const auto hexels = static_cast<double>(state.hexel_present.count());
        run.counters["hexels"] = hexels;
        run.counters["ns_per_hexel"] = benchmark::Counter(
            hexels * 1e-9, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
        run.counters["active_blocks"] = static_cast<double>(work.active.count());
    }
};

void sizes(benchmark::internal::Benchmark* bench) {
    bench->Args({64, 64, 36})->Args({128, 128, 72})->Unit(benchmark::kMicrosecond);
}

void heat_dense(benchmark::State& run) {
    const ThreadLimit limit(1);
    Body body(run, true);
    for (auto _ : run) body.step();
    body.report(run);
}
BENCHMARK(heat_dense)->Apply(sizes);

void heat_dense_two_threads(benchmark::State& run) {
    const ThreadLimit limit(2);
    Body body(run, true);
    for (auto _ : run) body.step();
    body.report(run);
}
BENCHMARK(heat_dense_two_threads)->Apply(sizes)->UseRealTime();

void heat_dense_scalar(benchmark::State& run) {
    const ThreadLimit limit(1);
    Body body(run, true);
    body.work.scalar = true;
    for (auto _ : run) body.step();
    body.report(run);
}
BENCHMARK(heat_dense_scalar)->Apply(sizes);

/// A burn as the electric field gives it: heat in a window of 48^3 cells about a spot on the surface.
void heat_burn(benchmark::State& run) {
    const ThreadLimit limit(1);
    Body body(run, false, 4);
    tissue::JouleHeat& joule = body.exchange.joule;
    const Int3 middle = body.model.hexels.size / 2;
    joule.place(body.model.hexels, Int3(middle.x - 24, middle.y - 24, body.model.hexels.size.z - 28), Int3(48));
    Array<float> density_W_per_m3(48 * 48 * 48);
    for (int z = 0; z < 48; ++z)
        for (int y = 0; y < 48; ++y)
            for (int x = 0; x < 48; ++x) {
                const Vec3 d = Vec3(x, y, z) - 24.0;
                density_W_per_m3[static_cast<std::size_t>(joule.index(joule.low + Int3(x, y, z)))] =
                    static_cast<float>(1e9 / std::pow(1.0 + 0.3 * glm::dot(d, d), 2.0));
            }
    joule.density = {density_W_per_m3.data(), density_W_per_m3.size()};
    for (int k = 0; k < 100; ++k) body.step();
    for (auto _ : run) body.step();
    body.report(run);
    run.counters["removed"] = static_cast<double>(body.state.hexels_burnt);
}
BENCHMARK(heat_burn)->Apply(sizes);

}  // namespace

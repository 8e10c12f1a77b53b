// Elasticity: a whole substep (velocities, displacements, gradients and stresses) by the production kernels and by the
// scalar reference, and a whole tick. Bodies are held blocks of fat; "phyxels" is how many move.

#include <benchmark/benchmark.h>

#include "calot/anatomy/block.h"
#include "calot/base/parallel.h"
#include "calot/deformation/integrate.h"
#include "calot/deformation/kernel.h"
#include "calot/deformation/reference.h"
#include "calot/tissue/sampling.h"

namespace {

using namespace calot;

struct Body {
    tissue::Model model;
    tissue::State state;
    deformation::Work work;
    tissue::Exchange exchange;

    explicit Body(const benchmark::State& run)
        : model(tissue::sample(anatomy::make_block({.size_m = 2.4e-3 * Vec3(run.range(0), run.range(1), run.range(2))}),
                               {})),
          state(tissue::State::make(model)) {
        model.deformation.gravity_m_per_s2 = Vec3(0.0, 0.0, -9.81);
        work = deformation::make_work(model, state);
        deformation::integrate(model, state, exchange, work);
    }
    void report(benchmark::State& run) const {
        const auto phyxels = static_cast<double>(state.phyxel_present.count());
        run.counters["phyxels"] = phyxels;
        run.counters["ns_per_phyxel"] = benchmark::Counter(
            phyxels * 1e-9, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
    }
};

void sizes(benchmark::internal::Benchmark* bench) {
    bench->Args({16, 16, 12})->Args({15, 15, 20})->Args({30, 30, 27})->Unit(benchmark::kMicrosecond);
}

void deformation_substep(benchmark::State& run) {
    Body body(run);
    const auto view = deformation::KernelView::make(body.model, body.state, body.work);
    for (auto _ : run) {
        deformation::sweep_motion(view, body.work.groups);
        deformation::sweep_gradients(view, body.work.groups);
    }
    body.report(run);
}
BENCHMARK(deformation_substep)->Apply(sizes);

void deformation_substep_scalar(benchmark::State& run) {
    Body body(run);
    deformation::Reference<float> reference(body.model, body.state, body.work);
    reference.update_gradients();
    for (auto _ : run) reference.advance(body.work.substep_s);
    body.report(run);
}
BENCHMARK(deformation_substep_scalar)->Apply(sizes);

void deformation_motion(benchmark::State& run) {
    Body body(run);
    const auto view = deformation::KernelView::make(body.model, body.state, body.work);
    for (auto _ : run) deformation::sweep_motion(view, body.work.groups);
    body.report(run);
}
BENCHMARK(deformation_motion)->Apply(sizes);

void deformation_gradients(benchmark::State& run) {
    Body body(run);
    const auto view = deformation::KernelView::make(body.model, body.state, body.work);
    for (auto _ : run) deformation::sweep_gradients(view, body.work.groups);
    body.report(run);
}
BENCHMARK(deformation_gradients)->Apply(sizes);

void deformation_tick(benchmark::State& run) {
    const ThreadLimit limit(static_cast<int>(run.range(3)));
    Body body(run);
    for (auto _ : run) deformation::integrate(body.model, body.state, body.exchange, body.work);
    body.report(run);
}
BENCHMARK(deformation_tick)
    ->Args({16, 16, 12, 1})
    ->Args({16, 16, 12, 2})
    ->Args({15, 15, 20, 1})
    ->Args({30, 30, 27, 1})
    ->Args({30, 30, 27, 2})
    ->Args({50, 50, 40, 1})
    ->Args({50, 50, 40, 2})
    ->UseRealTime()
    ->Unit(benchmark::kMicrosecond);

}  // namespace

// The electric field about the tip in a held block of fat, 36 x 36 x 19 mm, metal on 3 x 8 hexels of its top: a whole
// warm solve while the tip wanders and burns its way, its parts, and the same by the plain loops.

#include <algorithm>

#include <benchmark/benchmark.h>

#include "calot/anatomy/block.h"
#include "calot/base/parallel.h"
#include "calot/electric/work.h"
#include "calot/tissue/sampling.h"

namespace {

using namespace calot;

struct Field {
    tissue::Model model;
    tissue::State state;
    tissue::Exchange exchange;
    tissue::Input input;
    electric::WorkPtr work;

    Field(int window, const electric::Kernels& kernels) : model(tissue::sample(anatomy::make_block({}), {})) {
        model.electric.window_cells = window;
        state = tissue::State::make(model);
        work = electric::make_work(model, kernels);
        input.pedal = true;
        input.power_setting_W = 40.0;
        exchange.near.reserve(64);
        touch(28);
        electric::solve_potential(model, state, exchange, input, *work);
    }
    void touch(int low_x) {
        exchange.near.clear();
        for (int y = 30; y < 38; ++y)
            for (int x = low_x; x < low_x + 3; ++x) {
                tissue::NearHexel near;
                near.hexel = model.hexels.index(x, y, 35);
                near.bare_gap_m = 0.0f;
                exchange.near.push_back(near);
            }
    }
    /// The tip goes on by a hexel every fourth refresh and leaves a groove behind; at the end all is mended.
    void wander(int refresh) {
        const int at = 28 + refresh / 4 % 16;
        if (at == 28) state.hexel_present = model.hexel_initial;
        touch(at);
        for (int y = 30; y < 38; ++y) state.hexel_present.clear(model.hexels.index(at - 1, y, 35));
    }
};

void solve(benchmark::State& run, const electric::Kernels& kernels, int threads) {
    const ThreadLimit limit(threads);
    Field field(static_cast<int>(run.range(0)), kernels);
    int refresh = 0;
    double iterations = 0.0;
    for (auto _ : run) {
        field.wander(refresh++);
        electric::solve_potential(field.model, field.state, field.exchange, field.input, *field.work);
        iterations += field.work->iterations;
    }
    run.counters["iterations"] = iterations / refresh;
    run.counters["groups"] = static_cast<double>(field.work->grid.levels[0].groups.size());
}

void electric_warm_solve(benchmark::State& run) {
    solve(run, electric::wide_kernels(), 1);
}
void electric_warm_solve_2_threads(benchmark::State& run) {
    solve(run, electric::wide_kernels(), 2);
}
void electric_warm_solve_scalar(benchmark::State& run) {
    solve(run, electric::reference_kernels(), 1);
}
BENCHMARK(electric_warm_solve)->Arg(32)->Arg(48)->Arg(64)->Unit(benchmark::kMicrosecond);
BENCHMARK(electric_warm_solve_2_threads)->Arg(48)->Arg(64)->Unit(benchmark::kMicrosecond)->UseRealTime();
BENCHMARK(electric_warm_solve_scalar)->Arg(48)->Unit(benchmark::kMicrosecond);

void electric_cold_solve(benchmark::State& run) {
    const ThreadLimit limit(1);
    Field field(static_cast<int>(run.range(0)), electric::wide_kernels());
    for (auto _ : run) {
        std::fill(field.state.potential.begin(), field.state.potential.end(), 0.0f);
        electric::solve_potential(field.model, field.state, field.exchange, field.input, *field.work);
    }
    run.counters["iterations"] = field.work->iterations;
}
BENCHMARK(electric_cold_solve)->Arg(48)->Unit(benchmark::kMicrosecond);

void electric_begin(benchmark::State& run) {
    const ThreadLimit limit(1);
    Field field(48, electric::wide_kernels());
    for (auto _ : run) electric::begin_field(field.model, field.state, field.exchange, *field.work);
}
void electric_iteration(benchmark::State& run) {
    const ThreadLimit limit(1);
    Field field(48, electric::wide_kernels());
    int count = 0;
    for (auto _ : run) {
        if (count++ % 8 == 0) {  // eight iterations of a cold solve, so that numbers stay ordinary
            run.PauseTiming();
            std::fill(field.state.potential.begin(), field.state.potential.end(), 0.0f);
            electric::begin_field(field.model, field.state, field.exchange, *field.work);
            run.ResumeTiming();
        }
        electric::iterate(field.work->grid, 1, 0.0);
    }
}
void electric_finish(benchmark::State& run) {
    const ThreadLimit limit(1);
    Field field(48, electric::wide_kernels());
    for (auto _ : run) electric::finish_field(field.model, field.state, field.exchange, field.input, *field.work);
}
BENCHMARK(electric_begin)->Unit(benchmark::kMicrosecond);
BENCHMARK(electric_iteration)->Unit(benchmark::kMicrosecond);
BENCHMARK(electric_finish)->Unit(benchmark::kMicrosecond);

}  // namespace

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
        electric::solve_now(model, state, exchange, input, *work);
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
        electric::solve_now(field.model, field.state, field.exchange, field.input, *field.work);
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
BENCHMARK(electric_warm_solve_2_threads)->Arg(96)->Unit(benchmark::kMicrosecond)->UseRealTime();
BENCHMARK(electric_warm_solve_scalar)->Arg(48)->Unit(benchmark::kMicrosecond);

void electric_cold_solve(benchmark::State& run) {
    const ThreadLimit limit(1);
    Field field(static_cast<int>(run.range(0)), electric::wide_kernels());
    for (auto _ : run) {
        std::fill(field.state.potential.begin(), field.state.potential.end(), 0.0f);
        electric::solve_now(field.model, field.state, field.exchange, field.input, *field.work);
    }
    run.counters["iterations"] = field.work->iterations;
}
BENCHMARK(electric_cold_solve)->Arg(48)->Unit(benchmark::kMicrosecond);

/// One part of a frame's solve, by the tick in which it is done.
void electric_part(benchmark::State& run) {
    const ThreadLimit limit(1);
    Field field(48, electric::wide_kernels());
    electric::Work& work = *field.work;
    int frame = 0;
    for (auto _ : run) {
        run.PauseTiming();
        field.wander(frame++);
        field.state.tick = static_cast<std::int64_t>(field.model.frame_ticks) * frame;
        auto tick = [&] {
            electric::step_field(field.model, field.state, field.exchange, field.input, work);
            ++field.state.tick;
        };
        for (int part = 0; part < run.range(0); ++part) tick();
        run.ResumeTiming();
        tick();
        run.PauseTiming();
        for (int part = static_cast<int>(run.range(0)) + 1; part < field.model.frame_ticks; ++part) tick();
        run.ResumeTiming();
    }
}
BENCHMARK(electric_part)->DenseRange(0, 7)->Unit(benchmark::kMicrosecond);

/// A whole frame: its eighth is the cost of a tick.
void electric_frame(benchmark::State& run, const electric::Kernels& kernels) {
    const ThreadLimit limit(1);
    Field field(static_cast<int>(run.range(0)), kernels);
    int frame = 0;
    for (auto _ : run) {
        field.wander(frame++);
        for (int part = 0; part < field.model.frame_ticks; ++part) {
            electric::step_field(field.model, field.state, field.exchange, field.input, *field.work);
            ++field.state.tick;
        }
    }
    run.counters["residual"] = field.state.field.residual;
}
void electric_frame_wide(benchmark::State& run) {
    electric_frame(run, electric::wide_kernels());
}
void electric_frame_scalar(benchmark::State& run) {
    electric_frame(run, electric::reference_kernels());
}
BENCHMARK(electric_frame_wide)->Arg(48)->Arg(64)->Unit(benchmark::kMicrosecond);
BENCHMARK(electric_frame_scalar)->Arg(48)->Unit(benchmark::kMicrosecond);

}  // namespace

#include "calot/electric/solve.h"

#include <algorithm>
#include <cassert>

#include "calot/electric/conductivity.h"
#include "calot/electric/generator.h"
#include "calot/electric/work.h"

namespace calot::electric {

namespace {

void switch_off(tissue::State& state, tissue::Exchange& exchange) {
    state.generator = {};
    exchange.joule.size = Int3(0);
    exchange.joule.total_W = 0.0;
    exchange.joule.outflow_W = 0.0;
}

std::size_t in_window(const Window& window, const Int3& cell) {
    return static_cast<std::size_t>(cell.x + window.cells * (cell.y + window.cells * cell.z));
}

/// The last potential as a first guess. Where the window has moved, cells that it has not seen before take the value of
/// the nearest that it has.
void warm_start(const tissue::State& state, Work& work) {
    const Window& window = work.window;
    const Level& fine = work.grid.levels[0];
    const Cells x = work.grid.krylov.x;
    const Int3 moved = window.low - state.field_low;
    const Int3 shift(moved[window.axis.x], moved[window.axis.y], moved[window.axis.z]);
    const int last = window.cells - 1;
    for (int c = 0; c < window.cells; ++c)
        for (int b = 0; b < window.cells; ++b) {
            const Int3 from(0, std::clamp(b + shift.y, 0, last), std::clamp(c + shift.z, 0, last));
            const float* source = state.potential.data() + in_window(window, from);
            float* to = x.data() + fine.index(0, b, c);
            if (shift.x == 0)
                std::copy(source, source + window.cells, to);
            else
                for (int a = 0; a < window.cells; ++a) to[a] = source[std::clamp(a + shift.x, 0, last)];
        }
}

/// The finished solve: electrode at 1, gas and isolated cells at 0.
void keep_potential(tissue::State& state, Work& work) {
    const Window& window = work.window;
    const Level& fine = work.grid.levels[0];
    const Cells x = work.grid.krylov.x;
    const float* weight = fine.weight.data();
    for (int c = 0; c < window.cells; ++c)
        for (int b = 0; b < window.cells; ++b) {
            const std::int64_t row = fine.index(0, b, c);
            float* kept = state.potential.data() + in_window(window, {0, b, c});
            for (int a = 0; a < window.cells; ++a)
                kept[a] = x[static_cast<std::size_t>(row + a)] =
                    weight[row + a] > 0.0f ? x[static_cast<std::size_t>(row + a)] : 0.0f;
        }
    for (const std::int32_t cell : work.electrode_cells) {
        x[static_cast<std::size_t>(cell)] = 1.0f;
        const Int3 place = fine.coordinates(cell);
        state.potential[in_window(window, place)] = 1.0f;
    }
    state.field_low = window.low;
}

}  // namespace

void WorkDeleter::operator()(Work* work) const {
    delete work;
}

WorkPtr make_work(const tissue::Model& model) {
    return make_work(model, wide_kernels());
}

WorkPtr make_work(const tissue::Model& model, const Kernels& kernels) {
    const int cells = model.electric.window_cells;
    assert(cells >= 4);
    WorkPtr work(new Work);
    work->hexel_conductivity_S_per_m = conductivity_at_rest_S_per_m(model);
    work->grid = make_multigrid(cells, kernels);
    const auto length = static_cast<std::size_t>(work->grid.levels[0].length);
    const std::size_t side = static_cast<std::size_t>(cells) * static_cast<std::size_t>(cells);
    work->storage.allocate(work->grid.levels[0].length, 10, {&work->sigma_S_per_m});
    work->electrode = BitArray(static_cast<std::int64_t>(length));
    work->electrode_cells.reserve(2 * side);  // metal inside the window touches far fewer
    work->electrode_faces.reserve(6 * work->electrode_cells.capacity());
    work->right.reserve(6 * work->electrode_cells.capacity());
    work->outer_faces.reserve(6 * side);
    work->joule_W_per_m3.assign(side * static_cast<std::size_t>(cells), 0.0f);
    return work;
}

void begin_field(const tissue::Model& model, const tissue::State& state, const tissue::Exchange& exchange, Work& work) {
    work.window = place_window(model, exchange, state.field_low);
    assemble(model, state, exchange, work);
    build(work.grid);
    warm_start(state, work);
    begin(work.grid, work.right);
}

bool iterate_field(const tissue::Model& model, Work& work, int count) {
    return iterate(work.grid, count, model.electric.relative_residual);
}

void finish_field(const tissue::Model& model, tissue::State& state, tissue::Exchange& exchange,
                  const tissue::Input& input, Work& work) {
    if (!is_finite(work.grid)) {
        switch_off(state, exchange);
        state.status = {false, "potential", work.electrode_cells.empty() ? -1 : work.electrode_cells[0], state.tick};
        return;
    }
    work.iterations = work.grid.iterations;
    keep_potential(state, work);
    double tissue_W = 0.0, elsewhere_W = 0.0;  // per volt squared
    find_heat(model, state, work, tissue_W, elsewhere_W);
    state.generator = drive(input, model.electric, work.conductance_S);
    if (state.generator.power_W == 0.0) return switch_off(state, exchange);
    const double volt2 = state.generator.voltage_V * state.generator.voltage_V;
    write_heat(model, exchange, work, state.generator.voltage_V);
    exchange.joule.total_W = tissue_W * volt2;
    exchange.joule.outflow_W = elsewhere_W * volt2;
}

void solve_potential(const tissue::Model& model, tissue::State& state, tissue::Exchange& exchange,
                     const tissue::Input& input, Work& work) {
    if (!input.pedal || input.power_setting_W <= 0.0 || !any_touches(model.electric, exchange))
        return switch_off(state, exchange);
    if (state.tick % model.electric.refresh_ticks != 0) return;
    begin_field(model, state, exchange, work);
    iterate_field(model, work, model.electric.max_iterations);
    finish_field(model, state, exchange, input, work);
}

}  // namespace calot::electric

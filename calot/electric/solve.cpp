#include "calot/electric/solve.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "calot/electric/conductivity.h"
#include "calot/electric/generator.h"
#include "calot/electric/work.h"

namespace calot::electric {

namespace {

std::size_t in_window(const Window& window, const Int3& cell) {
    return static_cast<std::size_t>(cell.x + window.cells * (cell.y + window.cells * cell.z));
}

/// The last potential as a first guess. While the window stays it lies in krylov.x already; what lost its unknown since
/// is put to 0 by begin(). Where the window has moved, cells that it has not seen before take the value of the nearest
/// that it has. Cells without an unknown are at 0.
void warm_start(const tissue::State& state, Work& work) {
    const Window& window = work.window;
    if (work.kept == state.potential.data() && window.low == state.field_low) return;
    const Level& fine = work.grid.levels[0];
    const Int3 moved = window.low - state.field_low;
    const Int3 shift(moved[window.axis.x], moved[window.axis.y], moved[window.axis.z]);
    const int last = window.cells - 1;
    std::size_t n = 0;
    for (int c = 0; c < fine.rows; ++c)
        for (int b = 0; b < fine.rows; ++b) {
            const Int3 from(0, std::clamp(b + shift.y, 0, last), std::clamp(c + shift.z, 0, last));
            const float* __restrict source = state.potential.data() + in_window(window, from);
            for (int a = 0; a < fine.row; a += kGroup, ++n) {
                if (work.alive[n] == 0) continue;
                const float* __restrict weight = fine.weight.data() + fine.all[n].at;
                float* __restrict to = work.grid.krylov.x.data() + fine.all[n].at;
                if (shift.x == 0 && a + kGroup <= window.cells)
                    for (int k = 0; k < kGroup; ++k) to[k] = weight[k] > 0.0f ? source[a + k] : 0.0f;
                else
                    for (int k = 0; k < kGroup; ++k)
                        to[k] = weight[k] > 0.0f ? source[std::clamp(a + k + shift.x, 0, last)] : 0.0f;
            }
        }
}

/// Into the state, and for the next solve.
void keep_potential(tissue::State& state, Work& work, float scale) {
    const Window& window = work.window;
    const Level& fine = work.grid.levels[0];
    float* __restrict kept = state.potential.data();
    for (int c = 0; c < window.cells; ++c)
        for (int b = 0; b < window.cells; ++b) {
            float* __restrict x = work.grid.krylov.x.data() + fine.index(0, b, c);
            for (int a = 0; a < window.cells; ++a) kept[a] = x[a] = scale * x[a];
            kept += window.cells;
        }
    state.field_low = window.low;
    work.kept = state.potential.data();
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
    work->conductivity = conductivity_of_materials(model);
    work->grid = make_multigrid(cells, kernels);
    const Level& fine = work->grid.levels[0];
    const std::size_t side = static_cast<std::size_t>(cells) * static_cast<std::size_t>(cells);
    work->storage.allocate(fine.length, 10, {&work->sigma_S_per_m});
    work->alive.assign(static_cast<std::size_t>(fine.group_capacity()), 0);
    work->entered = BitArray(fine.length);
    work->entries.reserve(2 * side);  // metal inside the window touches far fewer
    work->electrode_cells.reserve(work->entries.capacity());
    work->near_of_entry.reserve(work->entries.capacity());
    work->right.reserve(work->entries.capacity());
    work->outer_faces.reserve(6 * side);
    return work;
}

void prepare(const tissue::State& state, Work& work) {
    build_coarse(work.grid);
    warm_start(state, work);
    work.kept = nullptr;  // until this solve is kept
}

void begin_field(Work& work) {
    begin(work.grid, work.right);
}

bool iterate_field(const tissue::Model& model, Work& work, int count) {
    return iterate(work.grid, count, model.electric.relative_residual);
}

void weigh_field(Work& work) {
    work.finite = is_finite(work.grid);
    if (!work.finite) return;
    work.scale = best_scale(work.grid, work.right);
    spread_heat(work);
}

void finish_field(const tissue::Model& model, tissue::State& state, Work& work) {
    if (!work.finite) {
        state.field.solved = 0;
        state.status = {false, "potential", work.entries.empty() ? -1 : work.entries[0].cell, state.tick};
        return;
    }
    work.iterations = work.grid.iterations;
    keep_heat(model, state, work);
    keep_potential(state, work, static_cast<float>(work.scale));
    state.field.residual = relative_residual(work.grid);
    state.field.contacts = static_cast<std::int64_t>(work.entries.size()) - work.arcs;
    state.field.arcs = work.arcs;
    state.field.solved = work.conductance_S >= kOpenCircuit_S ? 1 : 0;
    if (state.field.solved != 0)
        state.field.imbalance =
            std::max(state.field.imbalance, std::abs(work.electrode_conductance_S / work.conductance_S - 1.0));
}

void step_field(const tissue::Model& model, tissue::State& state, tissue::Exchange& exchange,
                const tissue::Input& input, Work& work) {
    const bool reached = !exchange.near.empty() && any_reached(find_reach(model, state, exchange, input), exchange);
    if (!reached) state.field.solved = 0;
    const auto part = static_cast<int>(state.tick % model.frame_ticks);
    if (part == 0) {
        work.solving = reached;
        if (reached) gather(model, state, exchange, input, work);
    } else if (work.solving) {
        if (part == 1)
            assemble(model, work);
        else if (part == 2)
            prepare(state, work);
        else if (part == 3)
            begin_field(work);
        else if (part < model.frame_ticks - 1)
            iterate_field(model, work, 1);
        else
            finish_field(model, state, work);
        if (part == model.frame_ticks - 2) weigh_field(work);
    }
    if (part == model.frame_ticks - 1) {
        // What was solved is no use when the metal has meanwhile left.
        if (!reached) state.field.solved = 0;
        work.solving = false;
    }
    drive_load(model, state, exchange, input);
}

void drive_load(const tissue::Model& model, tissue::State& state, tissue::Exchange& exchange,
                const tissue::Input& input) {
    const tissue::FieldState& field = state.field;
    const bool on = field.solved != 0;
    state.generator = drive(input, model.electric, on ? field.conductance_S() : 0.0);
    const double volt = on ? state.generator.voltage_V : 0.0,
                 volt2 = state.generator.current_A > 0.0 ? volt * volt : 0.0;
    tissue::JouleHeat& joule = exchange.joule;
    joule.density = {state.joule_S_per_m3.data(), state.joule_S_per_m3.size()};
    joule.place(model.hexels, state.field_low, Int3(volt2 > 0.0 ? model.electric.window_cells : 0));
    joule.scale = static_cast<float>(volt2);
    joule.total_W = field.tissue_S * volt2;
    joule.outflow_W = field.elsewhere_S * volt2;
    joule.wire_W = field.wire_S * volt2;
    for (std::size_t m = 0; m < tissue::kStrayMaterials; ++m) {
        tissue::StrayCurrent& stray = state.stray;
        stray.power_W[m] = state.stray_S[m] * volt2;
        stray.energy_J[m] += stray.power_W[m] * model.tick_s;
        stray.density_A_per_m2[m] = state.stray_density_S_per_m2[m] * std::sqrt(volt2);
        stray.highest_density_A_per_m2[m] = std::max(stray.highest_density_A_per_m2[m], stray.density_A_per_m2[m]);
    }
}

void solve_now(const tissue::Model& model, tissue::State& state, tissue::Exchange& exchange, const tissue::Input& input,
               Work& work) {
    state.field.solved = 0;
    if (any_reached(find_reach(model, state, exchange, input), exchange)) {
        gather(model, state, exchange, input, work);
        assemble(model, work);
        prepare(state, work);
        begin_field(work);
        iterate_field(model, work, model.electric.max_iterations);
        weigh_field(work);
        finish_field(model, state, work);
    }
    drive_load(model, state, exchange, input);
}

}  // namespace calot::electric

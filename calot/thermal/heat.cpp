#include "calot/thermal/heat.h"

#include <algorithm>
#include <cmath>

#include "calot/base/parallel.h"
#include "calot/base/units.h"
#include "calot/thermal/kernel.h"

namespace calot::thermal {

namespace {

/// Blocks per chunk of a parallel loop: some microseconds of work.
constexpr std::int64_t kBlocksPerChunk = 16;

/// The cells of a block.
struct Cells {
    std::int64_t begin, end;
};
Cells cells_of(const Lattice& lattice, std::int64_t block) {
    const std::int64_t begin = lattice.first + block * kBlockCells;
    return {begin, std::min(begin + kBlockCells, lattice.last)};
}

HeatStep make_step(const tissue::Model& model, tissue::State& state, Work& work, double dt_s) {
    const tissue::ThermalParameters& thermal = model.thermal;
    const double s = model.hexels.spacing_m;
    HeatStep step{};
    step.properties = &work.properties;
    step.material = model.hexel_material.data();
    step.group_material = work.group_material.data();
    step.present = state.hexel_present.bytes();
    step.held = model.hexel_held.bytes();
    for (int axis = 0; axis < 3; ++axis) step.offset[axis] = model.hexels.stride[axis];
    step.body_K = static_cast<float>(thermal.body_temperature_K);
    step.gas_K = static_cast<float>(thermal.gas_temperature_K);
    step.dt_s = static_cast<float>(dt_s);
    step.conduction_factor = static_cast<float>(dt_s / (s * s));
    step.surface_factor = static_cast<float>(dt_s / s);
    step.threshold = thermal.phase_model == tissue::PhaseModel::threshold;
    step.temperature_K = work.temperature_K.data();
    step.enthalpy_J_per_m3 = state.enthalpy_J_per_m3.data();
    step.water_kg_per_m3 = state.water_kg_per_m3.data();
    step.peak_temperature_K = state.peak_temperature_K.data();
    step.damage = state.damage.data();
    step.steam_kg_per_m3 = work.steam_kg_per_m3.data();
    return step;
}

/// The part of the window of the field that lies on the lattice, in array order: axes from slowest to fastest.
struct Window {
    int slow, middle, fast;  ///< axes
    Int3 low, high;          ///< hexel coordinates, high exclusive
    bool empty() const { return glm::any(glm::lessThanEqual(high, low)); }
};
Window joule_window(const Lattice& lattice, const tissue::JouleHeat& joule) {
    Window w{};
    w.fast = lattice.stride.x == 1 ? 0 : lattice.stride.y == 1 ? 1 : 2;
    w.middle = (w.fast + 1) % 3;
    w.slow = (w.fast + 2) % 3;
    if (lattice.stride[w.middle] > lattice.stride[w.slow]) std::swap(w.middle, w.slow);
    w.low = glm::max(joule.low, Int3(0));
    w.high = glm::min(joule.low + joule.size, lattice.size);
    return w;
}

/// Adds q dt to one plane of the window, tile by tile. Returns what was added [J/m^3].
double deposit_plane(const tissue::Model& model, const tissue::State& state, const HeatStep& step,
                     const tissue::JouleHeat& joule, const Window& w, int plane) {
    const Int3 source_stride = joule.stride;
    const std::ptrdiff_t fast_step = source_stride[w.fast], middle_step = source_stride[w.middle];
    double added = 0.0;
    Int3 cell = w.low;
    cell[w.slow] = plane;
    for (cell[w.middle] = w.low[w.middle]; cell[w.middle] < w.high[w.middle]; cell[w.middle] += kTile)
        for (cell[w.fast] = w.low[w.fast]; cell[w.fast] < w.high[w.fast]; cell[w.fast] += kTile) {
            const int rows = std::min(kTile, w.high[w.middle] - cell[w.middle]);
            const int columns = std::min(kTile, w.high[w.fast] - cell[w.fast]);
            const std::int64_t first = model.hexels.index(cell), stride = model.hexels.stride[w.middle];
            std::uint32_t present = 0;
            for (int row = 0; row < rows; ++row) present |= state.hexel_present.bits32(first + row * stride);
            if ((present & ((1u << columns) - 1u)) == 0) continue;
            const float* source = joule.density_W_per_m3.data() + joule.index(cell);
            alignas(64) HeatTile tile = {};
            for (int k = 0; k < columns; ++k)
                for (int row = 0; row < rows; ++row) tile[row][k] = source[k * fast_step + row * middle_step];
            added += deposit_tile(step, tile, first, stride, rows, columns);
        }
    return added;
}

void deposit_joule_heat(const tissue::Model& model, tissue::State& state, const tissue::Exchange& exchange, Work& work,
                        const HeatStep& step) {
    const tissue::JouleHeat& joule = exchange.joule;
    const Window w = joule_window(model.hexels, joule);
    if (w.empty()) return;
    const std::int64_t low = w.low[w.slow], high = w.high[w.slow];
    parallel_for("thermal.joule", low, high, 8, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t plane = begin; plane < end; ++plane)
            work.plane_sums[static_cast<std::size_t>(plane)] =
                deposit_plane(model, state, step, joule, w, static_cast<int>(plane));
    });
    double added = 0.0;
    for (std::int64_t plane = low; plane < high; ++plane) added += work.plane_sums[static_cast<std::size_t>(plane)];
    const double outflow_J = joule.outflow_W * static_cast<double>(step.dt_s);
    state.energy_J.outflow += outflow_J;
    state.energy_J.delivered += added * model.hexel_volume_m3() + outflow_J;
}

/// Blocks that share a face with cells of a block, itself included.
void activate_around(const Lattice& lattice, std::int64_t block, std::vector<std::uint8_t>& active) {
    const Cells cells = cells_of(lattice, block);
    const auto blocks = static_cast<std::int64_t>(active.size());
    for (int axis = 0; axis < 3; ++axis)
        for (const std::int64_t offset : {-std::int64_t{lattice.stride[axis]}, std::int64_t{lattice.stride[axis]}}) {
            const std::int64_t low = std::max<std::int64_t>(cells.begin + offset - lattice.first, 0) / kBlockCells;
            const std::int64_t high = std::min((cells.end - 1 + offset - lattice.first) / kBlockCells, blocks - 1);
            for (std::int64_t b = low; b <= high; ++b) active[static_cast<std::size_t>(b)] = 1;
        }
    active[static_cast<std::size_t>(block)] = 1;
}

/// Sets Work::blocks: warm blocks and their neighbours, and those that Joule heat reaches.
void find_active_blocks(const tissue::Model& model, const tissue::Exchange& exchange, const HeatStep& step,
                        Work& work) {
    const Lattice& lattice = model.hexels;
    const auto blocks = static_cast<std::int64_t>(work.warm.size());
    parallel_for("thermal.warm", 0, blocks, 4 * kBlocksPerChunk, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t b = begin; b < end; ++b) {
            std::uint8_t& warm = work.warm[static_cast<std::size_t>(b)];
            const Cells cells = cells_of(lattice, b);
            if (warm != 0) warm = is_warm(step, cells.begin, cells.end) ? 1 : 0;
        }
    });
    std::fill(work.active.begin(), work.active.end(), std::uint8_t{work.dense});
    for (std::int64_t b = 0; b < blocks; ++b)
        if (work.warm[static_cast<std::size_t>(b)] != 0) activate_around(lattice, b, work.active);
    const Window w = joule_window(lattice, exchange.joule);
    for (int plane = w.low[w.slow]; !w.empty() && plane < w.high[w.slow]; ++plane) {
        Int3 low = w.low, high = w.high - 1;
        low[w.slow] = high[w.slow] = plane;
        const std::int64_t first = (lattice.index(low) - lattice.first) / kBlockCells;
        const std::int64_t last = (lattice.index(high) - lattice.first) / kBlockCells;
        for (std::int64_t b = first; b <= last; ++b) work.active[static_cast<std::size_t>(b)] = 1;
    }
    work.blocks.clear();
    for (std::int64_t b = 0; b < blocks; ++b)
        if (work.active[static_cast<std::size_t>(b)] != 0) work.blocks.push_back(static_cast<std::int32_t>(b));
}

/// Calls body(begin, end, sums) for the cells of every active block.
template <class Body>
void for_active_blocks(const char* name, const Lattice& lattice, Work& work, const Body& body) {
    parallel_for(name, 0, static_cast<std::int64_t>(work.blocks.size()), kBlocksPerChunk,
                 [&](std::int64_t begin, std::int64_t end) {
                     for (std::int64_t k = begin; k < end; ++k) {
                         const Cells cells = cells_of(lattice, work.blocks[static_cast<std::size_t>(k)]);
                         body(cells.begin, cells.end, work.sums[static_cast<std::size_t>(k)]);
                     }
                 });
}

/// One stable step of conduction and what follows from it.
void advance(const tissue::Model& model, tissue::State& state, const tissue::Exchange& exchange, Work& work,
             double dt_s) {
    const HeatStep step = make_step(model, state, work, dt_s);
    find_active_blocks(model, exchange, step, work);
    deposit_joule_heat(model, state, exchange, work, step);
    std::fill_n(work.sums.begin(), work.blocks.size(), BlockSums{});
    const auto conduct_kernel = work.scalar ? conduct_cells_scalar : conduct_cells;
    const auto settle_kernel = work.scalar ? settle_cells_scalar : settle_cells;
    for_active_blocks(
        "thermal.conduct", model.hexels, work,
        [&](std::int64_t begin, std::int64_t end, BlockSums& sums) { conduct_kernel(step, begin, end, sums); });
    for_active_blocks("thermal.settle", model.hexels, work, [&](std::int64_t begin, std::int64_t end, BlockSums& sums) {
        settle_kernel(step, begin, end, sums);
    });

    BlockSums total;
    for (std::size_t k = 0; k < work.blocks.size(); ++k) {
        const BlockSums& sums = work.sums[k];
        total.surface += sums.surface;
        total.perfusion += sums.perfusion;
        total.gas += sums.gas;
        total.latent += sums.latent;
        work.warm[static_cast<std::size_t>(work.blocks[k])] = 1;
        if (sums.bad_hexel >= 0 && state.status.ok) state.status = {false, "enthalpy", sums.bad_hexel, state.tick};
    }
    const double volume = model.hexel_volume_m3();
    state.energy_J.surface += total.surface * volume;
    state.energy_J.perfusion += total.perfusion * volume;
    state.energy_J.gas += total.gas * volume;
    state.energy_J.latent += total.latent * volume;
}

/// Steam of this step as GasEvents, in the order of the cells. Events beyond what Exchange has room for are dropped:
/// smoke then shows less, the energy is booked already.
void emit_steam(const tissue::Model& model, const tissue::State& state, tissue::Exchange& exchange, Work& work,
                std::size_t k) {
    const Cells cells = cells_of(model.hexels, work.blocks[k]);
    for (std::int64_t i = cells.begin; i < cells.end; ++i) {
        float& steam = work.steam_kg_per_m3[static_cast<std::size_t>(i)];
        if (steam == 0.0f) continue;
        if (state.hexel_present.test(i) && exchange.gas.size() < exchange.gas.capacity())
            exchange.gas.push_back({i, static_cast<float>(static_cast<double>(steam) * model.hexel_volume_m3()), 0.0f,
                                    static_cast<float>(model.thermal.boiling_temperature_K)});
        steam = 0.0f;
    }
}

}  // namespace

Work make_work(const tissue::Model& model, const tissue::State& state) {
    const Lattice& lattice = model.hexels;
    const auto cells = static_cast<std::size_t>(lattice.cells);
    const auto blocks = static_cast<std::size_t>((lattice.last - lattice.first + kBlockCells - 1) / kBlockCells);
    Work work;
    work.properties = Properties::make(model);
    work.group_material = group_materials(model);
    work.temperature_K.assign(cells, static_cast<float>(model.thermal.body_temperature_K));
    work.steam_kg_per_m3.assign(cells, 0.0f);
    for (std::int64_t i = lattice.first; i < lattice.last; ++i)
        if (state.hexel_present.test(i))
            work.temperature_K[static_cast<std::size_t>(i)] = temperature_K(model, state, i);
    work.warm.assign(blocks, 1);  // looked at again before they are used
    work.active.assign(blocks, 0);
    work.blocks.reserve(blocks);
    work.sums.resize(blocks);
    work.plane_sums.resize(static_cast<std::size_t>(std::max({lattice.size.x, lattice.size.y, lattice.size.z})));
    const double step_s = model.tick_s * model.thermal.refresh_ticks;
    work.substeps =
        std::max(1, static_cast<int>(std::ceil(step_s / static_cast<double>(work.properties.longest_step_s))));
    return work;
}

void conduct(const tissue::Model& model, tissue::State& state, tissue::Exchange& exchange, Work& work) {
    if (state.tick % model.thermal.refresh_ticks != 0) return;
    const double dt_s = model.tick_s * model.thermal.refresh_ticks / work.substeps;
    for (int k = 0; k < work.substeps; ++k) {
        advance(model, state, exchange, work, dt_s);
        for (std::size_t b = 0; b < work.blocks.size(); ++b)
            if (work.sums[b].boiled) emit_steam(model, state, exchange, work, b);
    }
}

void remove_vaporised(const tissue::Model& model, tissue::State& state, tissue::Exchange& exchange, Work& work) {
    const Properties& p = work.properties;
    const bool threshold = model.thermal.phase_model == tissue::PhaseModel::threshold;
    const double volume = model.hexel_volume_m3();
    for (std::size_t k = 0; k < work.blocks.size(); ++k) {
        if (!work.sums[k].spent) continue;
        work.sums[k].spent = false;
        const Cells cells = cells_of(model.hexels, work.blocks[k]);
        for (std::int64_t i = cells.begin; i < cells.end; ++i) {
            const auto h = static_cast<std::size_t>(i);
            const tissue::MaterialIndex m = model.hexel_material[h];
            float& enthalpy = state.enthalpy_J_per_m3[h];
            if (!state.hexel_present.test(i) || enthalpy < p.spent_J_per_m3[m]) continue;
            if (!threshold && state.water_kg_per_m3[h] > 0.0f) continue;
            state.hexel_present.clear(i);
            ++state.hexels_burnt;
            state.energy_J.gas += static_cast<double>(enthalpy) * volume;
            state.energy_J.latent += static_cast<double>(p.spent_J_per_m3[m] - p.plateau_J_per_m3[m]) * volume;
            // With a threshold, water leaves together with the solids.
            const double steam = threshold ? static_cast<double>(p.water_kg_per_m3[m]) : 0.0;
            exchange.removed_hexels.push_back(i);
            if (exchange.gas.size() < exchange.gas.capacity())
                exchange.gas.push_back({i, static_cast<float>(steam * volume),
                                        static_cast<float>(static_cast<double>(p.solids_kg_per_m3[m]) * volume),
                                        work.temperature_K[h]});
            enthalpy = 0.0f;
            state.water_kg_per_m3[h] = 0.0f;
            work.temperature_K[h] = static_cast<float>(model.thermal.body_temperature_K);
        }
    }
}

double stored_J(const tissue::Model& model, const tissue::State& state) {
    double sum = 0.0;
    for (std::int64_t i = model.hexels.first; i < model.hexels.last; ++i)
        if (state.hexel_present.test(i))
            sum += static_cast<double>(state.enthalpy_J_per_m3[static_cast<std::size_t>(i)]);
    return sum * model.hexel_volume_m3();
}

}  // namespace calot::thermal

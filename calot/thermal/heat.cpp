#include "calot/thermal/heat.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "calot/base/parallel.h"
#include "calot/thermal/axes.h"
#include "calot/thermal/kernel.h"
#include "calot/thermal/tip.h"

namespace calot::thermal {

namespace {

/// Blocks per chunk of a parallel loop: some microseconds of work.
constexpr std::int64_t kBlocksPerChunk = 32;

JouleRows joule_rows(const Lattice& lattice, const tissue::JouleHeat& joule, double dt_s) {
    JouleRows rows{};
    if (joule.size == Int3(0)) return rows;
    const Axes axes = axes_of(lattice);
    const int order[3] = {axes.fast, axes.middle, axes.slow};
    rows.density = joule.density.data();
    rows.scaled_dt_s = static_cast<float>(static_cast<double>(joule.scale) * dt_s);
    for (int k = 0; k < 3; ++k) {
        rows.low[k] = joule.low[order[k]];
        rows.size[k] = joule.size[order[k]];
    }
    rows.row_cells = lattice.stride[axes.middle];
    rows.plane_rows = lattice.stride[axes.slow] / lattice.stride[axes.middle];
    rows.first = lattice.first;
    return rows;
}

HeatStep make_step(const tissue::Model& model, tissue::State& state, const tissue::Exchange& exchange, Work& work,
                   double dt_s) {
    const tissue::ThermalParameters& thermal = model.thermal;
    const double s = model.hexels.spacing_m;
    HeatStep step{};
    step.properties = &work.properties;
    step.material = model.hexel_material.data();
    step.group_material = work.group_material.data();
    step.present = work.present.bytes();
    step.living = state.hexel_present.bytes();
    step.held = model.hexel_held.bytes();
    for (int axis = 0; axis < 3; ++axis) step.offset[axis] = model.hexels.stride[axis];
    step.body_K = static_cast<float>(thermal.body_temperature_K);
    step.gas_K = static_cast<float>(thermal.gas_temperature_K);
    step.dt_s = static_cast<float>(dt_s);
    step.conduction_factor = static_cast<float>(dt_s / (s * s));
    step.surface_factor = static_cast<float>(dt_s / s);
    step.threshold = thermal.phase_model == tissue::PhaseModel::threshold;
    step.joule = joule_rows(model.hexels, exchange.joule, dt_s);
    step.temperature_K = work.temperature_K.data();
    step.next_temperature_K = work.next_temperature_K.data();
    step.enthalpy_J_per_m3 = state.enthalpy_J_per_m3.data();
    step.water_kg_per_m3 = state.water_kg_per_m3.data();
    step.peak_temperature_K = state.peak_temperature_K.data();
    step.damage = state.damage.data();
    step.steam_kg_per_m3 = work.steam_kg_per_m3.data();
    return step;
}

/// Calls body(word) for the words of bit arrays over hexels that hold cells of `blocks`.
template <class Body>
void for_words(const Lattice& lattice, const BlockSet& blocks, const Body& body) {
    static_assert(kBlockCells % 64 == 0);  // and Lattice::first is a multiple of 64
    for (std::size_t k = 0; k < blocks.words(); ++k)
        for (std::uint64_t bits = blocks.word(k); bits != 0; bits &= bits - 1) {
            const Cells cells = cells_of(lattice, static_cast<std::int64_t>(64 * k) + __builtin_ctzll(bits));
            for (std::int64_t i = cells.begin; i < cells.end; i += 64) body(static_cast<std::size_t>(i / 64));
        }
}

void begin_step(const tissue::Model& model, tissue::State& state, const tissue::Exchange& exchange, Work& work,
                double dt_s) {
    std::swap(work.heated, work.active);
    dilate(model.hexels, work.warm, work.active);
    add_heated(model.hexels, exchange.joule, work.active);
    if (work.dense) work.active = work.populated;  // of equal size: no allocation
    work.active.keep(work.populated);
    exchange_with_tip(model, state, exchange, work, dt_s);
    // Beyond active blocks nothing flows, whatever is there.
    for_words(model.hexels, work.active,
              [&](std::size_t w) { work.present.words()[w] = state.hexel_present.words()[w]; });
    work.burnt.clear();
    work.fallen = state.hexels_fallen;
}

/// Sets Work::turn: blocks of slice `slice` that take part, or rest for the first time. A slice takes every fourth
/// stretch of 64 blocks: long enough for memory to be read ahead, short enough for the hot region to be shared out.
void take_turns(Work& work, int slice) {
    work.turn.clear();
    const auto slices = static_cast<std::size_t>(work.slices);
    for (auto k = static_cast<std::size_t>(slice); k < work.active.words(); k += slices)
        for (std::uint64_t bits = work.active.word(k) | work.heated.word(k); bits != 0; bits &= bits - 1)
            work.turn.push_back(static_cast<std::int32_t>(64 * k + static_cast<std::size_t>(__builtin_ctzll(bits))));
}

void run_block(const HeatStep& step, const Lattice& lattice, Work& work, std::size_t k) {
    const std::int64_t block = work.turn[k];
    const Cells cells = cells_of(lattice, block);
    BlockSums& sums = work.sums[k] = {};
    if (!work.active.test(block)) {  // at rest: both arrays are at body temperature from now on
        std::copy(step.temperature_K + cells.begin, step.temperature_K + cells.end,
                  step.next_temperature_K + cells.begin);
        return;
    }
    if (step.joule.density != nullptr)
        (work.scalar ? deposit_cells_scalar : deposit_cells)(step, cells.begin, cells.end, sums);
    (work.scalar ? step_cells_scalar : step_cells)(step, cells.begin, cells.end, work.pristine.test(block), sums);
}

/// Steam of this tick as GasEvents, in the order of the cells. Events beyond what Exchange has room for are dropped:
/// smoke then shows less, the energy is booked already.
void emit_steam(const tissue::Model& model, const tissue::State& state, tissue::Exchange& exchange, Work& work,
                std::int64_t block) {
    const Cells cells = cells_of(model.hexels, block);
    for (std::int64_t i = cells.begin; i < cells.end; ++i) {
        float& steam = work.steam_kg_per_m3[static_cast<std::size_t>(i)];
        if (steam == 0.0f) continue;
        if (state.hexel_present.test(i) && exchange.gas.size() < exchange.gas.capacity())
            exchange.gas.push_back({i, static_cast<float>(static_cast<double>(steam) * model.hexel_volume_m3()), 0.0f,
                                    static_cast<float>(model.thermal.boiling_temperature_K)});
        steam = 0.0f;
    }
}

/// Books what the blocks of this tick did, in their order.
void book(const tissue::Model& model, tissue::State& state, tissue::Exchange& exchange, Work& work) {
    BlockSums total;
    for (std::size_t k = 0; k < work.turn.size(); ++k) {
        const BlockSums& sums = work.sums[k];
        const std::int64_t block = work.turn[k];
        total.delivered += sums.delivered;
        total.conducted += sums.conducted;
        total.surface += sums.surface;
        total.perfusion += sums.perfusion;
        total.gas += sums.gas;
        total.latent += sums.latent;
        sums.warm ? work.warm.set(block) : work.warm.clear(block);
        if (sums.hot) work.pristine.clear(block);
        if (sums.spent) work.spent_blocks.set(block);
        if (sums.bad_hexel >= 0 && state.status.ok) state.status = {false, "enthalpy", sums.bad_hexel, state.tick};
        if (sums.boiled) emit_steam(model, state, exchange, work, block);
    }
    const double volume = model.hexel_volume_m3();
    tissue::EnergyBudget& energy = state.energy_J;
    energy.delivered += total.delivered * volume;
    energy.surface += total.surface * volume;
    energy.perfusion += total.perfusion * volume;
    energy.gas += total.gas * volume;
    energy.latent += total.latent * volume;
    energy.transit -= total.conducted * volume;
}

void run_slice(const tissue::Model& model, tissue::State& state, tissue::Exchange& exchange, Work& work, double dt_s,
               int slice) {
    const HeatStep step = make_step(model, state, exchange, work, dt_s);
    take_turns(work, slice);
    parallel_for("thermal.step", 0, static_cast<std::int64_t>(work.turn.size()), kBlocksPerChunk,
                 [&](std::int64_t begin, std::int64_t end) {
                     for (std::int64_t k = begin; k < end; ++k)
                         run_block(step, model.hexels, work, static_cast<std::size_t>(k));
                 });
    book(model, state, exchange, work);
}

/// Hexels that vanished since the step began have gone on exchanging heat. What that left in them went with them.
void book_leftovers(const tissue::Model& model, tissue::State& state, Work& work) {
    const double volume = model.hexel_volume_m3();
    auto take = [&](std::int64_t hexel) {
        float& enthalpy = state.enthalpy_J_per_m3[static_cast<std::size_t>(hexel)];
        const double left_J = static_cast<double>(enthalpy) * volume;
        enthalpy = 0.0f;
        return left_J;
    };
    for (const std::int32_t hexel : work.burnt) state.energy_J.gas += take(hexel);
    if (state.hexels_fallen == work.fallen) return;
    for_words(model.hexels, work.active, [&](std::size_t w) {
        std::uint64_t gone = work.present.words()[w] & ~state.hexel_present.words()[w];
        for (; gone != 0; gone &= gone - 1)
            state.energy_J.debris += take(static_cast<std::int64_t>(64 * w) + __builtin_ctzll(gone));
    });
}

/// Whether a present hexel's latent budget is used up: it is gas.
bool is_spent(const tissue::Model& model, const tissue::State& state, const Properties& p, std::int64_t hexel) {
    const auto h = static_cast<std::size_t>(hexel);
    if (state.enthalpy_J_per_m3[h] < p.spent_J_per_m3[model.hexel_material[h]]) return false;
    return model.thermal.phase_model == tissue::PhaseModel::threshold || state.water_kg_per_m3[h] == 0.0f;
}

/// Fills Work::spent from blocks in which something turned to gas.
void find_spent(const tissue::Model& model, const tissue::State& state, Work& work) {
    work.spent.clear();
    for (std::size_t k = 0; k < work.spent_blocks.words(); ++k)
        for (std::uint64_t bits = work.spent_blocks.word(k); bits != 0; bits &= bits - 1) {
            const auto block = static_cast<std::int64_t>(64 * k) + __builtin_ctzll(bits);
            work.spent_blocks.clear(block);
            const Cells cells = cells_of(model.hexels, block);
            for (std::int64_t i = cells.begin; i < cells.end; ++i)
                if (state.hexel_present.test(i) && is_spent(model, state, work.properties, i))
                    work.spent.push_back(static_cast<std::int32_t>(i));
        }
}

void finish_step(const tissue::Model& model, tissue::State& state, Work& work) {
    std::swap(work.temperature_K, work.next_temperature_K);
    book_leftovers(model, state, work);
    state.energy_J.transit = 0.0;  // up to rounding
    find_spent(model, state, work);
}

/// What Work says of a block, from State.
void look_at_block(const tissue::Model& model, const tissue::State& state, Work& work, std::int64_t block) {
    const auto body_K = static_cast<float>(model.thermal.body_temperature_K);
    const Cells cells = cells_of(model.hexels, block);
    bool warm = false, pristine = model.thermal.phase_model != tissue::PhaseModel::threshold, spent = false;
    for (std::int64_t i = cells.begin; i < cells.end; ++i) {
        const auto h = static_cast<std::size_t>(i);
        const float alive = work.properties.water_kg_per_m3[model.hexel_material[h]];
        pristine &= state.damage[h] == 0.0f;
        if (!state.hexel_present.test(i)) continue;
        work.temperature_K[h] = temperature_K(model, state, i);
        warm |= work.temperature_K[h] != body_K;
        pristine &= state.water_kg_per_m3[h] == alive;
        spent |= is_spent(model, state, work.properties, i);
    }
    if (warm) work.warm.set(block);
    if (pristine) work.pristine.set(block);
    if (spent) work.spent_blocks.set(block);
}

}  // namespace

Work make_work(const tissue::Model& model, const tissue::State& state) {
    const Lattice& lattice = model.hexels;
    const auto cells = static_cast<std::size_t>(lattice.cells);
    const std::int64_t blocks = block_count(lattice);
    Work work;
    work.properties = Properties::make(model);
    work.group_material = group_materials(model);
    work.temperature_K.assign(cells, static_cast<float>(model.thermal.body_temperature_K));
    work.steam_kg_per_m3.assign(cells, 0.0f);
    work.present = state.hexel_present;
    work.populated = populated_blocks(model);
    for (BlockSet* set : {&work.active, &work.warm, &work.heated, &work.pristine, &work.spent_blocks})
        *set = BlockSet(blocks);
    for (std::int64_t b = 0; b < blocks; ++b)
        if (work.populated.test(b)) look_at_block(model, state, work, b);
    work.next_temperature_K = work.temperature_K;
    const double step_s = model.tick_s * model.thermal.refresh_ticks;
    work.substeps =
        std::max(1, static_cast<int>(std::ceil(step_s / static_cast<double>(work.properties.longest_step_s))));
    work.slices = work.substeps == 1 ? model.thermal.refresh_ticks : 1;
    work.turn.reserve(static_cast<std::size_t>(blocks));
    work.sums.resize(static_cast<std::size_t>(blocks));
    work.spent.reserve(static_cast<std::size_t>(model.hexel_initial.count()));
    work.burnt.reserve(work.spent.capacity());
    work.sticks.reserve(work.spent.capacity());
    find_spent(model, state, work);
    return work;
}

void conduct(const tissue::Model& model, tissue::State& state, tissue::Exchange& exchange, Work& work) {
    const auto tick = static_cast<int>(state.tick % model.thermal.refresh_ticks);
    if (exchange.joule.size != Int3(0)) {
        const double outflow_J = exchange.joule.outflow_W * model.tick_s;
        state.energy_J.outflow += outflow_J;
        state.energy_J.delivered += outflow_J;
    }
    const double dt_s = model.tick_s * model.thermal.refresh_ticks / work.substeps;
    for (int substep = 0; substep < work.substeps; ++substep) {
        if (work.slices == 1 && tick != 0) return;
        if (tick == 0) begin_step(model, state, exchange, work, dt_s);
        run_slice(model, state, exchange, work, dt_s, work.slices == 1 ? 0 : tick);
        if (tick == work.slices - 1) finish_step(model, state, work);
    }
}

void remove_vaporised(const tissue::Model& model, tissue::State& state, tissue::Exchange& exchange, Work& work) {
    const Properties& p = work.properties;
    const bool threshold = model.thermal.phase_model == tissue::PhaseModel::threshold;
    const double volume = model.hexel_volume_m3();
    // Crumbs may have taken some along.
    work.spent.erase(std::remove_if(work.spent.begin(), work.spent.end(),
                                    [&](std::int32_t hexel) { return !state.hexel_present.test(hexel); }),
                     work.spent.end());
    if (work.spent.empty()) return;
    // They were found in the last tick of a step, the first of this count, and go before the last tick of the next.
    const auto tick = static_cast<std::size_t>((state.tick + 1) % model.thermal.refresh_ticks);
    const std::size_t ticks_left = work.slices == 1 ? 1 : static_cast<std::size_t>(model.thermal.refresh_ticks) - tick;
    const std::size_t count = (work.spent.size() + ticks_left - 1) / ticks_left;
    stick_char(model, state, exchange, work, count);
    for (std::size_t k = 0; k < count; ++k) {
        const std::int32_t hexel = work.spent[k];
        const auto h = static_cast<std::size_t>(hexel);
        const tissue::MaterialIndex m = model.hexel_material[h];
        float& enthalpy = state.enthalpy_J_per_m3[h];
        state.hexel_present.clear(hexel);
        ++state.hexels_burnt;
        state.energy_J.gas += static_cast<double>(enthalpy) * volume;
        state.energy_J.latent += static_cast<double>(p.spent_J_per_m3[m] - p.plateau_J_per_m3[m]) * volume;
        // With a threshold, water leaves together with the solids.
        const double steam = threshold ? static_cast<double>(p.water_kg_per_m3[m]) : 0.0;
        exchange.removed_hexels.push_back(hexel);
        work.burnt.push_back(hexel);
        const double smoke = static_cast<double>(p.solids_kg_per_m3[m]) * (1.0 - static_cast<double>(work.sticks[k]));
        if (exchange.gas.size() < exchange.gas.capacity())
            exchange.gas.push_back({hexel, static_cast<float>(steam * volume), static_cast<float>(smoke * volume),
                                    static_cast<float>(model.thermal.body_temperature_K) + p.dry_limit_K[m]});
        enthalpy = 0.0f;
        state.water_kg_per_m3[h] = 0.0f;
    }
    work.spent.erase(work.spent.begin(), work.spent.begin() + static_cast<std::ptrdiff_t>(count));
}

double stored_J(const tissue::Model& model, const tissue::State& state) {
    double sum = 0.0;
    for (std::int64_t i = model.hexels.first; i < model.hexels.last; ++i)
        if (state.hexel_present.test(i))
            sum += static_cast<double>(state.enthalpy_J_per_m3[static_cast<std::size_t>(i)]);
    return sum * model.hexel_volume_m3();
}

}  // namespace calot::thermal

#include "calot/thermal/heat.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstring>

#include "calot/base/parallel.h"
#include "calot/thermal/axes.h"
#include "calot/thermal/kernel.h"
#include "calot/thermal/tip.h"

namespace calot::thermal {

namespace {

/// Blocks per chunk of a parallel loop: some tens of microseconds of work, which a task's start costs a few of.
constexpr std::int64_t kChunkBlocks = 4 * kRunBlocks;
/// Of hexels that are gas, this part goes in a tick, rounded up: few at a time, so that what follows is not too much for
/// one tick, and soon, so that the metal is not kept waiting.
constexpr std::size_t kSpentTicks = 4;
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
    HeatStep step{};
    step.properties = &work.properties;
    step.material = model.hexel_material.data();
    step.groups = work.groups.groups.data();
    step.faces = work.groups.faces.data();
    step.share = work.groups.share.data();
    step.living = state.hexel_present.bytes();
    step.active = &work.active_groups;
    step.first = model.hexels.first;
    step.last = model.hexels.last;
    for (int axis = 0; axis < 3; ++axis) step.offset[axis] = model.hexels.stride[axis];
    step.furthest = std::max({step.offset[0], step.offset[1], step.offset[2]});
    step.body_K = static_cast<float>(thermal.body_temperature_K);
    step.gas_K = static_cast<float>(thermal.gas_temperature_K);
    step.dt_s = static_cast<float>(dt_s);
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

/// Bytes of ones for the bits of a byte.
constexpr std::array<std::uint64_t, 256> kByteMasks = [] {
    std::array<std::uint64_t, 256> masks{};
    for (std::uint64_t bits = 0; bits < 256; ++bits)
        for (unsigned k = 0; k < 8; ++k)
            if (bits >> k & 1) masks[bits] |= std::uint64_t{0xff} << (8 * k);
    return masks;
}();

/// What some groups of a block cost.
unsigned cost_of(const tissue::Model& model, const Work& work, std::int64_t block, std::uint16_t some) {
    const std::uint8_t* cost = work.groups.cost.data() + cells_of(model.hexels, block).begin / kGroupCells;
    std::uint64_t low, high;
    std::memcpy(&low, cost, sizeof(low));
    std::memcpy(&high, cost + 8, sizeof(high));
    const std::uint64_t both = (low & kByteMasks[some & 0xff]) + (high & kByteMasks[some >> 8]);  // no byte runs over
    return static_cast<unsigned>(both * 0x0101010101010101u >> 56);
}

/// Notes which hexels went during the last step.
void look_at_presence(const tissue::Model& model, const tissue::State& state, Work& work) {
    const auto note = [&](std::int64_t hexel) {
        work.present.clear(hexel);
        work.groups.touch(model.hexels, hexel);
    };
    for (const std::int32_t hexel : work.burnt) note(hexel);
    if (state.hexels_fallen != work.fallen) {
        const Array<std::uint64_t>&before = work.present.words(), &now = state.hexel_present.words();
        for (std::size_t w = 0; w < now.size(); ++w)
            for (std::uint64_t gone = before[w] & ~now[w]; gone != 0; gone &= gone - 1)
                note(static_cast<std::int64_t>(64 * w) + __builtin_ctzll(gone));
    }
    work.groups.refresh(model, state.hexel_present);
}

/// How much of a step is done before each tick, of 48: less in those that are long for the electric field, for what the
/// step begins with, or for the surface.
constexpr std::array<std::uint64_t, 9> kDoneBefore{0, 3, 11, 17, 24, 30, 35, 40, 48};

/// Shares the active blocks out to the ticks of the step. Only the groups of `counted` count as work.
void plan_turns(const tissue::Model& model, Work& work, const BlockSet& counted) {
    work.turns.clear();
    work.costs.clear();
    std::uint64_t all = 0;
    for (std::size_t k = 0; k < work.active.words(); ++k)
        for (std::uint64_t bits = work.active.word(k); bits != 0; bits &= bits - 1) {
            const std::int32_t block = static_cast<std::int32_t>(64 * k) + __builtin_ctzll(bits);
            work.turns.push_back(block);
            work.costs.push_back(static_cast<std::uint8_t>(cost_of(model, work, block, counted.groups_of(block))));
            all += work.costs.back();
        }
    const std::size_t slices = work.slices.size() - 1;
    const bool framed = slices + 1 == kDoneBefore.size();
    const std::uint64_t parts = framed ? kDoneBefore.back() : slices;
    const auto before = [&](std::size_t slice) { return framed ? kDoneBefore[slice] : std::uint64_t{slice}; };
    std::uint64_t sum = 0;
    std::size_t slice = 0;
    for (std::size_t k = 0; k < work.turns.size(); ++k) {
        for (; slice < slices && sum * parts >= before(slice) * all; ++slice) work.slices[slice] = k;
        sum += work.costs[k];
    }
    for (; slice <= slices; ++slice) work.slices[slice] = work.turns.size();
}

/// Groups that rest for the first time: both arrays are at body temperature from now on.
void put_to_rest(const Lattice& lattice, Work& work) {
    for (std::size_t k = 0; k < work.heated.words(); ++k)
        for (std::uint64_t bits = work.heated.word(k) & ~work.active_groups.word(k); bits != 0; bits &= bits - 1) {
            const auto group = static_cast<std::int64_t>(64 * k) + __builtin_ctzll(bits);
            const std::int64_t begin = lattice.first + group * kGroupCells;
            std::copy_n(work.temperature_K.begin() + begin, std::min<std::int64_t>(kGroupCells, lattice.last - begin),
                        work.next_temperature_K.begin() + begin);
        }
}

/// Adds the groups that Joule heat reaches to `groups`.
void add_heated(const tissue::Model& model, const tissue::JouleHeat& joule, Work& work, BlockSet& groups) {
    work.joule_low = joule.low;
    work.joule_size = joule.size;
    add_heated(model.hexels, joule, groups);
}

/// Current that came, or whose window moved, since the step began: it heats what takes part in the step.
void add_late_heat(const tissue::Model& model, const tissue::JouleHeat& joule, Work& work) {
    if (joule.size == Int3(0) || (joule.low == work.joule_low && joule.size == work.joule_size)) return;
    work.late.clear();
    add_heated(model, joule, work, work.late);
    work.late.keep(work.populated_groups);
    for (const std::int32_t block : work.turns)
        work.active_groups.set_groups(
            block, static_cast<std::uint16_t>(work.active_groups.groups_of(block) | work.late.groups_of(block)));
}

void begin_step(const tissue::Model& model, tissue::State& state, const tissue::Exchange& exchange, Work& work,
                double dt_s) {
    look_at_presence(model, state, work);
    std::swap(work.heated, work.active_groups);
    dilate(model.hexels, work.warm, kGroupCells, work.active_groups);
    add_heated(model, exchange.joule, work, work.active_groups);
    work.active_groups.keep(work.populated_groups);
    exchange_with_tip(model, state, exchange, work, dt_s);
    if (work.dense) {
        const BlockSet counted = work.active_groups;
        work.active_groups = work.populated_groups;
        find_blocks(work.active_groups, work.active);
        plan_turns(model, work, counted);
    } else {
        find_blocks(work.active_groups, work.active);
        plan_turns(model, work, work.active_groups);
    }
    put_to_rest(model.hexels, work);
    work.burnt.clear();
    work.fallen = state.hexels_fallen;
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

/// Whether a present hexel's latent budget is used up: it is gas.
bool is_spent(const tissue::Model& model, const tissue::State& state, const Properties& p, std::int64_t hexel) {
    const auto h = static_cast<std::size_t>(hexel);
    if (state.enthalpy_J_per_m3[h] < p.spent_J_per_m3[model.hexel_material[h]]) return false;
    return model.thermal.phase_model == tissue::PhaseModel::threshold || state.water_kg_per_m3[h] == 0.0f;
}

/// Adds hexels of a block that turned to gas to Work::spent, at its end.
void find_spent(const tissue::Model& model, const tissue::State& state, Work& work, std::int64_t block) {
    const auto waiting = static_cast<std::ptrdiff_t>(work.waiting);
    const Cells cells = cells_of(model.hexels, block);
    for (std::int64_t i = cells.begin; i < cells.end; ++i) {
        const auto hexel = static_cast<std::int32_t>(i);
        if (state.hexel_present.test(i) && is_spent(model, state, work.properties, i) &&
            !std::binary_search(work.spent.begin(), work.spent.begin() + waiting, hexel))
            work.spent.push_back(hexel);
    }
}

/// After kinds of its groups changed.
void weigh(const tissue::Model& model, Work& work, std::int64_t block) {
    const std::int64_t first = cells_of(model.hexels, block).begin / kGroupCells;
    for (std::int64_t group = first; group < first + kBlockGroups; ++group) work.groups.weigh(group);
}

/// Books what the blocks [begin, end) of Work::turns did, in their order.
void book(const tissue::Model& model, tissue::State& state, tissue::Exchange& exchange, Work& work, std::size_t begin,
          std::size_t end) {
    work.waiting = work.spent.size();
    for (std::size_t k = begin; k < end; ++k) {
        const BlockMarks& marks = work.marks[k];
        const std::int64_t block = work.turns[k];
        work.warm.set_groups(block, marks.warm);
        if (marks.changed) weigh(model, work, block);
        if (marks.spent) find_spent(model, state, work, block);
        if (marks.boiled) emit_steam(model, state, exchange, work, block);
    }
    std::sort(work.spent.begin(), work.spent.end());
    HeatSums total;
    for (const HeatSums& sums : work.sums) {
        total.delivered += sums.delivered;
        total.conducted += sums.conducted;
        total.surface += sums.surface;
        total.perfusion += sums.perfusion;
        total.gas += sums.gas;
        total.latent += sums.latent;
        if (sums.bad_hexel >= 0 && state.status.ok) state.status = {false, "enthalpy", sums.bad_hexel, state.tick};
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
               std::size_t slice) {
    const HeatStep step = make_step(model, state, exchange, work, dt_s);
    const std::size_t begin = work.slices[slice], end = work.slices[slice + 1];
    work.sums.assign((end - begin + kChunkBlocks - 1) / kChunkBlocks, {});  // within its capacity
    parallel_for("thermal.step", static_cast<std::int64_t>(begin), static_cast<std::int64_t>(end), kChunkBlocks,
                 [&](std::int64_t low, std::int64_t high) {
                     HeatSums& sums = work.sums[(static_cast<std::size_t>(low) - begin) / kChunkBlocks];
                     for (std::int64_t k = low; k < high; k += kRunBlocks)
                         (work.scalar ? step_blocks_scalar : step_blocks)(
                             step, work.turns.data() + k, static_cast<int>(std::min<std::int64_t>(kRunBlocks, high - k)),
                             work.marks.data() + k, sums);
                 });
    book(model, state, exchange, work, begin, end);
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

void finish_step(const tissue::Model& model, tissue::State& state, Work& work) {
    std::swap(work.temperature_K, work.next_temperature_K);
    book_leftovers(model, state, work);
    state.energy_J.transit = 0.0;  // up to rounding
    // What waits is now a function of State: those that cooled while they waited do not go.
    work.spent.erase(std::remove_if(work.spent.begin(), work.spent.end(),
                                    [&](std::int32_t hexel) {
                                        return !state.hexel_present.test(hexel) ||
                                               !is_spent(model, state, work.properties, hexel);
                                    }),
                     work.spent.end());
}

/// What Work says of a block, from State.
void look_at_block(const tissue::Model& model, const tissue::State& state, Work& work, std::int64_t block) {
    const auto body_K = static_cast<float>(model.thermal.body_temperature_K);
    const bool threshold = model.thermal.phase_model == tissue::PhaseModel::threshold;
    const Cells cells = cells_of(model.hexels, block);
    for (std::int64_t i = cells.begin; i < cells.end; ++i) {
        const auto h = static_cast<std::size_t>(i);
        CellGroup& group = work.groups.groups[h / kGroupCells];
        // With a threshold, water follows H.
        if (threshold || state.damage[h] != 0.0f) group.kind |= kChanged;
        if (!state.hexel_present.test(i)) continue;
        if (state.water_kg_per_m3[h] != work.properties.water_kg_per_m3[model.hexel_material[h]]) group.kind |= kChanged;
        work.temperature_K[h] = temperature_K(model, state, i);
        if (work.temperature_K[h] != body_K) work.warm.set((i - model.hexels.first) / kGroupCells);
        if (is_spent(model, state, work.properties, i)) work.spent.push_back(static_cast<std::int32_t>(i));
    }
    weigh(model, work, block);
}

}  // namespace

Work make_work(const tissue::Model& model, const tissue::State& state) {
    const Lattice& lattice = model.hexels;
    const auto cells = static_cast<std::size_t>(lattice.cells);
    const std::int64_t blocks = block_count(lattice);
    Work work;
    work.properties = Properties::make(model);
    work.groups = Groups::make(model, state.hexel_present);
    work.temperature_K.assign(cells, static_cast<float>(model.thermal.body_temperature_K));
    work.steam_kg_per_m3.assign(cells, 0.0f);
    work.present = state.hexel_present;
    work.populated = populated(model, kBlockCells);
    work.populated_groups = populated(model, kGroupCells);
    work.active = BlockSet(blocks);
    for (BlockSet* set : {&work.warm, &work.active_groups, &work.heated, &work.late})
        *set = BlockSet(blocks * kBlockGroups);
    work.spent.reserve(static_cast<std::size_t>(model.hexel_initial.count()));
    work.burnt.reserve(work.spent.capacity());
    work.sticks.reserve(work.spent.capacity());
    for (std::int64_t b = 0; b < blocks; ++b)
        if (work.populated.test(b)) look_at_block(model, state, work, b);
    work.next_temperature_K = work.temperature_K;
    const double step_s = model.tick_s * model.thermal.refresh_ticks;
    work.substeps =
        std::max(1, static_cast<int>(std::ceil(step_s / static_cast<double>(work.properties.longest_step_s))));
    work.properties.set_step(model, step_s / work.substeps);
    work.slices.assign(static_cast<std::size_t>(work.substeps == 1 ? model.thermal.refresh_ticks : 1) + 1, 0);
    work.turns.reserve(static_cast<std::size_t>(blocks));
    work.costs.reserve(static_cast<std::size_t>(blocks));
    work.marks.resize(static_cast<std::size_t>(blocks));
    work.sums.reserve(static_cast<std::size_t>(blocks / kChunkBlocks + 1));
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
    const int slices = static_cast<int>(work.slices.size()) - 1;
    for (int substep = 0; substep < work.substeps; ++substep) {
        if (tick >= slices) return;
        if (tick == 0)
            begin_step(model, state, exchange, work, dt_s);
        else
            add_late_heat(model, exchange.joule, work);
        run_slice(model, state, exchange, work, dt_s, static_cast<std::size_t>(tick));
        if (tick == slices - 1) finish_step(model, state, work);
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
    const std::size_t count = (work.spent.size() + kSpentTicks - 1) / kSpentTicks;
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

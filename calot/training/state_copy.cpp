#include "calot/training/state_copy.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>

namespace calot::training {

namespace {

/// 1 MB: 0.15 ms or so.
constexpr std::size_t kBlocksATick = 256;

std::array<Array<float>*, 4> over_hexels(tissue::State& state) {
    return {&state.enthalpy_J_per_m3, &state.water_kg_per_m3, &state.peak_temperature_K, &state.damage};
}

/// Fields of something that is only read.
tissue::State& readable(const tissue::State& state) {
    return const_cast<tissue::State&>(state);
}

}  // namespace

StateCopy::StateCopy(const tissue::State& initial) : state_(initial) {}

void StateCopy::start(const simulation::Simulation& run) {
    changed_ = thermal::BlockSet(thermal::block_count(run.model().hexels));
    whole_ = true;
}

void StateCopy::note(const simulation::Simulation& run, std::int64_t hexel) {
    changed_.set((hexel - run.model().hexels.first) / thermal::kBlockCells);
}

void StateCopy::after_tick(const simulation::Simulation& run) {
    if (!run.backend().keeps_host_current()) {
        whole_ = false;  // what changed is known to the device alone: the next copy is whole
        return;
    }
    if (!whole_ && run.state().tick == 1) start(run);  // from the initial state, which it holds
    if (!whole_) return;
    const thermal::Work& heat = run.work().thermal;
    const std::size_t ticks = heat.slices.size() - 1;
    const auto tick = static_cast<std::size_t>((run.state().tick - 1) % run.model().thermal.refresh_ticks);
    if (tick < ticks) {
        if (heat.substeps > 1)
            changed_.add_shifted(heat.populated, 0);  // the turns of the last one are all that is left
        for (std::size_t k = heat.slices[tick]; k < heat.slices[tick + 1]; ++k) changed_.set(heat.turns[k]);
    }
    for (const std::int64_t hexel : run.work().exchange.removed_hexels) {
        note(run, hexel);
        gone_.push_back(hexel);
    }
    if (tick + 1 != ticks) return;
    for (const std::int64_t hexel : gone_) note(run, hexel);
    gone_.clear();
}

void StateCopy::copy_blocks(const simulation::Simulation& run, std::size_t most) {
    const std::array<Array<float>*, 4> to = over_hexels(state_), from = over_hexels(readable(run.state()));
    for (std::size_t w = 0; w < changed_.words(); ++w)
        for (std::uint64_t bits = changed_.word(w); bits != 0; bits &= bits - 1) {
            if (most-- == 0) return;
            const std::int64_t block = static_cast<std::int64_t>(64 * w) + __builtin_ctzll(bits);
            const thermal::Cells cells = thermal::cells_of(run.model().hexels, block);
            for (std::size_t k = 0; k < to.size(); ++k)
                std::copy(from[k]->begin() + cells.begin, from[k]->begin() + cells.end, to[k]->begin() + cells.begin);
            changed_.clear(block);
        }
}

void StateCopy::go_on(const simulation::Simulation& run) {
    if (whole_) copy_blocks(run, kBlocksATick);
}

void StateCopy::bring_up_to_date(const simulation::Simulation& run) {
    if (!whole_) {
        state_ = run.state();
        start(run);
        return;
    }
    copy_blocks(run, std::numeric_limits<std::size_t>::max());
    const std::array<Array<float>*, 4> hexels = over_hexels(state_);
    const std::vector<tissue::Field> to = tissue::fields(state_), from = tissue::fields(readable(run.state()));
    for (std::size_t k = 0; k < to.size(); ++k)
        if (std::none_of(hexels.begin(), hexels.end(), [&](const auto* array) { return array->data() == to[k].data; }))
            std::memcpy(to[k].data, from[k].data, to[k].bytes);
    state_.status = run.state().status;
}

}  // namespace calot::training

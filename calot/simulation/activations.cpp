#include "calot/simulation/activations.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace calot::simulation {

namespace {

constexpr double kSettle_s = 1.0;

template <class Body>
void for_bits(const BitArray& bits, const Body& body) {
    for (std::size_t w = 0; w < bits.words().size(); ++w)
        for (std::uint64_t left = bits.words()[w]; left != 0; left &= left - 1)
            body(static_cast<std::int64_t>(64 * w) + __builtin_ctzll(left));
}

/// Removed hexels that have a neighbour left.
std::vector<Int3> edge_of(const Simulation& run, const BitArray& removed) {
    const Lattice& lattice = run.model().hexels;
    std::vector<Int3> cells;
    for_bits(removed, [&](std::int64_t hexel) {
        bool beside = false;
        for (const int step : {lattice.stride.x, lattice.stride.y, lattice.stride.z})
            beside |= run.figures().hexel_present.test(hexel - step) || run.figures().hexel_present.test(hexel + step);
        if (beside) cells.push_back(lattice.coordinates(hexel));
    });
    return cells;
}

std::vector<Int3> cells_of(const Lattice& lattice, const BitArray& bits) {
    std::vector<Int3> cells;
    for_bits(bits, [&](std::int64_t hexel) { cells.push_back(lattice.coordinates(hexel)); });
    return cells;
}

/// Square of the distance to the nearest of `places`, in cells.
int nearest(const Int3& cell, const std::vector<Int3>& places) {
    int least = std::numeric_limits<int>::max();
    for (const Int3& place : places) {
        const Int3 d = cell - place;
        least = std::min(least, d.x * d.x + d.y * d.y + d.z * d.z);
    }
    return least;
}

}  // namespace

ActivationWatch::ActivationWatch(const tissue::Model& model)
    : touched_(model.hexels.cells), removed_(model.hexels.cells), gone_(model.hexels.cells) {}

void ActivationWatch::look(const Simulation& run, const tissue::Input& input) {
    if (input.pedal && !down_) begin(run, input);
    last_energy_J_ = run.figures().energy_J.delivered;
    if (!input.pedal && down_) release(run);
    const tissue::Exchange& exchange = run.exchange();
    if (!pending_) {
        for (const std::int64_t hexel : exchange.removed_hexels) gone_.set(hexel);
        return;
    }
    for (const std::int64_t hexel : exchange.removed_hexels) {
        removed_.set(hexel);
        ++activations_.back().hexels_removed;
    }
    if (down_)
        for (const tissue::NearHexel& near : exchange.near)
            if (near.bare_gap_m <= static_cast<float>(run.model().electric.contact_gap_m)) touched_.set(near.hexel);
    if (!down_ && run.time_s() >= activations_.back().stop_s + kSettle_s) measure(run);
}

void ActivationWatch::finish(const Simulation& run) {
    if (down_) release(run);
    if (pending_) measure(run);
}

void ActivationWatch::begin(const Simulation& run, const tissue::Input& input) {
    if (pending_) measure(run);
    const tissue::State& state = run.state();
    Activation& now = activations_.emplace_back();
    now.start_s = run.time_s() - run.model().tick_s;  // this tick is the first
    now.mode = input.mode;
    now.power_setting_W = input.power_setting_W;
    peak_before_K_ = state.peak_temperature_K;
    damage_before_ = state.damage;
    energy_before_J_ = last_energy_J_;
    touched_ = removed_ = BitArray(run.model().hexels.cells);
    down_ = pending_ = true;
}

void ActivationWatch::release(const Simulation& run) {
    Activation& now = activations_.back();
    now.stop_s = run.time_s() - run.model().tick_s;
    now.energy_J = run.figures().energy_J.delivered - energy_before_J_;
    now.tip_temperature_K = run.figures().tip.temperature_K;
    down_ = false;
}

void ActivationWatch::measure(const Simulation& run) {
    Activation& now = activations_.back();
    const tissue::State& state = run.state();
    pending_ = false;
    now.from_cut = now.hexels_removed > 0;
    const Lattice& lattice = run.model().hexels;
    const std::vector<Int3> from = now.from_cut ? edge_of(run, removed_) : cells_of(lattice, touched_);
    const std::vector<Int3> others = now.from_cut ? edge_of(run, gone_) : std::vector<Int3>();
    for_bits(removed_, [&](std::int64_t hexel) { gone_.set(hexel); });
    if (from.empty()) return;
    for_bits(state.hexel_present, [&](std::int64_t hexel) {
        const auto h = static_cast<std::size_t>(hexel);
        const float peak_K = state.peak_temperature_K[h];
        const bool hotter = peak_K > peak_before_K_[h] && peak_K >= static_cast<float>(kSpreadTemperatures_K[0]);
        const bool newly_damaged = state.damage[h] >= 1.0f && damage_before_[h] < 1.0f;
        if (!hotter && !newly_damaged) return;
        // From the near face of the edge's hexel to the far face of this one: the distance of their centres.
        const Int3 cell = lattice.coordinates(hexel);
        const int distance2 = nearest(cell, from);
        if (nearest(cell, others) < distance2) return;
        const double distance_m = std::sqrt(static_cast<double>(distance2)) * lattice.spacing_m;
        for (std::size_t k = 0; k < kSpreadTemperatures_K.size(); ++k)
            if (hotter && peak_K >= static_cast<float>(kSpreadTemperatures_K[k]))
                now.spread_m[k] = std::max(now.spread_m[k], distance_m);
        if (newly_damaged) now.spread_m.back() = std::max(now.spread_m.back(), distance_m);
    });
}

}  // namespace calot::simulation

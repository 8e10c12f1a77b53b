#include "calot/gpu/heat.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "calot/thermal/axes.h"

namespace calot::gpu {

namespace {

std::vector<GpuHeatMaterial> materials_of(const tissue::Model& model, const thermal::Properties& p) {
    std::vector<GpuHeatMaterial> all(model.materials.size());
    for (std::size_t m = 0; m < all.size(); ++m)
        all[m] = {p.conducted_J_per_m3K[m], p.to_gas_J_per_m3K[m],       p.to_held_J_per_m3K[m],
                  p.to_blood_J_per_m3K[m],  p.dry_capacity_J_per_m3K[m], p.water_capacity_J_per_kgK[m],
                  p.dry_limit_K[m],         p.boil_off_J_per_kg[m],      p.plateau_J_per_m3[m],
                  p.spent_J_per_m3[m],      p.water_kg_per_m3[m],        p.damage_log_rate[m],
                  p.damage_slope[m]};
    return all;
}

/// Into tissue at present.
double tissue_W(const tissue::JouleHeat& joule) {
    return joule.size != Int3(0) ? joule.total_W : 0.0;
}

double pair(float high, float low) {
    return static_cast<double>(high) + static_cast<double>(low);
}

}  // namespace

Heat::Heat(std::shared_ptr<Device> device, const tissue::Model& model, Arrays& arrays)
    : device_(std::move(device)), arrays_(&arrays) {
    Device& d = *device_;
    kernels_ = {d.kernel("heat", "heat_active"), d.kernel("heat", "heat_tip"),   d.kernel("heat", "heat_flow"),
                d.kernel("heat", "heat_settle"), d.kernel("heat", "heat_look"),  d.kernel("heat", "heat_totals"),
                d.kernel("heat", "heat_list"),   d.kernel("heat", "heat_remove")};
    host_.properties = thermal::Properties::make(model);
    const double interval_s = model.tick_s * model.thermal.refresh_ticks;
    substeps_ =
        std::max(1, static_cast<int>(std::ceil(interval_s / static_cast<double>(host_.properties.longest_step_s))));
    step_s_ = interval_s / substeps_;
    host_.properties.set_step(model, step_s_);

    const Lattice& lattice = model.hexels;
    const thermal::Axes axes = thermal::axes_of(lattice);
    const std::int64_t hexels = model.hexel_initial.count(), blocks = thermal::block_count(lattice);
    constant_.first = arrays.hexels.first;
    constant_.last = arrays.hexels.last;
    constant_.blocks = static_cast<int>(blocks);
    constant_.row = lattice.stride[axes.middle];
    constant_.plane = lattice.stride[axes.slow];
    const int order[3] = {axes.fast, axes.middle, axes.slow};
    for (int k = 0; k < 3; ++k) {
        constant_.stride[k] = lattice.stride[k];
        constant_.axes[k] = order[k];
    }
    constant_.threshold = model.thermal.phase_model == tissue::PhaseModel::threshold ? 1 : 0;
    constant_.body_K = static_cast<float>(model.thermal.body_temperature_K);
    constant_.gas_K = static_cast<float>(model.thermal.gas_temperature_K);
    constant_.wet_limit_K = host_.properties.wet_limit_K;
    constant_.dt_s = static_cast<float>(step_s_);

    const std::vector<GpuHeatMaterial> materials = materials_of(model, host_.properties);
    materials_ = DeviceArray<GpuHeatMaterial>(d, static_cast<std::int64_t>(materials.size()));
    materials_.upload(d, std::span<const GpuHeatMaterial>(materials));
    touched_ = DeviceArray<GpuTouch>(d, tissue::kNearCapacity);
    temperature_K_ = DeviceArray<float>(d, lattice.cells);
    steam_kg_per_m3_ = DeviceArray<float>(d, lattice.cells);
    for (auto* per_block : {&active_, &warm_, &counts_}) *per_block = DeviceArray<std::int32_t>(d, blocks);
    places_ = DeviceArray<std::int32_t>(d, 2 * blocks);
    sums_ = DeviceArray<float>(d, blocks * HEAT_SUMS * 2);
    spent_ = DeviceArray<GpuHexelValue>(d, hexels);
    boiled_ = DeviceArray<GpuHexelValue>(d, std::min(hexels, tissue::kGasCapacity));
    removed_ = DeviceArray<std::int32_t>(d, hexels);
    totals_ = DeviceArray<GpuHeatTotals>(d, 1);
    for (auto* list : {&host_.spent, &host_.burnt}) list->reserve(static_cast<std::size_t>(hexels));
    host_.sticks.reserve(static_cast<std::size_t>(hexels));
    values_.reserve(static_cast<std::size_t>(std::max(spent_.size(), boiled_.size())));
    touch_list_.reserve(static_cast<std::size_t>(touched_.size()));
}

/// A step in which Joule heat gives tissue so much [J].
GpuHeatStep Heat::make_step(const tissue::Model& model, const tissue::State& state, double given_J) const {
    GpuHeatStep step = constant_;
    if (!(given_J > 0.0) || !(state.field.tissue_S > 0.0)) return step;
    step.joule_V2_s = static_cast<float>(given_J / state.field.tissue_S);
    for (int k = 0; k < 3; ++k) {
        step.joule_low[k] = state.field_low[constant_.axes[k]];
        step.joule_size[k] = model.electric.window_cells;
    }
    return step;
}

void Heat::enqueue_lists(const GpuHeatStep& step) {
    Device& d = *device_;
    const std::int64_t items = std::int64_t{step.blocks} * HEAT_BLOCK;
    d.launch(kernels_.totals, HEAT_BLOCK, HEAT_BLOCK, step, counts_, sums_, places_, totals_);
    d.launch(kernels_.list, items, HEAT_BLOCK, step, materials_, arrays_->hexel_material, arrays_->hexel_present,
             counts_, places_, arrays_->enthalpy_J_per_m3, arrays_->water_kg_per_m3, steam_kg_per_m3_, spent_,
             static_cast<std::int32_t>(spent_.size()), boiled_, static_cast<std::int32_t>(boiled_.size()));
}

void Heat::look_at(const tissue::Model& model, tissue::State& state) {
    const GpuHeatStep& step = constant_;
    device_->launch(kernels_.look, std::int64_t{step.blocks} * HEAT_BLOCK, HEAT_BLOCK, step, materials_,
                    arrays_->hexel_material, arrays_->hexel_present, temperature_K_, arrays_->enthalpy_J_per_m3,
                    arrays_->water_kg_per_m3, steam_kg_per_m3_, warm_, counts_, sums_);
    enqueue_lists(step);
    totals_.download(*device_, std::span<GpuHeatTotals>(&result_, 1));
    pending_ = false;
    take_spent(model, state, result_.spent);
}

void Heat::enqueue_step(const tissue::Model& model, const tissue::State& state, const tissue::Exchange& exchange,
                        const DeviceArray<float>& joule_S_per_m3) {
    Device& d = *device_;
    Arrays& a = *arrays_;
    const GpuHeatStep step = make_step(model, state, given_J_);
    const std::int64_t items = std::int64_t{step.blocks} * HEAT_BLOCK;
    d.launch(kernels_.active, step.blocks, HEAT_BLOCK, step, a.hexel_initial, warm_, active_, totals_);

    touch_list_.clear();
    contact_ = thermal::find_wire_contact(model, state, exchange);
    if (contact_.wire.area_m2 > 0.0)
        for (const tissue::NearHexel& near : exchange.near)
            if (thermal::touches(model, state, near))
                touch_list_.push_back({static_cast<std::int32_t>(near.hexel),
                                       static_cast<float>(thermal::passed_J_per_m3K(model, host_.properties, contact_,
                                                                                    near.hexel, step_s_))});
    if (!touch_list_.empty()) {
        touched_.upload(d, std::span<const GpuTouch>(touch_list_));
        d.launch(kernels_.tip, HEAT_BLOCK, HEAT_BLOCK, step, touched_, static_cast<std::int32_t>(touch_list_.size()),
                 static_cast<float>(state.tip.temperature_K - model.thermal.body_temperature_K), temperature_K_,
                 a.enthalpy_J_per_m3, active_, totals_);
    }
    d.launch(kernels_.flow, items, HEAT_BLOCK, step, materials_, a.hexel_material, a.hexel_present, a.hexel_held,
             active_, temperature_K_, a.damage, joule_S_per_m3, a.enthalpy_J_per_m3, sums_);
    d.launch(kernels_.settle, items, HEAT_BLOCK, step, materials_, a.hexel_material, a.hexel_present, active_,
             temperature_K_, a.enthalpy_J_per_m3, a.water_kg_per_m3, a.peak_temperature_K, a.damage, steam_kg_per_m3_,
             warm_, counts_, sums_, totals_);
    enqueue_lists(step);
    pending_ = true;
}

void Heat::conduct(const tissue::Model& model, tissue::State& state, const tissue::Exchange& exchange,
                   const DeviceArray<float>& joule_S_per_m3) {
    tissue::EnergyBudget& energy = state.energy_J;
    if (exchange.joule.size != Int3(0)) {
        const double outflow_J = exchange.joule.outflow_W * model.tick_s;
        const double tissue_J = tissue_W(exchange.joule) * model.tick_s;
        energy.outflow += outflow_J;
        energy.transit += tissue_J;
        energy.delivered += tissue_J + outflow_J;
    }
    const int ticks = model.thermal.refresh_ticks, tick = static_cast<int>(state.tick % ticks);
    if (tick != step_tick(ticks)) return;
    const double ahead_s = (ticks - 1 - tick) * model.tick_s;
    given_J_ = std::max(0.0, energy.transit + tissue_W(exchange.joule) * ahead_s);
    for (int substep = 0; substep < substeps_; ++substep) {
        enqueue_step(model, state, exchange, joule_S_per_m3);
        if (substep + 1 < substeps_) book(model, state, exchange);
    }
}

void Heat::take_spent(const tissue::Model& model, tissue::State& state, std::int32_t count) {
    values_.resize(static_cast<std::size_t>(count));
    spent_.download(*device_, std::span<GpuHexelValue>(values_));
    host_.spent.clear();
    for (const GpuHexelValue& spent : values_) {
        host_.spent.push_back(spent.hexel);
        const auto h = static_cast<std::size_t>(spent.hexel);
        state.enthalpy_J_per_m3[h] = spent.value;  // the host books it when the hexel goes
        if (model.thermal.phase_model != tissue::PhaseModel::threshold) state.water_kg_per_m3[h] = 0.0f;
    }
}

void Heat::emit_steam(const tissue::Model& model, tissue::Exchange& exchange, std::int32_t count) {
    values_.resize(static_cast<std::size_t>(std::min<std::int64_t>(count, boiled_.size())));
    boiled_.download(*device_, std::span<GpuHexelValue>(values_));
    for (const GpuHexelValue& boiled : values_)
        if (exchange.gas.size() < exchange.gas.capacity())
            exchange.gas.push_back({boiled.hexel,
                                    static_cast<float>(static_cast<double>(boiled.value) * model.hexel_volume_m3()),
                                    0.0f, static_cast<float>(model.thermal.boiling_temperature_K)});
}

/// What a step did.
void Heat::book(const tissue::Model& model, tissue::State& state, const tissue::Exchange& exchange) {
    pending_ = false;
    totals_.download(*device_, std::span<GpuHeatTotals>(&result_, 1));
    const double volume = model.hexel_volume_m3();
    auto sum_J = [&](int s) { return pair(result_.high[s], result_.low[s]) * volume; };
    tissue::EnergyBudget& energy = state.energy_J;
    energy.transit -= given_J_;
    energy.outflow += given_J_ - sum_J(HEAT_DELIVERED);  // of hexels that went since the field was solved
    given_J_ = 0.0;
    if (tissue_W(exchange.joule) <= 0.0 && energy.transit < 0.0) {  // given ahead of a current that has ended
        energy.delivered -= energy.transit;
        energy.transit = 0.0;
    }
    energy.perfusion += sum_J(HEAT_PERFUSION);
    energy.surface += sum_J(HEAT_SURFACE);
    energy.gas += sum_J(HEAT_GAS);
    energy.latent += sum_J(HEAT_LATENT);
    if (result_.bad_hexel != HEAT_NONE && state.status.ok)
        state.status = {false, "enthalpy", result_.bad_hexel, state.tick};
    if (contact_.wire.area_m2 > 0.0) {
        const double tissue_J = pair(result_.tip_high, result_.tip_low) * volume;
        thermal::settle_wire(model, state, contact_.wire, tissue_J, 0.0, step_s_);
        state.tip.heat_W += exchange.joule.wire_W;  // book_arcs
    }
}

/// Heat of arcs into the wire in this tick.
void Heat::book_arcs(const tissue::Model& model, tissue::State& state, const tissue::Exchange& exchange) {
    const thermal::BareWire wire = thermal::bare_wire(model.thermal, exchange.capsules);
    if (wire.area_m2 <= 0.0) return;
    const double arcs_J = exchange.joule.wire_W * model.tick_s;
    state.energy_J.delivered += arcs_J;
    state.energy_J.tip += arcs_J;
    state.tip.temperature_K += arcs_J / wire.heat_capacity_J_per_K;
}

void Heat::remove_vaporised(const tissue::Model& model, tissue::State& state, tissue::Exchange& exchange) {
    if (pending_) {
        book(model, state, exchange);
        take_spent(model, state, result_.spent);
        emit_steam(model, exchange, result_.boiled);
    }
    book_arcs(model, state, exchange);
    host_.burnt.clear();
    thermal::remove_vaporised(model, state, exchange, host_);
    if (host_.burnt.empty()) return;
    removed_.upload(*device_, std::span<const std::int32_t>(host_.burnt));
    device_->launch(kernels_.remove, static_cast<std::int64_t>(host_.burnt.size()), HEAT_BLOCK, removed_,
                    static_cast<std::int32_t>(host_.burnt.size()), arrays_->hexel_present, arrays_->enthalpy_J_per_m3,
                    arrays_->water_kg_per_m3);
}

}  // namespace calot::gpu

#include "calot/gpu/field.h"

#include <algorithm>
#include <cmath>

#include "calot/electric/conductivity.h"
#include "calot/electric/contact.h"
#include "calot/electric/generator.h"
#include "calot/electric/poles.h"
#include "calot/electric/solve.h"

namespace calot::gpu {

namespace {

constexpr int kGroup = 256;
constexpr int kRowMultiple = 16;  ///< as on the host (electric/level.h)
constexpr int kPadding = 64;      ///< before and after a level's planes
constexpr int kCoarsest = 2;      ///< cells along an edge where coarsening ends
/// Levels of so many cells are done by one group: nine for each of its items.
constexpr int kSmallItems = 4096;
/// Iterations of a whole solve between looks at whether it is done.
constexpr int kBatch = 4;

int items_of(const GpuLevel& level) {
    return level.row * level.rows * level.rows;
}
int groups_of(const GpuLevel& level) {
    return (items_of(level) + kGroup - 1) / kGroup;
}

GpuLevel make_level(int cells, int at) {
    GpuLevel level{};
    level.cells = cells;
    level.rows = (cells + 1) / 2 * 2;
    level.row = (level.rows + kRowMultiple - 1) / kRowMultiple * kRowMultiple;
    level.plane = level.row * level.rows;
    level.first = level.plane + kPadding;
    level.length = level.first + level.plane * level.rows + level.plane + kPadding;
    level.at = at;
    return level;
}

std::vector<GpuConductor> conductors_of(const tissue::Model& model, const electric::Conductivity& c) {
    std::vector<GpuConductor> all(model.materials.size());
    for (std::size_t m = 0; m < all.size(); ++m)
        all[m] = {c.slope_per_K[m],
                  c.dry_S_per_m[m],
                  c.dry_capacity_J_per_m3K[m],
                  c.water_capacity_J_per_kgK[m],
                  c.alive_water_kg_per_m3[m],
                  c.per_water_m3_per_kg[m]};
    return all;
}

GpuMetal metal_of(const tissue::Model& model, const tissue::State& state) {
    const tissue::ElectricParameters& p = model.electric;
    const double s = model.hexels.spacing_m, char_m = state.tip.char_kg / (p.char_density_kg_per_m3 * p.bare_area_m2);
    GpuMetal metal{};
    metal.film = static_cast<float>(char_m / (p.char_conductivity_S_per_m * s));
    metal.arc = static_cast<float>(s * p.arc_resistance_Ohm);
    metal.arc_per_m = static_cast<float>(s * p.arc_resistance_Ohm_per_m);
    metal.contact_gap_m = static_cast<float>(p.contact_gap_m);
    metal.wire_share = static_cast<float>(p.arc_wire_share);
    metal.edge = static_cast<float>(electric::kEdge);
    return metal;
}

}  // namespace

void Field::find_kernels() {
    auto matrix = [&](const char* name) { return device_->kernel("field_matrix", name); };
    auto cycle = [&](const char* name) { return device_->kernel("field_cycle", name); };
    auto iterate = [&](const char* name) { return device_->kernel("field_iterate", name); };
    auto heat = [&](const char* name) { return device_->kernel("field_heat", name); };
    Kernels& k = kernels_;
    k.gather = matrix("field_gather");
    k.enter = matrix("field_enter");
    k.burn = matrix("field_burn");
    k.connect = matrix("field_connect");
    k.faces = matrix("field_faces");
    k.weights = matrix("field_weights");
    k.aggregate = matrix("field_aggregate");
    k.aggregate_small = matrix("field_aggregate_small");
    k.guess = matrix("field_guess");
    k.restrict = cycle("field_restrict");
    k.descend = cycle("field_descend");
    k.small_cycle = cycle("field_small_cycle");
    k.ascend = cycle("field_ascend");
    k.begin = iterate("field_begin");
    k.begin_scalars = iterate("field_begin_scalars");
    k.start = iterate("field_start");
    k.norms = iterate("field_norms");
    k.beta = iterate("field_beta");
    k.direction = iterate("field_direction");
    k.apply = iterate("field_apply");
    k.alpha = iterate("field_alpha");
    k.advance = iterate("field_advance");
    k.weigh = heat("field_weigh");
    k.scale = heat("field_scale");
    k.heat = heat("field_heat");
    k.heat_sums = heat("field_heat_sums");
}

void Field::make_levels(int cells) {
    levels_.level[0] = make_level(cells, 0);
    levels_.count = 1;
    const auto end = [](const GpuLevel& level) { return level.at + LEVEL_VECTORS * level.length; };
    do {
        const GpuLevel& last = levels_.level[levels_.count - 1];
        if (levels_.count == FIELD_MOST_LEVELS) throw DeviceError("the field's window has too many cells");
        levels_.level[levels_.count] = make_level(last.rows / 2, end(last));
        ++levels_.count;
    } while (levels_.level[levels_.count - 1].cells > kCoarsest);
    levels_.small = 1;
    while (levels_.small + 1 < levels_.count && items_of(levels_.level[levels_.small]) > kSmallItems) ++levels_.small;
    grid_ = DeviceArray<float>(*device_, end(levels_.level[levels_.count - 1]));
}

Field::Field(std::shared_ptr<Device> device, const tissue::Model& model, const Arrays& arrays)
    : device_(std::move(device)), arrays_(&arrays) {
    Device& d = *device_;
    find_kernels();
    const int cells = model.electric.window_cells;
    make_levels(cells);
    const electric::Conductivity conductivity = electric::conductivity_of_materials(model);
    wet_limit_K_ = conductivity.wet_limit_K;
    const std::vector<GpuConductor> conductors = conductors_of(model, conductivity);
    materials_ = static_cast<std::int32_t>(conductors.size());
    conductors_ = DeviceArray<GpuConductor>(d, materials_);
    conductors_.upload(d, std::span<const GpuConductor>(conductors));
    const Array<float> rest = electric::conductivity_at_rest_S_per_m(model);
    rest_ = DeviceArray<float>(d, static_cast<std::int64_t>(rest.size()));
    rest_.upload(d, std::span<const float>(rest.data(), rest.size()));

    for (auto* vector : {&sigma_, &metal_, &wire_, &x_, &p_}) *vector = DeviceArray<float>(d, fine().length);
    entered_ = DeviceArray<std::int32_t>(d, fine().length);
    const std::int64_t groups = groups_of(fine()), sums = materials_ + FIELD_OTHERS;
    parts_ = DeviceArray<float>(d, groups * 3 * 2);
    heat_parts_ = DeviceArray<GpuFieldSum>(d, groups * sums);
    heat_sums_ = DeviceArray<GpuFieldSum>(d, sums);
    sum_list_.resize(static_cast<std::size_t>(sums));
    scalars_ = DeviceArray<GpuFieldScalars>(d, 1);
    entries_ = DeviceArray<GpuEntry>(d, tissue::kNearCapacity);
    entry_list_.reserve(static_cast<std::size_t>(entries_.size()));
    listed_ = BitArray(fine().length);
    const std::int64_t all = std::int64_t{cells} * cells * cells;
    potential_ = DeviceArray<float>(d, all);
    joule_ = DeviceArray<float>(d, all);
}

void Field::upload(const tissue::State& state) {
    potential_.upload(*device_, std::span<const float>(state.potential.data(), state.potential.size()));
    joule_.upload(*device_, std::span<const float>(state.joule_S_per_m3.data(), state.joule_S_per_m3.size()));
    solving_ = false;
}

void Field::download(tissue::State& state) const {
    potential_.download(*device_, std::span<float>(state.potential.data(), state.potential.size()));
    joule_.download(*device_, std::span<float>(state.joule_S_per_m3.data(), state.joule_S_per_m3.size()));
}

/// Hexels that current enters, as far as the host knows: those that are present and conduct when alive.
void Field::list_entries(const tissue::Model& model, const tissue::State& state, const tissue::Exchange& exchange,
                         double reach_gap_m) {
    for (const GpuEntry& entry : entry_list_) listed_.clear(entry.cell);
    entry_list_.clear();
    centre_ = Vec3(0.0);
    for (const tissue::NearHexel& near : exchange.near) {
        if (!electric::reaches({reach_gap_m, false}, near) || entry_list_.size() == entry_list_.capacity()) continue;
        const Int3 place = window_.from_hexel(model.hexels.coordinates(near.hexel));
        if (!window_.contains(place) || !state.hexel_present.test(near.hexel)) continue;
        const tissue::MaterialIndex material = model.hexel_material[static_cast<std::size_t>(near.hexel)];
        if (!(model.materials[material].electric_conductivity_S_per_m > 0.0)) continue;
        GpuEntry entry{};
        entry.cell = fine().first + place.x + place.y * fine().row + place.z * fine().plane;
        if (listed_.test(entry.cell)) continue;
        listed_.set(entry.cell);
        entry.gap_m = near.bare_gap_m;
        for (int k = 0; k < 3; ++k) entry.outward[k] = near.outward[window_.axis[k]];
        entry_list_.push_back(entry);
        centre_ += Vec3(place);
    }
    if (!entry_list_.empty()) centre_ /= static_cast<double>(entry_list_.size());
}

void Field::gather(const tissue::Model& model, const tissue::State& state, const tissue::Exchange& exchange,
                   const tissue::Input& input) {
    Device& d = *device_;
    const Arrays& a = *arrays_;
    const electric::Reach reach = electric::find_reach(model, state, exchange, input);
    window_ = electric::place_window(model, exchange, reach, state.field_low);
    gpu_window_.cells = window_.cells;
    for (int k = 0; k < 3; ++k) {
        gpu_window_.begin[k] = window_.begin[k];
        gpu_window_.end[k] = window_.end[k];
    }
    gpu_window_.base = static_cast<std::int32_t>(model.hexels.index(window_.low));
    for (int k = 0; k < 2; ++k) gpu_window_.stride[k] = model.hexels.stride[window_.axis[k + 1]];
    list_entries(model, state, exchange, reach.gap_m);

    const auto count = static_cast<std::int32_t>(entry_list_.size());
    entries_.upload(d, std::span<const GpuEntry>(entry_list_));
    d.launch(kernels_.gather, items_of(fine()), kGroup, gpu_window_, fine(), conductors_, wet_limit_K_, rest_,
             a.hexel_material, a.hexel_present, a.hexel_held, a.enthalpy_J_per_m3, a.water_kg_per_m3, sigma_, metal_,
             wire_, entered_, scalars_);
    d.launch(kernels_.enter, count, kGroup, entries_, count, sigma_, entered_);
    if (reach.arcs)
        d.launch(kernels_.burn, items_of(fine()), kGroup, gpu_window_, fine(),
                 static_cast<float>(model.electric.arc_conductivity_S_per_m), rest_, entered_, sigma_);
    d.launch(kernels_.connect, count, kGroup, fine(), metal_of(model, state), entries_, count, sigma_, entered_, metal_,
             wire_, scalars_);
}

void Field::assemble(const tissue::Model& model) {
    Device& d = *device_;
    const electric::Poles poles = electric::find_poles(model, window_, centre_);
    for (int k = 0; k < 3; ++k) {
        poles_.source[k] = poles.source[k];
        poles_.sink[k] = poles.sink[k];
    }
    poles_.rest = poles.rest;
    poles_.placed = poles.placed ? 1 : 0;
    d.launch(kernels_.faces, items_of(fine()), kGroup, gpu_window_, fine(), poles_, sigma_, metal_, grid_);
    d.launch(kernels_.weights, items_of(fine()), kGroup, fine(), grid_);
}

void Field::prepare(const tissue::State& state) {
    Device& d = *device_;
    for (int l = 1; l < levels_.small; ++l) {
        const GpuLevel& level = levels_.level[l];
        d.launch(kernels_.aggregate, items_of(level), kGroup, levels_.level[l - 1], level, grid_);
        d.launch(kernels_.weights, items_of(level), kGroup, level, grid_);
    }
    d.launch(kernels_.aggregate_small, kGroup, kGroup, levels_, grid_);
    const Int3 moved = window_.low - state.field_low;
    d.launch(kernels_.guess, items_of(fine()), kGroup, fine(), window_.cells, moved[window_.axis.x],
             moved[window_.axis.y], moved[window_.axis.z], potential_, grid_, x_);
}

void Field::begin(const tissue::Model& model) {
    Device& d = *device_;
    const std::int32_t groups = groups_of(fine());
    d.launch(kernels_.begin, items_of(fine()), kGroup, fine(), grid_, metal_, x_, parts_);
    d.launch(kernels_.begin_scalars, kGroup, kGroup, parts_, groups,
             static_cast<float>(model.electric.relative_residual), scalars_);
    d.launch(kernels_.start, items_of(fine()), kGroup, fine(), grid_, metal_, x_, scalars_, parts_);
    d.launch(kernels_.norms, kGroup, kGroup, parts_, groups, std::int32_t{0}, scalars_);
}

void Field::iterate(int count) {
    Device& d = *device_;
    const GpuLevel *level = levels_.level, &fine = level[0], &next = level[1];
    const std::int32_t groups = groups_of(fine);
    for (int k = 0; k < count; ++k) {
        d.launch(kernels_.restrict, items_of(next), kGroup, fine, next, grid_, scalars_);
        for (int l = 1; l < levels_.small; ++l)
            d.launch(kernels_.descend, items_of(level[l + 1]), kGroup, level[l], level[l + 1], grid_, scalars_);
        d.launch(kernels_.small_cycle, kGroup, kGroup, levels_, grid_, scalars_);
        for (int l = levels_.small - 1; l >= 1; --l)
            d.launch(kernels_.ascend, items_of(level[l]), kGroup, level[l], level[l + 1], result_of(l + 1), grid_,
                     scalars_, parts_);
        const std::int32_t product_groups = levels_.small > 1 ? groups_of(next) : 0;
        d.launch(kernels_.beta, kGroup, kGroup, parts_, product_groups, scalars_);
        d.launch(kernels_.direction, items_of(fine), kGroup, fine, next, result_of(1), grid_, scalars_, p_);
        d.launch(kernels_.apply, items_of(fine), kGroup, fine, grid_, p_, scalars_, parts_);
        d.launch(kernels_.alpha, kGroup, kGroup, parts_, groups, scalars_);
        d.launch(kernels_.advance, items_of(fine), kGroup, fine, grid_, p_, x_, scalars_, parts_);
        d.launch(kernels_.norms, kGroup, kGroup, parts_, groups, std::int32_t{1}, scalars_);
    }
}

/// What electric/joule.cpp keeps of the sums.
void Field::keep_heat(const tissue::Model& model, tissue::State& state, const GpuFieldScalars& scalars) {
    const std::vector<GpuFieldSum>& sums = sum_list_;
    heat_sums_.download(*device_, std::span<GpuFieldSum>(sum_list_));
    const double s = model.hexels.spacing_m;
    const auto total_S = [&](std::int32_t k) {
        const GpuFieldSum& sum = sums[static_cast<std::size_t>(k)];
        return s * (static_cast<double>(sum.high) + static_cast<double>(sum.low));
    };
    tissue::FieldState& field = state.field;
    field.tissue_S = 0.0;
    state.stray_S.fill(0.0);
    state.stray_density_S_per_m2.fill(0.0);
    for (std::int32_t m = 1; m < materials_; ++m) {
        field.tissue_S += total_S(m);
        const auto k = static_cast<std::size_t>(m);
        if (k >= tissue::kStrayMaterials) continue;
        state.stray_S[k] = total_S(m);
        // Heat is q s^2, and q = J^2 / sigma.
        state.stray_density_S_per_m2[k] = std::sqrt(static_cast<double>(sums[k].greatest)) / s;
    }
    field.elsewhere_S = total_S(0) + total_S(materials_ + FIELD_BEYOND);
    field.wire_S = total_S(materials_ + FIELD_WIRE);
    field.residual = scalars.right_norm2 > 0.0f
                         ? std::sqrt(static_cast<double>(scalars.residual) / static_cast<double>(scalars.right_norm2))
                         : 0.0;
    field.contacts = scalars.contacts;
    field.arcs = scalars.arcs;
    const double conductance_S = field.conductance_S();
    field.solved = conductance_S >= electric::kOpenCircuit_S ? 1 : 0;
    if (field.solved != 0)
        field.imbalance =
            std::max(field.imbalance, std::abs(total_S(materials_ + FIELD_CURRENT) / conductance_S - 1.0));
}

void Field::finish(const tissue::Model& model, tissue::State& state) {
    Device& d = *device_;
    const std::int32_t groups = groups_of(fine());
    const double s = model.hexels.spacing_m;
    d.launch(kernels_.weigh, items_of(fine()), kGroup, fine(), grid_, metal_, x_, parts_);
    d.launch(kernels_.scale, kGroup, kGroup, parts_, groups, scalars_);
    d.launch(kernels_.heat, items_of(fine()), kGroup, gpu_window_, fine(), poles_, grid_, sigma_, metal_, wire_, x_,
             scalars_, arrays_->hexel_material, arrays_->hexel_present, static_cast<float>(1.0 / (s * s)), materials_,
             potential_, joule_, heat_parts_);
    d.launch(kernels_.heat_sums, heat_sums_.size() * kGroup, kGroup, heat_parts_, groups, heat_sums_);
    state.field_low = window_.low;
    GpuFieldScalars scalars{};
    scalars_.download(d, std::span<GpuFieldScalars>(&scalars, 1));
    iterations_ = scalars.iterations;
    if (!std::isfinite(scalars.residual) || !std::isfinite(scalars.rho)) {
        state.field.solved = 0;
        state.status = {false, "potential", entry_list_.empty() ? -1 : entry_list_[0].cell, state.tick};
        return;
    }
    keep_heat(model, state, scalars);
}

void Field::step(const tissue::Model& model, tissue::State& state, tissue::Exchange& exchange,
                 const tissue::Input& input) {
    const bool reached =
        !exchange.near.empty() && electric::any_reached(electric::find_reach(model, state, exchange, input), exchange);
    if (!reached) state.field.solved = 0;
    const auto part = static_cast<int>(state.tick % model.frame_ticks);
    if (part == 0) {
        solving_ = reached;
        if (reached) gather(model, state, exchange, input);
    } else if (solving_) {
        if (part == 1)
            assemble(model);
        else if (part == 2)
            prepare(state);
        else if (part == 3)
            begin(model);
        else if (part < model.frame_ticks - 1)
            iterate(1);
        else
            finish(model, state);
    }
    if (part == model.frame_ticks - 1) {
        // What was solved is no use when the metal has meanwhile left.
        if (!reached) state.field.solved = 0;
        solving_ = false;
    }
    electric::drive_load(model, state, exchange, input);
}

void Field::solve_now(const tissue::Model& model, tissue::State& state, tissue::Exchange& exchange,
                      const tissue::Input& input) {
    state.field.solved = 0;
    if (electric::any_reached(electric::find_reach(model, state, exchange, input), exchange)) {
        gather(model, state, exchange, input);
        assemble(model);
        prepare(state);
        begin(model);
        for (int k = 0; k < model.electric.max_iterations; k += kBatch) {
            iterate(std::min(kBatch, model.electric.max_iterations - k));
            GpuFieldScalars scalars{};
            scalars_.download(*device_, std::span<GpuFieldScalars>(&scalars, 1));
            if (scalars.done != 0) break;
        }
        finish(model, state);
    }
    electric::drive_load(model, state, exchange, input);
}

}  // namespace calot::gpu

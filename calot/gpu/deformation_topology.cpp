// Tearing, severing and falling, on the device and in the host's bits by the same rules.

#include <algorithm>

#include "calot/deformation/carriers.h"
#include "calot/deformation/falling.h"
#include "calot/deformation/ghosts.h"
#include "calot/deformation/rest.h"
#include "calot/deformation/stable_mass.h"
#include "calot/deformation/topology.h"
#include "calot/gpu/deformation.h"

namespace calot::gpu {

using deformation::kNeighbourhood;
using tissue::Exchange;
using tissue::State;

namespace {

constexpr int kGroup = 64;

/// Room for so many elements, with some to spare.
template <class T>
void reserve(Device& device, DeviceArray<T>& array, std::size_t count) {
    if (array.size() < static_cast<std::int64_t>(count))
        array = DeviceArray<T>(device, 2 * static_cast<std::int64_t>(count));
}

}  // namespace

std::uint32_t Deformation::mirror_word(std::int64_t cell) const {
    if (!model_->phyxel_ghost.test(cell)) return 0;
    const deformation::Mirror& mirror = deformation::find_mirror(host_, cell);
    std::uint32_t word = 0;
    for (std::size_t n = 0; n < static_cast<std::size_t>(mirror.count); ++n)
        for (std::size_t k = 0; k < kNeighbourhood; ++k)
            if (cell + host_.neighbour_offset[k] == mirror.phyxel[n]) word |= 1u << k;
    return word;
}

std::uint32_t Deformation::carrier_word(const State& state, std::int64_t cell) const {
    const deformation::Carriers carriers = deformation::find_carriers(*model_, state, host_, cell);
    std::uint32_t word = 0;
    for (std::size_t n = 0; n < static_cast<std::size_t>(carriers.count); ++n) word |= 1u << carriers.cell[n];
    return word;
}

void Deformation::upload_numbers() {
    std::vector<double> numbers(NUMBER_MATERIALS, 0.0);
    numbers[NUMBER_SPACING] = model_->phyxels.spacing_m;
    numbers[NUMBER_HEXEL_VOLUME] = model_->hexel_volume_m3();
    numbers[NUMBER_MASS_FLOOR] = model_->deformation.mass_fraction_floor;
    numbers[NUMBER_SINGULAR] = model_->deformation.singular_ratio;
    numbers[NUMBER_ALPHA] = model_->deformation.hourglass_alpha;
    numbers[NUMBER_SUBSTEP] = static_cast<double>(host_.substep_s);
    numbers[NUMBER_ROW_SUM] = deformation::kRowSum;
    numbers[NUMBER_SUPPORT] = deformation::kSupport;
    for (const tissue::Material& material : model_->materials) {  // as rest.cpp has them
        const double mu = material.youngs_modulus_Pa / (2.0 * (1.0 + material.poisson_ratio));
        const double lambda = 2.0 * mu * material.poisson_ratio / (1.0 - 2.0 * material.poisson_ratio);
        numbers.insert(numbers.end(), {material.density_kg_per_m3, mu, lambda});
    }
    if (device_->info().has_double) {
        numbers_ = device_->make_buffer(numbers.size() * sizeof(double));
        device_->write(numbers_, numbers.data(), numbers.size() * sizeof(double));
    } else {
        const std::vector<float> rounded(numbers.begin(), numbers.end());
        numbers_ = device_->make_buffer(rounded.size() * sizeof(float));
        device_->write(numbers_, rounded.data(), rounded.size() * sizeof(float));
    }
}

GpuTopology Deformation::topology() const {
    const deformation::OccupancyShifts shifts(model_->hexels_per_edge);
    auto halves = [](std::uint64_t word, unsigned int(&to)[2]) {
        to[0] = static_cast<unsigned int>(word);
        to[1] = static_cast<unsigned int>(word >> 32);
    };
    GpuTopology t{};
    t.hexels = arrays_->hexels;
    t.phyxels = arrays_->phyxels;
    t.hexels_per_edge = shifts.m;
    t.bit_words = arrays_->phyxel_words;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        t.shift[axis] = shifts.shift[axis];
        halves(shifts.low[axis], t.low[axis]);
        halves(shifts.high[axis], t.high[axis]);
    }
    halves(shifts.all, t.all);
    return t;
}

const DeviceArray<std::int32_t>& Deformation::list_of(std::span<const std::int64_t> cells) {
    list_.assign(cells.begin(), cells.end());
    reserve(*device_, cells_, list_.size());
    cells_.upload(*device_, std::span<const std::int32_t>(list_));
    return cells_;
}

void Deformation::drop_hexels(std::span<const std::int64_t> hexels, std::size_t first) {
    const auto count = static_cast<std::int32_t>(hexels.size());
    device_->launch(drop_hexels_, count, kGroup, list_of(hexels), count, static_cast<std::int32_t>(first),
                    arrays_->hexel_present, arrays_->enthalpy_J_per_m3, values_);
}

void Deformation::sever(std::span<const std::int64_t> removed) {
    noted_.clear();
    for (const std::int64_t hexel : removed) noted_.push_back(model_->phyxel_of(model_->hexels.coordinates(hexel)));
    std::sort(noted_.begin(), noted_.end());
    noted_.erase(std::unique(noted_.begin(), noted_.end()), noted_.end());
    const GpuTopology t = topology();
    const auto count = static_cast<std::int32_t>(noted_.size());
    const DeviceArray<std::int32_t>& touched = list_of(noted_);
    Arrays& a = *arrays_;
    device_->launch(keep_main_, count, kGroup, t, touched, count, a.hexel_present, words_, a.phyxel_present,
                    a.displacement_m, a.velocity_m_per_s);
    device_->launch(sever_faces_, 6 * std::int64_t{count}, kGroup, t, touched, count, a.phyxel_ghost, words_);
    device_->launch(sever_edges_, 24 * std::int64_t{count}, kGroup, t, touched, count, a.phyxel_ghost, words_);
}

void Deformation::drop_phyxels(const State& state, std::span<const std::int64_t> changed) {
    noted_.clear();
    for (const std::int64_t phyxel : changed)
        if (model_->phyxel_initial.test(phyxel) && !state.phyxel_present.test(phyxel)) noted_.push_back(phyxel);
    const auto count = static_cast<std::int32_t>(noted_.size());
    device_->launch(drop_phyxels_, count, kGroup, topology(), list_of(noted_), count, words_, arrays_->phyxel_present,
                    arrays_->displacement_m, arrays_->velocity_m_per_s);
}

void Deformation::refresh(std::span<const std::int64_t> changed) {
    // What refresh_phyxels writes: the phyxels, ghosts beside them, masses of their neighbours and of what such ghosts
    // mirror; and whose points they carry. What did not change comes out as it was.
    noted_.clear();
    for (const std::int64_t phyxel : changed)
        for (const std::int64_t offset : host_.neighbour_offset) {
            const std::int64_t cell = phyxel + offset;
            const bool ghost = model_->phyxel_ghost.test(cell);
            if (!ghost && !model_->phyxel_initial.test(cell)) continue;
            noted_.push_back(cell);
            if (!ghost) continue;
            const deformation::Mirror& mirror = deformation::find_mirror(host_, cell);
            noted_.insert(noted_.end(), mirror.phyxel.begin(), mirror.phyxel.begin() + mirror.count);
        }
    std::sort(noted_.begin(), noted_.end());
    noted_.erase(std::unique(noted_.begin(), noted_.end()), noted_.end());
    const GpuTopology t = topology();
    const auto count = static_cast<std::int32_t>(noted_.size());
    const DeviceArray<std::int32_t>& cells = list_of(noted_);
    Arrays& a = *arrays_;
    device_->launch(refresh_rest_, count, kGroup, t, cells, count, numbers_, a.phyxel_present, a.phyxel_ghost,
                    a.hexel_material, words_, a.links, rest_, gradient_, moment_stress_, own_force_);
    device_->launch(refresh_masses_, count, kGroup, t, cells, count, numbers_, a.phyxel_present, a.phyxel_ghost,
                    a.hexel_material, words_, rest_, mass_);
    run_gradients(sweep(), cells, count, 1);
}

void Deformation::tear_and_sever(State& state, Exchange& exchange) {
    // What falls takes its heat with it. The host's enthalpies are old: the device says what it was.
    const double debris_J = state.energy_J.debris;
    const std::size_t burnt = exchange.removed_hexels.size();
    for (const std::int32_t phyxel : torn_)
        deformation::drop_hexels(*model_, state, exchange, phyxel, host_.occupancy[static_cast<std::size_t>(phyxel)]);
    torn_.clear();
    exchange.changed_phyxels.clear();
    if (exchange.removed_hexels.empty()) return;
    const std::size_t gone = exchange.removed_hexels.size();
    deformation::sever_links(*model_, state, exchange, host_);  // appends what falls
    deformation::refresh_shapes(*model_, state, host_, exchange.changed_phyxels);

    const std::span<const std::int64_t> removed(exchange.removed_hexels);
    const std::size_t fallen = removed.size() - burnt;
    reserve(*device_, values_, fallen);
    drop_hexels(removed.subspan(burnt, gone - burnt), 0);
    sever(removed.first(gone));
    drop_hexels(removed.subspan(gone), gone - burnt);
    drop_phyxels(state, exchange.changed_phyxels);
    refresh(exchange.changed_phyxels);

    state.energy_J.debris = debris_J;
    if (fallen == 0) return;
    std::vector<float> enthalpy_J_per_m3(fallen);
    values_.download(*device_, std::span<float>(enthalpy_J_per_m3));
    for (const float held : enthalpy_J_per_m3)
        state.energy_J.debris += static_cast<double>(held) * model_->hexel_volume_m3();
}

}  // namespace calot::gpu

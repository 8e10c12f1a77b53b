// Tearing, severing and falling: the host works out what changes, the device takes it over.

#include <algorithm>

#include "calot/deformation/carriers.h"
#include "calot/deformation/falling.h"
#include "calot/deformation/ghosts.h"
#include "calot/deformation/integrate.h"
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

GpuPatch Deformation::patch_of(const State& state, std::int64_t cell) const {
    const auto i = static_cast<std::size_t>(cell);
    GpuPatch patch{};
    patch.cell = static_cast<std::int32_t>(cell);
    patch.present = state.phyxel_present.test(cell) ? 1 : 0;
    for (std::size_t e = 0; e < 6; ++e) patch.rest[REST_MOMENT_INVERSE + e] = host_.moment_inverse[e][i];
    for (std::size_t c = 0; c < 3; ++c) patch.rest[REST_STEP_SUM + c] = host_.step_sum[c][i];
    patch.rest[REST_VOLUME] = host_.volume_m3[i];
    patch.rest[REST_HOURGLASS] = host_.hourglass[i];
    patch.rest[REST_MU] = host_.lame_mu_Pa[i];
    patch.rest[REST_LAMBDA] = host_.lame_lambda_Pa[i];
    patch.mass[MASS_WEIGHING] = host_.weighing_mass_kg[i];
    patch.mass[MASS_MOVING] = host_.moving_mass_kg[i];
    patch.mass[MASS_STABLE] = host_.stable_mass_kg[i];
    patch.word[WORD_LINKS] = host_.link_word[i];
    patch.word[WORD_MIRROR] = mirror_word(cell);
    patch.word[WORD_CARRIERS] = carrier_word(state, cell);
    patch.word[WORD_OCCUPANCY] = static_cast<std::uint32_t>(host_.occupancy[i]);
    patch.word[WORD_OCCUPANCY + 1] = static_cast<std::uint32_t>(host_.occupancy[i] >> 32);
    return patch;
}

void Deformation::patch_about(const State& state, const std::vector<std::int64_t>& changed) {
    // What refresh_phyxels writes: the phyxel, ghosts beside it, masses of its neighbours and of what such ghosts
    // mirror; and whose points it carries.
    patched_.clear();
    for (const std::int64_t phyxel : changed)
        for (const std::int64_t offset : host_.neighbour_offset) {
            const std::int64_t cell = phyxel + offset;
            const bool ghost = model_->phyxel_ghost.test(cell);
            if (!ghost && !model_->phyxel_initial.test(cell)) continue;
            patched_.push_back(cell);
            if (!ghost) continue;
            const deformation::Mirror& mirror = deformation::find_mirror(host_, cell);
            patched_.insert(patched_.end(), mirror.phyxel.begin(), mirror.phyxel.begin() + mirror.count);
        }
    std::sort(patched_.begin(), patched_.end());
    patched_.erase(std::unique(patched_.begin(), patched_.end()), patched_.end());
    patches_.clear();
    for (const std::int64_t cell : patched_) patches_.push_back(patch_of(state, cell));

    const auto count = static_cast<std::int32_t>(patches_.size());
    reserve(*device_, device_patches_, patches_.size() * sizeof(GpuPatch) / 4);
    reserve(*device_, cells_, patched_.size());
    device_->write(device_patches_.buffer(), patches_.data(), patches_.size() * sizeof(GpuPatch));
    const std::vector<std::int32_t> cells(patched_.begin(), patched_.end());
    cells_.upload(*device_, std::span<const std::int32_t>(cells));
    Arrays& a = *arrays_;
    device_->launch(apply_patches_, count, kGroup, a.phyxels, device_patches_, count, a.phyxel_words, a.phyxel_ghost,
                    rest_, mass_, words_, a.phyxel_present, a.links, a.displacement_m, a.velocity_m_per_s, gradient_,
                    moment_stress_, own_force_);
    run_gradients(sweep(), cells_, count, 1);
}

void Deformation::drop_fallen(State& state, const Exchange& exchange, std::size_t burnt, double debris_J) {
    state.energy_J.debris = debris_J;
    const std::vector<std::int32_t> fallen(exchange.removed_hexels.begin() + static_cast<std::ptrdiff_t>(burnt),
                                           exchange.removed_hexels.end());
    if (fallen.empty()) return;
    reserve(*device_, cells_, fallen.size());
    reserve(*device_, values_, fallen.size());
    cells_.upload(*device_, std::span<const std::int32_t>(fallen));
    const auto count = static_cast<std::int32_t>(fallen.size());
    device_->launch(drop_hexels_, count, kGroup, cells_, count, arrays_->hexel_present, arrays_->enthalpy_J_per_m3,
                    values_);
    std::vector<float> enthalpy_J_per_m3(fallen.size());
    values_.download(*device_, std::span<float>(enthalpy_J_per_m3));
    for (const float held : enthalpy_J_per_m3)
        state.energy_J.debris += static_cast<double>(held) * model_->hexel_volume_m3();
}

void Deformation::tear_and_sever(State& state, Exchange& exchange) {
    // What falls takes its heat with it. The host's enthalpies are old: the device says what it was.
    const double debris_J = state.energy_J.debris;
    const std::size_t burnt = exchange.removed_hexels.size();
    for (const std::int32_t phyxel : torn_)
        deformation::drop_hexels(*model_, state, exchange, phyxel, host_.occupancy[static_cast<std::size_t>(phyxel)]);
    torn_.clear();
    deformation::sever_links(*model_, state, exchange, host_);
    drop_fallen(state, exchange, burnt, debris_J);
    if (exchange.changed_phyxels.empty()) return;
    deformation::refresh_phyxels(*model_, state, host_, exchange.changed_phyxels);
    patch_about(state, exchange.changed_phyxels);
}

}  // namespace calot::gpu

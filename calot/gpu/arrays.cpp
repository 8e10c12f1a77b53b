#include "calot/gpu/arrays.h"

#include <algorithm>
#include <array>

namespace calot::gpu {

namespace {

template <class T>
std::span<const T> all_of(const Array<T>& array) {
    return {array.data(), array.size()};
}

}  // namespace

GpuLattice lattice_of(const Lattice& lattice) {
    GpuLattice out{};
    std::array<int, 3> axes{0, 1, 2};
    std::sort(axes.begin(), axes.end(), [&](int a, int b) { return lattice.stride[a] < lattice.stride[b]; });
    for (int axis = 0; axis < 3; ++axis) {
        out.origin_m[axis] = static_cast<float>(lattice.origin_m[axis]);
        out.size[axis] = lattice.size[axis];
        out.stride[axis] = lattice.stride[axis];
    }
    out.spacing_m = static_cast<float>(lattice.spacing_m);
    out.first = static_cast<std::int32_t>(lattice.first);
    out.last = static_cast<std::int32_t>(lattice.last);
    out.cells = static_cast<std::int32_t>(lattice.cells);
    out.fast = axes[0];
    out.middle = axes[1];
    out.slow = axes[2];
    return out;
}

Arrays::Arrays(Device& device, const tissue::Model& model)
    : hexels(lattice_of(model.hexels)),
      phyxels(lattice_of(model.phyxels)),
      hexel_words(static_cast<std::int32_t>(words_of(model.hexels.cells))),
      phyxel_words(static_cast<std::int32_t>(words_of(model.phyxels.cells))),
      hexel_material(device, hexels.cells),
      hexel_initial(device, hexel_words),
      hexel_held(device, hexel_words),
      phyxel_initial(device, phyxel_words),
      phyxel_ghost(device, phyxel_words),
      displacement_m(device, 3 * std::int64_t{phyxels.cells}),
      velocity_m_per_s(device, 3 * std::int64_t{phyxels.cells}),
      links(device, 9 * std::int64_t{phyxel_words}),
      phyxel_present(device, phyxel_words),
      hexel_present(device, hexel_words),
      enthalpy_J_per_m3(device, hexels.cells),
      water_kg_per_m3(device, hexels.cells),
      peak_temperature_K(device, hexels.cells),
      damage(device, hexels.cells) {
    hexel_material.upload(device, all_of(model.hexel_material));
    hexel_initial.upload(device, words_of(model.hexel_initial));
    hexel_held.upload(device, words_of(model.hexel_held));
    phyxel_initial.upload(device, words_of(model.phyxel_initial));
    phyxel_ghost.upload(device, words_of(model.phyxel_ghost));
}

void Arrays::upload(Device& device, const tissue::State& state) {
    for (std::size_t r = 0; r < 3; ++r) {
        const std::int64_t plane = static_cast<std::int64_t>(r) * phyxels.cells;
        displacement_m.upload(device, all_of(state.displacement_m[r]), plane);
        velocity_m_per_s.upload(device, all_of(state.velocity_m_per_s[r]), plane);
    }
    for (std::size_t d = 0; d < state.links.size(); ++d)
        links.upload(device, words_of(state.links[d]), static_cast<std::int64_t>(d) * phyxel_words);
    phyxel_present.upload(device, words_of(state.phyxel_present));
    hexel_present.upload(device, words_of(state.hexel_present));
    enthalpy_J_per_m3.upload(device, all_of(state.enthalpy_J_per_m3));
    water_kg_per_m3.upload(device, all_of(state.water_kg_per_m3));
    peak_temperature_K.upload(device, all_of(state.peak_temperature_K));
    damage.upload(device, all_of(state.damage));
}

void Arrays::download(Device& device, tissue::State& state) const {
    for (std::size_t r = 0; r < 3; ++r) {
        const std::int64_t plane = static_cast<std::int64_t>(r) * phyxels.cells;
        displacement_m.download(device, std::span<float>(state.displacement_m[r]), plane);
        velocity_m_per_s.download(device, std::span<float>(state.velocity_m_per_s[r]), plane);
    }
    for (std::size_t d = 0; d < state.links.size(); ++d)
        links.download(device, words_of(state.links[d]), static_cast<std::int64_t>(d) * phyxel_words);
    phyxel_present.download(device, words_of(state.phyxel_present));
    hexel_present.download(device, words_of(state.hexel_present));
    enthalpy_J_per_m3.download(device, std::span<float>(state.enthalpy_J_per_m3));
    water_kg_per_m3.download(device, std::span<float>(state.water_kg_per_m3));
    peak_temperature_K.download(device, std::span<float>(state.peak_temperature_K));
    damage.download(device, std::span<float>(state.damage));
}

std::uint64_t Arrays::bytes() const {
    std::uint64_t total = 0;
    for (const Buffer* buffer :
         {&hexel_material.buffer(), &hexel_initial.buffer(), &hexel_held.buffer(), &phyxel_initial.buffer(),
          &phyxel_ghost.buffer(), &displacement_m.buffer(), &velocity_m_per_s.buffer(), &links.buffer(),
          &phyxel_present.buffer(), &hexel_present.buffer(), &enthalpy_J_per_m3.buffer(), &water_kg_per_m3.buffer(),
          &peak_temperature_K.buffer(), &damage.buffer()})
        total += buffer->bytes();
    return total;
}

}  // namespace calot::gpu

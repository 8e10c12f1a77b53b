#pragma once
// Model's constants and State's big arrays on a device: planar over the lattices and in the order of bits as on the
// host (base/lattice.h, base/array.h). Vectors are one array of three planes, x first.

#include "calot/gpu/device.h"
#include "calot/gpu/kernels/types.h"
#include "calot/tissue/model.h"
#include "calot/tissue/state.h"

namespace calot::gpu {

/// A lattice as kernels get it.
GpuLattice lattice_of(const Lattice& lattice);
/// 32-bit words of a bit array over so many cells (base/array.h).
inline std::int64_t words_of(std::int64_t cells) {
    return 2 * (cells / 64 + 2);
}
/// Its words, as a device keeps them.
inline std::span<const std::uint32_t> words_of(const BitArray& bits) {
    return {reinterpret_cast<const std::uint32_t*>(bits.words().data()), 2 * bits.words().size()};
}
inline std::span<std::uint32_t> words_of(BitArray& bits) {
    return {reinterpret_cast<std::uint32_t*>(bits.words().data()), 2 * bits.words().size()};
}

struct Arrays {
    GpuLattice hexels{}, phyxels{};
    std::int32_t hexel_words = 0, phyxel_words = 0;  ///< of a bit array

    // Constant
    DeviceArray<std::uint8_t> hexel_material;                 ///< [hexels.cells]
    DeviceArray<std::uint32_t> hexel_initial, hexel_held;     ///< [hexel_words]
    DeviceArray<std::uint32_t> phyxel_initial, phyxel_ghost;  ///< [phyxel_words]

    // State: phyxels, written by gpu::Deformation
    DeviceArray<float> displacement_m, velocity_m_per_s;  ///< [3][phyxels.cells]
    DeviceArray<std::uint32_t> links;                     ///< [9][phyxel_words]
    DeviceArray<std::uint32_t> phyxel_present;            ///< [phyxel_words]

    // State: hexels [hexels.cells], written by gpu::Heat (and by gpu::Deformation when crumbs fall)
    DeviceArray<std::uint32_t> hexel_present;  ///< [hexel_words]
    DeviceArray<float> enthalpy_J_per_m3, water_kg_per_m3, peak_temperature_K, damage;

    Arrays() = default;
    /// Room for everything, and what is constant.
    Arrays(Device& device, const tissue::Model& model);

    void upload(Device& device, const tissue::State& state);
    /// Into a state of the same model; all else in it stays as it is.
    void download(Device& device, tissue::State& state) const;

    /// Of all buffers together.
    std::uint64_t bytes() const;
};

}  // namespace calot::gpu

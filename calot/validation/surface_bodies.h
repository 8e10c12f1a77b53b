#pragma once
// Hexel bodies for checks of the surface: any set of cells of a small lattice.

#include <functional>

#include "calot/base/random.h"
#include "calot/surface/surface.h"
#include "calot/tissue/state.h"

namespace calot::surface {

inline constexpr double kTestSpacing_m = 0.6e-3;

struct Body {
    tissue::Model model;
    tissue::State state;

    Body(const Int3& size, const std::function<bool(const Int3&)>& filled) {
        model.hexels = Lattice::make(Vec3(0.01, -0.02, 0.03), kTestSpacing_m, size);
        model.hexel_initial = BitArray(model.hexels.cells);
        for (int z = 0; z < size.z; ++z)
            for (int y = 0; y < size.y; ++y)
                for (int x = 0; x < size.x; ++x)
                    if (filled({x, y, z})) model.hexel_initial.set(model.hexels.index(x, y, z));
        state.hexel_present = model.hexel_initial;
    }
    std::vector<std::int64_t> hexels() const {
        std::vector<std::int64_t> all;
        for (std::int64_t h = model.hexels.first; h < model.hexels.last; ++h)
            if (state.hexel_present.test(h)) all.push_back(h);
        return all;
    }
    double volume_m3() const { return static_cast<double>(state.hexel_present.count()) * model.hexel_volume_m3(); }
    /// Removes hexels from the state and updates the surface.
    void remove(const std::vector<std::int64_t>& hexels, Surface& surface) {
        tissue::Exchange exchange;
        exchange.removed_hexels = hexels;
        for (std::int64_t h : hexels) state.hexel_present.clear(h);
        surface.remove(exchange);
        surface.redo_dirty_blocks();
    }
};

/// Fisher-Yates.
template <class T>
void shuffle(std::vector<T>& items, Random& random) {
    for (std::size_t k = items.size(); k > 1; --k) std::swap(items[k - 1], items[random.next() % k]);
}

inline Body ball(int size, double radius, const Vec3& shift = Vec3(0.0)) {
    return Body(Int3(size), [=](const Int3& c) { return glm::length(Vec3(c) - 0.5 * (size - 1) - shift) < radius; });
}
inline Body sheet(const Int3& size) {
    return Body(size, [=](const Int3& c) {
        return c.x == size.x / 2 && c.y > 0 && c.z > 0 && c.y < size.y - 1 && c.z < size.z - 1;
    });
}
/// Every second cell: hexels touch along edges only, every cube is ambiguous.
inline Body checkerboard(int size) {
    return Body(Int3(size), [](const Int3& c) { return (c.x + c.y + c.z) % 2 == 0; });
}
inline Body noise(const Int3& size, double share, std::uint64_t seed) {
    Random random(seed);
    return Body(size, [&random, share](const Int3&) { return random.uniform() < share; });
}

}  // namespace calot::surface

#include "memory.h"

#include <malloc.h>

#include "calot/deformation/work.h"
#include "calot/effects/smoke.h"
#include "calot/electric/solve.h"
#include "calot/surface/surface.h"
#include "calot/thermal/heat.h"
#include "calot/tissue/exchange.h"

namespace calot::app {

namespace {

template <class T>
std::int64_t bytes_of(const Array<T>& array) {
    return static_cast<std::int64_t>(array.size() * sizeof(T));
}
std::int64_t bytes_of(const BitArray& bits) {
    return bytes_of(bits.words());
}

/// In use on the heap, large blocks included, and by large arrays beside it.
std::int64_t heap_bytes() {
    const struct mallinfo2 info = ::mallinfo2();
    return static_cast<std::int64_t>(info.uordblks + info.hblkhd + large_array_bytes());
}

/// What `make` leaves on the heap as long as its result lives.
template <class Make>
std::int64_t bytes_made(const Make& make) {
    const std::int64_t before = heap_bytes();
    [[maybe_unused]] const auto made = make();
    return heap_bytes() - before;
}

std::int64_t phyxel_bytes(const tissue::Model& model, const tissue::State& state, std::int64_t& of_model) {
    of_model = bytes_of(model.phyxel_initial) + bytes_of(model.phyxel_ghost);
    std::int64_t of_state = bytes_of(state.phyxel_present);
    for (const auto& bits : state.links) of_state += bytes_of(bits);
    for (const auto& component : state.displacement_m) of_state += bytes_of(component);
    for (const auto& component : state.velocity_m_per_s) of_state += bytes_of(component);
    return of_state;
}

}  // namespace

MemoryUse memory_use(const simulation::Setup& setup, const tissue::State& state) {
    const tissue::Model& model = setup.model;
    MemoryUse use;
    tissue::State copy = state;  // fields() lists what may be written
    for (const tissue::Field& field : tissue::fields(copy)) use.state += static_cast<std::int64_t>(field.bytes);
    std::int64_t model_phyxels = 0;
    const std::int64_t state_phyxels = phyxel_bytes(model, state, model_phyxels);
    use.model =
        bytes_of(model.hexel_material) + bytes_of(model.hexel_initial) + bytes_of(model.hexel_held) + model_phyxels;

    const auto room = [&](const char* name, std::int64_t bytes) {
        use.work_of_rooms.emplace_back(name, bytes);
        use.work += bytes;
    };
    room("deformation", bytes_made([&] { return deformation::make_work(model, state); }));
    const std::int64_t deformation = use.work;
    room("electric", bytes_made([&] { return electric::make_work(model); }));
    room("thermal", bytes_made([&] { return thermal::make_work(model, state); }));
    const auto surface_bytes = [&](bool with_pictures) {
        return bytes_made([&] {
            surface::Surface surface(model);
            surface.rebuild(model, state);
            if (with_pictures) static_cast<void>(surface.smooth_mesh());
            return surface;
        });
    };
    room("surface", surface_bytes(false));
    use.pictures = surface_bytes(true) - use.work_of_rooms.back().second;
    room("exchange", bytes_made([&] {
             tissue::Exchange exchange;
             tissue::reserve_exchange(model, exchange);
             return exchange;
         }));
    room("smoke", bytes_made([&] { return effects::Smoke(setup.smoke); }));
    use.of_phyxels = model_phyxels + state_phyxels + deformation;
    use.of_hexels = use.all() - use.of_phyxels;
    return use;
}

}  // namespace calot::app

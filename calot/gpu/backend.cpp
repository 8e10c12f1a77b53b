#include "calot/gpu/backend.h"

#include <algorithm>

#include <fmt/format.h>

#include "calot/simulation/step_parts.h"

namespace calot::gpu {

namespace {

using simulation::BackendError;
using simulation::Stage;

/// What goes wrong on a device is told as the simulation expects it.
template <class Act>
auto guarded(const Act& act) {
    try {
        return act();
    } catch (const DeviceError& error) {
        throw BackendError(error.what());
    }
}

}  // namespace

std::uint64_t device_bytes(const tissue::Model& model) {
    // Per cell: arrays of State and Model 17, temperature, steam and conductivity 12, lists 20, surface's edges 1,
    // bits.
    constexpr std::uint64_t kHexel = 52;
    // 13 of rest, 24 of motion and stress, masses, words, lists.
    constexpr std::uint64_t kPhyxel = 4 * 70;
    // Levels of the grid, potential, heat.
    constexpr std::uint64_t kWindowCell = 160;
    constexpr std::uint64_t kRest = 16 << 20;  // vertices and triangles, near hexels, contacts
    const auto window = static_cast<std::uint64_t>(model.electric.window_cells);
    return kHexel * static_cast<std::uint64_t>(model.hexels.cells) +
           kPhyxel * static_cast<std::uint64_t>(model.phyxels.cells) + kWindowCell * window * window * window + kRest;
}

Backend::Rooms::Rooms(const std::shared_ptr<Device>& device, const tissue::Model& model)
    : arrays(*device, model),
      deformation(device, model, arrays),
      field(device, model, arrays),
      heat(device, model, arrays),
      surface(device, model) {}

Backend::Backend(const DeviceInfo& info, const simulation::Setup& setup) {
    constexpr std::int64_t kMostCells = std::int64_t{1} << 28;  // of 32 bits, bytes within a plane must be counted, too
    if (setup.model.hexels.cells > kMostCells)
        throw BackendError(fmt::format("{} cells are more than a device counts", setup.model.hexels.cells));
    const std::uint64_t bytes = device_bytes(setup.model);
    if (info.memory_bytes < bytes)
        throw BackendError(fmt::format("{} has {} MB of memory, the scene needs about {} MB", info.name,
                                       info.memory_bytes >> 20, bytes >> 20));
    guarded([&] {
        device_ = Device::open(info);
        rooms_ = std::make_unique<Rooms>(device_, setup.model);
    });
}

std::string Backend::name() const {
    return fmt::format("{} ({})", device_->info().name, device_->info().api == Api::cuda ? "CUDA" : "OpenCL");
}

void Backend::begin(const tissue::Model& model, tissue::State& state, simulation::Work&) {
    guarded([&] {
        rooms_->arrays.upload(*device_, state);
        rooms_->deformation.take(state);
        rooms_->field.upload(state);
        rooms_->heat.look_at(model, state);
    });
    surface_is_current_ = true;
}

void Backend::step(const tissue::Model& model, tissue::State& state, simulation::Work& work,
                   const tissue::Input& input) {
    tissue::Exchange& exchange = work.exchange;
    Rooms& r = *rooms_;
    simulation::clear_exchange(exchange);
    guarded([&] {
        // Times are the host's: to enqueue, and where it waits, to wait for all that was enqueued before.
        simulation::StageClock clock(work.stage_us);
        simulation::place_instruments(model, state, work, input);
        r.deformation.find_near(exchange, simulation::near_reach(model, state, exchange, input));
        simulation::find_contacts(model, state, work);
        clock.lap(Stage::contact);

        r.deformation.advance(state, exchange);
        clock.lap(Stage::deformation);
        r.field.step(model, state, exchange, input);
        clock.lap(Stage::electric);
        if (input.wipe_tip) state.tip.char_kg = 0.0;
        r.heat.conduct(model, state, exchange, r.field.joule_S_per_m3());
        r.deformation.finish_advance(state, exchange);
        simulation::remember_instruments(state, exchange, input);
        clock.lap(Stage::heat);

        r.heat.remove_vaporised(model, state, exchange);
        simulation::list_gas(model, work);  // while the phyxels that carried it are still there
        r.deformation.embed_points(work.gas.rest_m, work.gas.owner, work.gas.world_m);
        simulation::place_gas(model, work);
        clock.lap(Stage::removal);

        r.deformation.tear_and_sever(state, exchange);
        clock.lap(Stage::topology);

        if (!exchange.removed_hexels.empty()) surface_is_current_ = false;
        clock.lap(Stage::surface);  // made when somebody wants to see it

        fetch_about_breaches(model, state, work.bleeding);
        work.smoke.step(exchange, work.gas.event_m, state.tick, model.tick_s, input.suction);
        work.bleeding.step(model, state, exchange, input);
        clock.lap(Stage::smoke);
    });
    ++state.tick;
}

/// Heat closes breached arteries: the host looks at the hexels about them.
void Backend::fetch_about_breaches(const tissue::Model& model, tissue::State& state,
                                   const effects::Bleeding& bleeding) {
    const Lattice& lattice = model.hexels;
    for (const effects::Breach& breach : bleeding.breaches()) {
        if (breach.opening <= 0.0f || state.tick % model.frame_ticks != 0) continue;
        const Int3 reach(effects::Bleeding::kSealReach), cell = lattice.coordinates(breach.hexel);
        const Int3 low = glm::max(cell - reach, Int3(0)), high = glm::min(cell + reach, lattice.size - 1);
        const std::int64_t first = lattice.index(low), last = lattice.index(high);
        const auto from = static_cast<std::size_t>(first), count = static_cast<std::size_t>(last - first + 1);
        rooms_->arrays.enthalpy_J_per_m3.download(
            *device_, std::span<float>(state.enthalpy_J_per_m3).subspan(from, count), first);
        rooms_->arrays.water_kg_per_m3.download(*device_, std::span<float>(state.water_kg_per_m3).subspan(from, count),
                                                first);
    }
}

void Backend::fetch_state(const tissue::Model&, tissue::State& state, simulation::Work& work) {
    guarded([&] {
        const Rooms& r = *rooms_;
        r.arrays.download(*device_, state);
        r.field.download(state);
        r.heat.temperature_K().download(*device_, std::span<float>(work.thermal.temperature_K));
    });
}

void Backend::fetch_surface(const tissue::Model&, const tissue::State&, simulation::Work& work) {
    if (surface_is_current_) return;
    guarded([&] {
        surface::Mesh mesh;
        std::vector<std::int64_t> owner;
        rooms_->surface.rebuild(rooms_->arrays.hexel_present);
        rooms_->surface.download(mesh, owner);
        work.surface.adopt(std::move(mesh), std::move(owner));
    });
    surface_is_current_ = true;
}

void Backend::embed_surface(const simulation::Work& work, std::span<Vec3f> world_m,
                            std::span<Mat3f> deformation_gradient) {
    if (world_m.empty()) return;
    guarded([&] {
        Vertices& v = vertices_;
        const auto count = static_cast<std::int64_t>(world_m.size());
        if (v.version != work.surface.version()) {
            const surface::Mesh& mesh = work.surface.smooth_mesh();
            if (v.owner.size() < count) {
                const std::int64_t room = count + count / 2;
                v.rest_m = DeviceArray<float>(*device_, 3 * room);
                v.world_m = DeviceArray<float>(*device_, 3 * room);
                v.gradient = DeviceArray<float>(*device_, 9 * room);
                v.owner = DeviceArray<std::int32_t>(*device_, room);
                v.count = DeviceArray<std::int32_t>(*device_, 1);
            }
            const std::vector<std::int32_t> owner(work.surface.owner().begin(), work.surface.owner().end());
            const auto number = static_cast<std::int32_t>(count);
            device_->write(v.rest_m.buffer(), mesh.position_m.data(), mesh.position_m.size() * sizeof(Vec3f));
            v.owner.upload(*device_, std::span<const std::int32_t>(owner));
            v.count.upload(*device_, std::span<const std::int32_t>(&number, 1));
            v.version = work.surface.version();
        }
        rooms_->deformation.embed_points(v.rest_m, v.owner, v.count, count, v.world_m, &v.gradient);
        device_->read(v.world_m.buffer(), world_m.data(), world_m.size_bytes());
        device_->read(v.gradient.buffer(), deformation_gradient.data(), deformation_gradient.size_bytes());
    });
}

}  // namespace calot::gpu

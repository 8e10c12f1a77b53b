#pragma once
// Heat alone, on the device and on the host side by side.

#include "calot/gpu/heat.h"
#include "calot/tissue/exchange.h"
#include "calot/validation/heat_rig.h"
#include "gpu/rig.h"
#include "thermal/burn_bodies.h"

namespace calot::gpu {

/// Edge of the window of Joule heat.
inline constexpr int kBox = 16;

/// The body of thermal's tests of burning.
inline tissue::Model burning_body(const Int3& size, tissue::PhaseModel phase = tissue::PhaseModel::water_then_solids) {
    tissue::Model model = thermal::burn_model(size, phase);
    model.electric.window_cells = kBox;
    return model;
}

/// A run of heat alone on a device, as thermal::HeatRun is on the host.
struct GpuHeatRun {
    std::shared_ptr<Device> device = test_device();
    tissue::Model model;
    tissue::State state;  ///< what lies on the device is brought up to date by fetch()
    tissue::Exchange exchange;
    Arrays arrays;
    Heat heat;
    DeviceArray<float> joule;

    GpuHeatRun(tissue::Model m, tissue::State s)
        : model(std::move(m)),
          state(std::move(s)),
          arrays(*device, model),
          heat(device, model, arrays),
          joule(*device, kBox * kBox * kBox) {
        tissue::reserve_exchange(model, exchange);
        start();
    }
    void start() {
        arrays.upload(*device, state);
        heat.look_at(model, state);
    }
    /// The heat and the wire of another run.
    void follow(const tissue::Exchange& other) {
        exchange.joule = other.joule;
        exchange.near = other.near;
        exchange.capsules = other.capsules;
        if (other.joule.size == Int3(0)) return;
        joule.upload(*device, other.joule.density);
        state.field_low = other.joule.low;
        state.field.tissue_S = other.joule.total_W / static_cast<double>(other.joule.scale);
    }
    void tick() {
        exchange.gas.clear();
        exchange.removed_hexels.clear();
        heat.conduct(model, state, exchange, joule);
        heat.remove_vaporised(model, state, exchange);
        ++state.tick;
    }
    void fetch() { arrays.download(*device, state); }
};

/// Heat that falls off as 1/r^4 from a spot on the surface which moves along x, in hexels that are present.
inline void burn_spot(thermal::HeatRun& run, std::int64_t tick) {
    const Int3 size = run.model.hexels.size, box(kBox);
    run.exchange.joule.outflow_W = 10.0;
    const Vec3 spot(6.0 + 0.01 * static_cast<double>(tick), 0.5 * size.y, size.z - 3.0);
    run.set_joule(Int3(spot) - kBox / 2, box, [&](const Int3& c) {
        const Vec3 d = Vec3(c) - spot;
        const bool there = run.model.hexels.contains(c) && run.state.hexel_present.test(run.model.hexels.index(c));
        return there ? 2e10 / std::pow(1.0 + 0.3 * glm::dot(d, d), 2.0) : 0.0;
    });
    tissue::JouleHeat& joule = run.exchange.joule;
    joule.total_W = 0.0;
    for (const float density : joule.density) joule.total_W += static_cast<double>(density * joule.scale);
    joule.total_W *= run.model.hexel_volume_m3();
}

/// A bare wire over a run of surface hexels, of which every second one is touched.
inline void lay_wire(const tissue::Model& model, const tissue::State& state, tissue::Exchange& exchange) {
    exchange.near.clear();
    exchange.capsules.clear();
    tissue::Capsule wire;
    wire.a_m = Vec3(0.0);
    wire.b_m = Vec3(0.010, 0.0, 0.0);
    wire.radius_m = 0.5e-3;
    wire.bare = true;
    exchange.capsules.push_back(wire);
    wire.bare = false;
    exchange.capsules.push_back(wire);
    const Int3 size = model.hexels.size;
    for (int x = 4; x < size.x - 4; ++x)
        for (int y = size.y / 2 - 2; y < size.y / 2 + 2; ++y)
            for (int z = size.z - 1; z >= 0; --z) {
                const std::int64_t hexel = model.hexels.index(x, y, z);
                if (!state.hexel_present.test(hexel)) continue;
                tissue::NearHexel near;
                near.hexel = hexel;
                near.bare_gap_m = x % 2 == 0 ? 0.0f : 1e-3f;
                exchange.near.push_back(near);
                break;
            }
}

}  // namespace calot::gpu

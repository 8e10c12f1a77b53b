#include "bench_gpu.h"

#include <algorithm>
#include <chrono>

#include <fmt/format.h>

#include "bench_bodies.h"
#include "calot/base/random.h"
#include "calot/deformation/topology.h"
#include "calot/gpu/backend.h"
#include "calot/gpu/scan.h"
#include "calot/simulation/simulation.h"

namespace calot::app {

namespace {

using Clock = std::chrono::steady_clock;

double us_since(Clock::time_point start) {
    return std::chrono::duration<double, std::micro>(Clock::now() - start).count();
}

/// Averages of so many calls, from the device's counters.
void take_counters(const gpu::Counters& counters, double calls, DeviceCost& cost) {
    const auto each = [&](auto value) { return static_cast<double>(value) / calls; };
    cost.kernels_us = each(counters.kernel_s * 1e6);
    cost.transfers_us = each(counters.transfer_s * 1e6);
    cost.launches = each(counters.launches);
    cost.reads = each(counters.reads);
    cost.bytes_up = each(counters.bytes_up);
    cost.bytes_down = each(counters.bytes_down);
    for (const auto& [kernel, seconds] : counters.kernel_s_of) cost.kernel_us.emplace_back(kernel, each(seconds * 1e6));
    std::sort(cost.kernel_us.begin(), cost.kernel_us.end(),
              [](const auto& a, const auto& b) { return a.second > b.second; });
}

/// Least time of a few repetitions.
template <class Body>
double least_us(int repetitions, const Body& body) {
    double least = 1e300;
    for (int k = 0; k < repetitions; ++k) {
        const auto start = Clock::now();
        body();
        least = std::min(least, us_since(start));
    }
    return least;
}

void measure_limits(gpu::Device& device, DeviceBench& out) {
    // A kernel of one group that does next to nothing.
    const gpu::Kernel small = device.kernel("scan", "popcounts");
    gpu::DeviceArray<std::uint32_t> words(device, 64);
    gpu::DeviceArray<std::int32_t> counts(device, 64);
    constexpr int kMany = 200;
    const auto launch = [&] { device.launch(small, 64, 64, words, 64, counts); };
    launch();
    device.finish();
    out.launch_us = least_us(20,
                             [&] {
                                 for (int k = 0; k < kMany; ++k) launch();
                                 device.finish();
                             }) /
                    kMany;
    out.round_trip_us = least_us(100, [&] {
        launch();
        std::int32_t x = 0;
        device.read(counts.buffer(), &x, sizeof(x));
    });
    std::vector<std::uint8_t> host(std::size_t{32} << 20, 1);
    gpu::Buffer a = device.make_buffer(host.size()), b = device.make_buffer(host.size());
    const auto GB_per_s = [&](double us) { return static_cast<double>(host.size()) / us * 1e-3; };
    out.up_GB_per_s = GB_per_s(least_us(5, [&] { device.write(a, host.data(), host.size()); }));
    out.down_GB_per_s = GB_per_s(least_us(5, [&] { device.read(a, host.data(), host.size()); }));
    out.copy_GB_per_s = 2.0 * GB_per_s(least_us(5, [&] {
                            device.copy(a, b, host.size());
                            device.finish();
                        }));
}

/// A body on a device, with all rooms.
struct DeviceBody {
    tissue::Model model;
    tissue::State state;
    tissue::Exchange exchange;
    tissue::Input input;
    std::shared_ptr<gpu::Device> device;
    gpu::Arrays arrays;
    gpu::Deformation deformation;
    gpu::Field field;
    gpu::Heat heat;
    gpu::Surface surface;

    DeviceBody(const gpu::DeviceInfo& info, tissue::Model of)
        : model(std::move(of)),
          state(tissue::State::make(model)),
          device(gpu::Device::open(info)),
          arrays(*device, model),
          deformation(device, model, arrays),
          field(device, model, arrays),
          heat(device, model, arrays),
          surface(device, model) {
        deformation::sever_initial_links(model, state);
        tissue::reserve_exchange(model, exchange);
        input.pedal = true;
        input.power_setting_W = 40.0;
    }
    void start() {
        arrays.upload(*device, state);
        deformation.take(state);
        field.upload(state);
        heat.look_at(model, state);
    }
};

using Body = std::shared_ptr<DeviceBody>;

/// Times `run` as it is called, waiting included, then once more with the device's clocks on.
void measure_on_device(const std::string& name, const Body& body, std::int64_t size, const char* unit, double per_call,
                       const std::function<void()>& run, const BenchPlan& plan, BenchResults& results,
                       const Jobs::Report& report) {
    KernelCase kernel;
    kernel.name = name + ", device";
    kernel.size = size;
    kernel.unit = unit;
    kernel.per_call = per_call;
    kernel.run = [&] {
        run();
        body->device->finish();
    };
    results.kernels.push_back(measure(kernel, plan.per_kernel_s(), report));
    DeviceCost cost;
    cost.name = name;
    cost.size = size;
    cost.unit = unit;
    cost.us = results.kernels.back().us;
    constexpr int kCalls = 10;
    body->device->measure(true);
    body->device->counters() = {};
    for (int k = 0; k < kCalls; ++k) kernel.run();
    take_counters(body->device->counters(), kCalls * per_call, cost);
    body->device->measure(false);
    results.device.costs.push_back(std::move(cost));
}

void deformation_on_device(std::int64_t phyxels, const BenchPlan& plan, BenchResults& results,
                           const Jobs::Report& report) {
    const Body body = std::make_shared<DeviceBody>(*plan.device, phyxel_block(phyxels));
    body->model.deformation.gravity_m_per_s2 = Vec3(0.0, 0.0, -9.81);
    body->start();
    measure_on_device(
        "deformation step", body, body->state.phyxel_present.count(), "phyxels", body->deformation.host_work().substeps,
        [body] {
            body->deformation.advance(body->state, body->exchange);
            body->deformation.finish_advance(body->state, body->exchange);
        },
        plan, results, report);
}

/// Everywhere 37 to 42 C: every block is active, nothing boils.
void heat_on_device(std::int64_t hexels, const BenchPlan& plan, BenchResults& results, const Jobs::Report& report) {
    const Body body = std::make_shared<DeviceBody>(*plan.device, hexel_block(hexels));
    Random random(1);
    for (std::int64_t i = body->model.hexels.first; i < body->model.hexels.last; ++i)
        if (body->state.hexel_present.test(i))
            body->state.enthalpy_J_per_m3[static_cast<std::size_t>(i)] = static_cast<float>(random.uniform(0.0, 1e7));
    body->start();
    measure_on_device(
        "heat step, dense", body, body->state.hexel_present.count(), "hexels", 1.0,
        [body] {
            for (int k = 0; k < body->model.thermal.refresh_ticks; ++k) {
                body->exchange.gas.clear();
                body->exchange.removed_hexels.clear();
                body->heat.conduct(body->model, body->state, body->exchange, body->field.joule_S_per_m3());
                body->heat.remove_vaporised(body->model, body->state, body->exchange);
                ++body->state.tick;
            }
        },
        plan, results, report);
}

/// Metal on 3 x 8 hexels of the top; all ticks of a frame.
void field_on_device(const BenchPlan& plan, BenchResults& results, const Jobs::Report& report) {
    const Body body = std::make_shared<DeviceBody>(*plan.device, hexel_block(147'233));
    const Lattice& lattice = body->model.hexels;
    const Int3 middle = lattice.size / 2;
    int z = lattice.size.z - 1;
    while (z > 0 && !body->model.hexel_initial.test(lattice.index(middle.x, middle.y, z))) --z;
    for (int y = middle.y - 4; y < middle.y + 4; ++y)
        for (int dx = 0; dx < 3; ++dx) {
            tissue::NearHexel near;
            near.hexel = lattice.index(middle.x + dx, y, z);
            near.bare_gap_m = 0.0f;
            body->exchange.near.push_back(near);
        }
    body->start();
    const auto cells = static_cast<std::int64_t>(body->model.electric.window_cells);
    measure_on_device(
        "electric field, warm", body, cells * cells * cells, "cells of the window", 1.0,
        [body] {
            for (int k = 0; k < body->model.frame_ticks; ++k) {
                body->field.step(body->model, body->state, body->exchange, body->input);
                ++body->state.tick;
            }
        },
        plan, results, report);
}

void surface_on_device(std::int64_t hexels, const BenchPlan& plan, BenchResults& results, const Jobs::Report& report) {
    const Body body = std::make_shared<DeviceBody>(*plan.device, hexel_block(hexels));
    body->start();
    measure_on_device(
        "surface, whole", body, body->state.hexel_present.count(), "hexels", 1.0,
        [body] { body->surface.rebuild(body->arrays.hexel_present); }, plan, results, report);
    const std::int32_t vertices = body->surface.vertices();
    gpu::DeviceArray<std::int32_t> count(*body->device, 1);
    count.upload(*body->device, std::span<const std::int32_t>(&vertices, 1));
    gpu::DeviceArray<float> world(*body->device, 3 * std::int64_t{vertices}),
        gradients(*body->device, 9 * std::int64_t{vertices});
    measure_on_device(
        "embedding of the surface", body, vertices, "vertices", 1.0,
        [&] {
            body->deformation.embed_points(body->surface.position_m(), body->surface.owner(), count, vertices, world,
                                           &gradients);
        },
        plan, results, report);
}

}  // namespace

void add_device_limits(const BenchPlan& plan, Jobs& jobs, BenchResults& results) {
    jobs.add("launches and transfers", 1.0, [plan, &results](const Jobs::Report&) {
        results.device.name = gpu::describe(*plan.device);
        measure_limits(*gpu::Device::open(*plan.device), results.device);
    });
}

void add_device_kernels(const BenchPlan& plan, Jobs& jobs, BenchResults& results) {
    const auto add_job = [&](const std::string& label, auto job) {
        jobs.add(label + ", device", plan.per_kernel_s() + 1.0,
                 [plan, &results, job](const Jobs::Report& report) { job(plan, results, report); });
    };
    using Report = Jobs::Report;
    add_job("deformation, 3,041 phyxels", [](const BenchPlan& p, BenchResults& r, const Report& report) {
        deformation_on_device(3041, p, r, report);
    });
    add_job("heat, 147,233 hexels",
            [](const BenchPlan& p, BenchResults& r, const Report& report) { heat_on_device(147'233, p, r, report); });
    add_job("electric field",
            [](const BenchPlan& p, BenchResults& r, const Report& report) { field_on_device(p, r, report); });
    add_job("surface, 147,233 hexels", [](const BenchPlan& p, BenchResults& r, const Report& report) {
        surface_on_device(147'233, p, r, report);
    });
    if (plan.quick) return;
    add_job("deformation, 100,000 phyxels", [](const BenchPlan& p, BenchResults& r, const Report& report) {
        deformation_on_device(100'000, p, r, report);
    });
    add_job("heat, 1,178,091 hexels",
            [](const BenchPlan& p, BenchResults& r, const Report& report) { heat_on_device(1'178'091, p, r, report); });
    add_job("surface, 1,178,091 hexels", [](const BenchPlan& p, BenchResults& r, const Report& report) {
        surface_on_device(1'178'091, p, r, report);
    });
}

DeviceCost cost_of_ticks(const std::shared_ptr<const simulation::Setup>& setup, std::int64_t ticks,
                         const std::string& title, const Jobs::Report& report) {
    simulation::Simulation run(setup);
    DeviceCost cost;
    cost.name = title + ", a tick";
    cost.unit = "hexels";
    cost.size = run.figures().hexel_present.count();
    const auto* backend = dynamic_cast<const gpu::Backend*>(&run.backend());
    if (backend == nullptr) return cost;  // it fell back: notices tell
    backend->device().measure(true);
    backend->device().counters() = {};
    const auto start = Clock::now();
    std::int64_t tick = 0;
    for (; tick < ticks; ++tick) {
        if (!run.tick(setup->script.at(run.time_s()))) break;
        if (tick % 64 == 0 && !report(static_cast<double>(tick) / static_cast<double>(ticks))) break;
    }
    backend = dynamic_cast<const gpu::Backend*>(&run.backend());
    if (backend == nullptr) return cost;
    cost.us = us_since(start) / static_cast<double>(std::max<std::int64_t>(1, tick));
    take_counters(backend->device().counters(), static_cast<double>(std::max<std::int64_t>(1, tick)), cost);
    return cost;
}

}  // namespace calot::app

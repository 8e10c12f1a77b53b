// The kernels of the physics rooms, each at the sizes of its targets, with the model behind its floor.
//
// Operations are additions and multiplications (comparisons and choices are not counted), bytes are those of arrays
// that a kernel must read or write, each once, at its real size. Both are counted by hand from the kernels; a kernel
// that does better than its floor was counted wrong.

#include "bench_bodies.h"
#include "bench_suites.h"
#include "calot/base/random.h"
#include "calot/deformation/integrate.h"
#include "calot/deformation/reference.h"
#include "calot/deformation/topology.h"
#include "calot/electric/work.h"
#include "calot/thermal/heat.h"

namespace calot::app {

namespace {

// ---- Deformation

struct ElasticBody {
    tissue::Model model;
    tissue::State state;
    deformation::Work work;
    tissue::Exchange exchange;

    explicit ElasticBody(std::int64_t phyxels) : model(phyxel_block(phyxels)), state(tissue::State::make(model)) {
        model.deformation.gravity_m_per_s2 = Vec3(0.0, 0.0, -9.81);
        deformation::sever_initial_links(model, state);
        work = deformation::make_work(model, state);
        tissue::reserve_exchange(model, exchange);
    }
};

/// A substep of a phyxel with 18 links. Velocities: 294 for the links (28 a face pair, 35 an edge pair), 51 for the
/// rest. Gradients: 126 for the links, 9, then G 45, cofactors 27, stress 73, M 69. Displacements: 6.
constexpr double kSubstepOperations = 700.0;
/// Floats. Velocities: u, M, kappa, 1/m, gravity share, v in (18), v out (3). Displacements: u, v in, u out (9).
/// Gradients: u, A^-1, v, kappa, mu, lambda in (13), G and M out (18; G is not needed within a tick, but written).
constexpr double kSubstepBytes = 4.0 * (21.0 + 9.0 + 31.0);

}  // namespace

KernelCase deformation_step(std::int64_t phyxels, int threads, double target_us, bool with_reference) {
    auto body = std::make_shared<ElasticBody>(phyxels);
    KernelCase kernel;
    kernel.name = "deformation step";
    kernel.size = body->state.phyxel_present.count();
    kernel.unit = "phyxels";
    kernel.threads = threads;
    kernel.target_us = target_us;
    kernel.per_call = body->work.substeps;
    const auto size = static_cast<double>(kernel.size);
    kernel.floor = {size * kSubstepOperations, size * kSubstepBytes};
    kernel.run = [body] { deformation::integrate(body->model, body->state, body->exchange, body->work); };
    if (!with_reference) return kernel;
    auto reference = std::make_shared<deformation::Reference<float>>(body->model, body->state, body->work);
    reference->update_gradients();
    kernel.reference = [body, reference] {
        for (int k = 0; k < body->work.substeps; ++k) reference->advance(body->work.substep_s);
    };
    return kernel;
}

namespace {

// ---- Heat

struct HeatBody {
    tissue::Model model;
    tissue::State state;
    tissue::Exchange exchange;
    thermal::Work work, scalar;

    /// Everywhere 37 to 42 C: every block is active, nothing boils.
    explicit HeatBody(std::int64_t hexels) : model(hexel_block(hexels)), state(tissue::State::make(model)) {
        Random random(1);
        for (std::int64_t i = model.hexels.first; i < model.hexels.last; ++i)
            if (state.hexel_present.test(i))
                state.enthalpy_J_per_m3[static_cast<std::size_t>(i)] = static_cast<float>(random.uniform(0.0, 1e7));
        tissue::reserve_exchange(model, exchange);
        work = thermal::make_work(model, state);
    }
    /// All ticks of one heat step.
    void step(thermal::Work& with) {
        for (int k = 0; k < model.thermal.refresh_ticks; ++k) {
            exchange.gas.clear();
            exchange.removed_hexels.clear();
            thermal::conduct(model, state, exchange, with);
            thermal::remove_vaporised(model, state, exchange, with);
            ++state.tick;
        }
    }
};

/// Six neighbours at 3 each, perfusion 3, exposed faces 6, H 2; then T from H 4, peak 1.
constexpr double kHeatOperations = 34.0;
/// T, H in, H out, material; then H in, water in, T in and out, peak in and out (water and damage change only where it
/// is hot), presence bits.
constexpr double kHeatBytes = 4.0 * 3.0 + 1.0 + 4.0 * 6.0 + 0.5;

KernelCase heat_step(std::int64_t hexels, int threads, double target_us, bool with_reference) {
    auto body = std::make_shared<HeatBody>(hexels);
    KernelCase kernel;
    kernel.name = "heat step, dense";
    kernel.size = body->state.hexel_present.count();
    kernel.unit = "hexels";
    kernel.threads = threads;
    kernel.target_us = target_us;
    const auto size = static_cast<double>(kernel.size);
    kernel.floor = {size * kHeatOperations, size * kHeatBytes};
    kernel.run = [body] { body->step(body->work); };
    if (!with_reference) return kernel;
    body->scalar = thermal::make_work(body->model, body->state);
    body->scalar.scalar = true;
    kernel.reference = [body] { body->step(body->scalar); };
    return kernel;
}

// ---- Electric field

struct FieldBody {
    tissue::Model model;
    tissue::State state;
    tissue::Exchange exchange;
    tissue::Input input;
    electric::WorkPtr work;
    int refresh = 0;

    explicit FieldBody(const electric::Kernels& kernels) : model(hexel_block(147'233)) {
        model.electric.window_cells = 48;
        state = tissue::State::make(model);
        work = electric::make_work(model, kernels);
        input.pedal = true;
        input.power_setting_W = 40.0;
        tissue::reserve_exchange(model, exchange);
        wander();
        for (int k = 0; k < 4; ++k) solve();
    }
    /// Metal on 3 x 8 hexels; goes on by a hexel every fourth refresh and leaves a groove behind, mended at the end.
    void wander() {
        const Int3 middle = model.hexels.size / 2;
        const int x = middle.x - 8 + refresh / 4 % 16;
        if (x == middle.x - 8) state.hexel_present = model.hexel_initial;
        int z = model.hexels.size.z - 1;
        while (z > 0 && !model.hexel_initial.test(model.hexels.index(x, middle.y, z))) --z;
        exchange.near.clear();
        for (int y = middle.y - 4; y < middle.y + 4; ++y) {
            for (int dx = 0; dx < 3; ++dx) {
                tissue::NearHexel near;
                near.hexel = model.hexels.index(x + dx, y, z);
                near.bare_gap_m = 0.0f;
                exchange.near.push_back(near);
            }
            if (x > middle.x - 8) state.hexel_present.clear(model.hexels.index(x - 1, y, z));
        }
        ++refresh;
    }
    /// All ticks of one refresh.
    void solve() {
        wander();
        for (int k = 0; k < model.frame_ticks; ++k) {
            electric::step_field(model, state, exchange, input, *work);
            ++state.tick;
        }
    }
};

KernelCase electric_field(double target_us) {
    auto wide = std::make_shared<FieldBody>(electric::wide_kernels());
    auto plain = std::make_shared<FieldBody>(electric::reference_kernels());
    KernelCase kernel;
    kernel.name = "electric field, warm";
    kernel.unit = "cells of the window";
    kernel.size = std::int64_t{wide->model.electric.window_cells} * wide->model.electric.window_cells *
                  wide->model.electric.window_cells;
    kernel.target_us = target_us;
    kernel.run = [wide] { wide->solve(); };
    kernel.reference = [plain] { plain->solve(); };
    return kernel;
}

}  // namespace

void add_kernels(const BenchPlan& plan, Jobs& jobs, BenchResults& results) {
    const auto add = [&](const std::string& label, std::function<KernelCase()> make) {
        add_kernel(plan, jobs, results, label, std::move(make));
    };
    const int all = plan.threads;
    add("deformation, 3,041 phyxels", [] { return deformation_step(3041, 1, 21.0, true); });
    add("deformation, 4,510 phyxels", [] { return deformation_step(4510, 1, 32.0, true); });
    add("heat, 147,233 hexels", [] { return heat_step(147'233, 1, 50.0, true); });
    add("electric field, 48³", [] { return electric_field(1000.0); });
    add_embedding_kernels(plan, jobs, results);
    if (plan.quick) return;
    add("deformation, 100,000 phyxels", [] { return deformation_step(100'000, 1, 650.0, true); });
    add("heat, 1,178,091 hexels", [] { return heat_step(1'178'091, 1, 350.0, true); });
    if (all == 1) return;
    add("deformation, 100,000 phyxels, all threads",
        [all] { return deformation_step(100'000, all, all == 2 ? 350.0 : 0.0, true); });
    add("heat, 1,178,091 hexels, all threads",
        [all] { return heat_step(1'178'091, all, all == 2 ? 200.0 : 0.0, true); });
    add("heat, 10,000,000 hexels, all threads",
        [all] { return heat_step(10'000'000, all, all == 2 ? 3000.0 : 0.0, false); });
}

}  // namespace calot::app

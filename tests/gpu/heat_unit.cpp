// Heat kernels on random states, against the host's scalar reference.

#include "calot/base/random.h"
#include "gpu/heat_rig.h"

namespace calot::gpu {
namespace {

/// Boiling, dry, damaged and spent hexels and holes among healthy ones.
void scramble(thermal::HeatRun& run, Random& random) {
    const Lattice& lattice = run.model.hexels;
    for (std::int64_t i = lattice.first; i < lattice.last; ++i) {
        const auto h = static_cast<std::size_t>(i);
        if (!run.state.hexel_present.test(i)) continue;
        if (random.uniform() < 0.1) run.state.hexel_present.clear(i);
        if (random.uniform() < 0.3) run.state.water_kg_per_m3[h] *= static_cast<float>(random.uniform());
        if (random.uniform() < 0.1) run.state.water_kg_per_m3[h] = 0.0f;
        if (random.uniform() < 0.3) run.state.damage[h] = static_cast<float>(random.uniform(0.0, 1.5));
        run.state.enthalpy_J_per_m3[h] = static_cast<float>(random.uniform(-2e7, 6e8));
    }
    run.start();
    run.work.scalar = true;
}

/// One step of all hexels, with Joule heat and a hot wire.
void compare_step(tissue::PhaseModel phase, std::uint64_t seed) {
    tissue::Model model = burning_body({33, 29, 21}, phase);
    model.thermal.refresh_ticks = 1;
    thermal::HeatRun host(std::move(model));
    Random random(seed);
    scramble(host, random);
    host.state.tip.temperature_K = 420.0;
    host.state.tip.char_kg = 1e-8;
    GpuHeatRun device(host.model, host.state);
    host.exchange.joule.scale = 1.7f;
    burn_spot(host, 0);
    host.exchange.joule.wire_W = 0.5;
    lay_wire(host.model, host.state, host.exchange);
    device.follow(host.exchange);
    host.tick();
    device.tick();
    const std::vector<float> temperature_K = device.heat.temperature_K().download(*device.device);
    device.fetch();

    const tissue::State &a = device.state, &b = host.state;
    EXPECT_EQ(a.hexel_present.words(), b.hexel_present.words());
    EXPECT_FALSE(host.exchange.removed_hexels.empty());
    EXPECT_EQ(device.exchange.removed_hexels, host.exchange.removed_hexels);
    const Lattice& lattice = host.model.hexels;
    int warm = 0;
    for (std::int64_t i = lattice.first; i < lattice.last; ++i) {
        const auto h = static_cast<std::size_t>(i);
        if (!b.hexel_present.test(i)) continue;
        // exp() and the last digits of a sum may differ.
        ASSERT_NEAR(a.enthalpy_J_per_m3[h], b.enthalpy_J_per_m3[h], 100.0f) << i;
        ASSERT_NEAR(a.water_kg_per_m3[h], b.water_kg_per_m3[h], 2e-4f) << i;
        ASSERT_NEAR(temperature_K[h], host.work.temperature_K[h], 2e-4f) << i;
        ASSERT_NEAR(a.peak_temperature_K[h], b.peak_temperature_K[h], 2e-4f) << i;
        ASSERT_NEAR(a.damage[h], b.damage[h], 1e-6f + 1e-4f * b.damage[h]) << i;
        warm += host.work.temperature_K[h] > 370.0f ? 1 : 0;
    }
    EXPECT_GT(warm, 100);

    ASSERT_EQ(device.exchange.gas.size(), host.exchange.gas.size());
    EXPECT_GT(host.exchange.gas.size(), phase == tissue::PhaseModel::threshold ? 10u : 1000u);
    for (std::size_t k = 0; k < host.exchange.gas.size(); ++k) {
        EXPECT_EQ(device.exchange.gas[k].hexel, host.exchange.gas[k].hexel);
        EXPECT_NEAR(device.exchange.gas[k].steam_kg, host.exchange.gas[k].steam_kg, 1e-13);
        EXPECT_EQ(device.exchange.gas[k].smoke_kg, host.exchange.gas[k].smoke_kg);
    }
    const tissue::EnergyBudget &e = a.energy_J, &f = b.energy_J;
    EXPECT_NEAR(e.delivered, f.delivered, 1e-6 * std::abs(f.delivered));
    EXPECT_NEAR(e.surface, f.surface, 1e-6 * std::abs(f.surface));
    EXPECT_NEAR(e.perfusion, f.perfusion, 1e-6 * std::abs(f.perfusion));
    EXPECT_NEAR(e.gas, f.gas, 1e-6 * std::abs(f.gas));
    EXPECT_NEAR(e.latent, f.latent, 1e-6 * std::abs(f.latent));
    EXPECT_NEAR(e.tip, f.tip, 1e-5 * std::abs(f.tip));
    EXPECT_NE(f.tip, 0.0);
    EXPECT_NEAR(a.tip.temperature_K, b.tip.temperature_K, 1e-4);
    EXPECT_EQ(a.tip.char_kg, b.tip.char_kg);
    EXPECT_EQ(a.hexels_burnt, b.hexels_burnt);
}

TEST(GpuHeat, AStepIsTheScalarOne) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) compare_step(tissue::PhaseModel::water_then_solids, seed);
}
TEST(GpuHeat, AStepIsTheScalarOneWithAThreshold) {
    compare_step(tissue::PhaseModel::threshold, 11);
}

// What is at body temperature stays out of it, and what is beside something warm takes part. The host tells by groups
// of a block, the device by blocks.
TEST(GpuHeat, BlocksThatAreActiveOnTheHostAreActive) {
    tissue::Model model = burning_body({70, 60, 40});
    model.thermal.refresh_ticks = 1;
    thermal::HeatRun host(std::move(model));
    host.heat(host.model.hexels.index(50, 20, 20), 350.0);
    host.start();
    GpuHeatRun device(host.model, host.state);
    const Lattice& lattice = host.model.hexels;
    const std::int64_t blocks = thermal::block_count(lattice);
    for (int tick = 0; tick < 40; ++tick) {
        if (tick == 20) burn_spot(host, 0);
        thermal::BlockSet warm(blocks), near(blocks), box(blocks), reached(blocks * thermal::kBlockGroups);
        thermal::find_blocks(host.work.warm, warm);
        thermal::dilate(lattice, warm, thermal::kBlockCells, near);
        thermal::add_heated(lattice, host.exchange.joule, reached);
        thermal::find_blocks(reached, box);
        device.follow(host.exchange);
        host.tick();
        device.tick();
        const std::vector<std::int32_t> active = device.heat.active().download(*device.device);
        std::int64_t extra = 0;
        for (std::size_t b = 0; b < active.size(); ++b) {
            if (host.work.active.test(static_cast<std::int64_t>(b))) {
                ASSERT_EQ(active[b], 1) << b << ", tick " << tick;
            } else if (!near.test(static_cast<std::int64_t>(b)) && !box.test(static_cast<std::int64_t>(b))) {
                extra += active[b];
            }
        }
        EXPECT_LE(extra, 2) << tick;
        EXPECT_LT(4 * host.work.active.count(), static_cast<std::int64_t>(active.size()));
    }
    device.fetch();
    for (std::size_t h = 0; h < host.state.enthalpy_J_per_m3.size(); ++h)
        ASSERT_NEAR(device.state.enthalpy_J_per_m3[h], host.state.enthalpy_J_per_m3[h], 100.0f) << h;
}

// Hexels that are gas go as on the host from a state that is loaded, a quarter of them in every tick.
TEST(GpuHeat, WhatIsGasGoesAfterLoading) {
    thermal::HeatRun host(burning_body({33, 29, 21}));
    Random random(3);
    scramble(host, random);
    GpuHeatRun device(host.model, host.state);
    for (auto* state : {&host.state, &device.state}) state->tick = 4;  // no step on the device
    std::int64_t removed = 0;
    for (int tick = 0; tick < 3; ++tick) {
        thermal::remove_vaporised(host.model, host.state, host.exchange, host.work);
        device.tick();
        removed += static_cast<std::int64_t>(device.exchange.removed_hexels.size());
        EXPECT_EQ(removed, static_cast<std::int64_t>(host.exchange.removed_hexels.size()));
    }
    EXPECT_GT(removed, 0);
    device.fetch();
    EXPECT_EQ(device.state.hexel_present.words(), host.state.hexel_present.words());
    EXPECT_EQ(device.state.energy_J.gas, host.state.energy_J.gas);
}

// Numbers that are none stop the run and name the cell.
TEST(GpuHeat, ABadNumberIsFound) {
    tissue::Model model = burning_body({33, 29, 21});
    model.thermal.refresh_ticks = 1;
    thermal::HeatRun host(std::move(model));
    const std::int64_t bad = host.model.hexels.index(16, 14, 9);
    host.state.enthalpy_J_per_m3[static_cast<std::size_t>(bad)] = NAN;
    GpuHeatRun device(host.model, host.state);
    device.tick();
    EXPECT_FALSE(device.state.status.ok);
    EXPECT_STREQ(device.state.status.field, "enthalpy");
    EXPECT_EQ(device.state.status.cell, bad);
}

}  // namespace
}  // namespace calot::gpu

// The hot wire of the hook: its energy is kept, it heats what it touches, char keeps its heat in.

#include <gtest/gtest.h>

#include <numbers>

#include "calot/thermal/tip.h"
#include "calot/validation/heat_rig.h"

namespace calot::thermal {

namespace {

/// 10 mm of bare wire, 1 mm thick, and 5 mm under insulation.
std::vector<tissue::Capsule> hook_wire() {
    std::vector<tissue::Capsule> capsules(3);
    capsules[0].b_m = Vec3(5e-3, 0.0, 0.0);
    capsules[1].b_m = Vec3(0.0, 0.0, 5e-3);
    capsules[2].a_m = capsules[1].b_m;
    capsules[2].b_m = Vec3(0.0, 0.0, 10e-3);
    for (tissue::Capsule& capsule : capsules) capsule.radius_m = 0.5e-3;
    capsules[0].bare = capsules[1].bare = true;
    return capsules;
}

/// A block of liver whose top rows the wire touches.
HeatRun touched_block() {
    const auto all = tissue::default_materials();
    tissue::Model model = box_model({12, 12, 12}, 0.6e-3, 1e-3, {all[tissue::find_material(all, "liver")]});
    model.thermal.refresh_ticks = tissue::ThermalParameters{}.refresh_ticks;
    HeatRun run(std::move(model));
    run.exchange.capsules = hook_wire();
    for (int x = 2; x < 10; ++x)
        for (int y = 5; y < 7; ++y) {
            tissue::NearHexel near;
            near.hexel = run.model.hexels.index(x, y, 11);
            near.bare_gap_m = -1e-5f;
            run.exchange.near.push_back(near);
        }
    return run;
}

double wire_J(const HeatRun& run) {
    const BareWire wire = bare_wire(run.model.thermal, run.exchange.capsules);
    return wire.heat_capacity_J_per_K * (run.state.tip.temperature_K - run.model.thermal.body_temperature_K);
}

}  // namespace

TEST(Tip, ArcsHeatTheWireAndTheBudgetKnows) {
    HeatRun run = touched_block();
    run.exchange.joule.wire_W = 5.0;
    run.run(1000);
    const tissue::EnergyBudget& e = run.state.energy_J;
    EXPECT_NEAR(e.delivered, 5.0, 1e-9);
    EXPECT_GT(run.state.tip.temperature_K, run.model.thermal.body_temperature_K + 20.0);
    EXPECT_NEAR(wire_J(run) + run.state.tip.lost_J, e.tip, 1e-9 * e.delivered);
    EXPECT_NEAR(e.accounted() + stored_J(run.model, run.state), e.delivered, 1e-6 * e.delivered);
}

TEST(Tip, HeatsTissueAndKeepsItsEnergy) {
    HeatRun run = touched_block();
    run.state.tip.temperature_K = 473.15;
    const double before_J = wire_J(run);
    run.run(4000);
    const tissue::EnergyBudget& e = run.state.energy_J;
    EXPECT_LT(e.tip, -0.3 * before_J) << "most of a hot wire's heat goes into what it touches";
    EXPECT_GT(run.state.peak_temperature_K[static_cast<std::size_t>(run.exchange.near[5].hexel)], 340.0f);
    EXPECT_NEAR(wire_J(run) + run.state.tip.lost_J, before_J + e.tip, 1e-9 * before_J);
    // What it gave is in the tissue or went on from there.
    EXPECT_NEAR(e.accounted() + stored_J(run.model, run.state), 0.0, 1e-6 * before_J);
}

TEST(Tip, IsHeatedByTissue) {
    HeatRun run = touched_block();
    for (const tissue::NearHexel& near : run.exchange.near) run.heat(near.hexel, 370.0);
    run.start();
    run.run(400);
    EXPECT_GT(run.state.tip.temperature_K, 312.0);
    EXPECT_GT(run.state.energy_J.tip, 0.0);
}

TEST(Tip, CoolsInAirExponentially) {
    HeatRun run = touched_block();
    run.exchange.near.clear();
    run.state.tip.temperature_K = 410.15;
    const BareWire wire = bare_wire(run.model.thermal, run.exchange.capsules);
    EXPECT_NEAR(wire.area_m2, std::numbers::pi * 1e-3 * 10e-3, 1e-12);
    run.run(8000);
    const double exact = 100.0 * std::exp(-8.0 * wire.loss_W_per_K / wire.heat_capacity_J_per_K);
    // First order in the step of 4 ms against a time constant of some 13 s: 100 K (4e-3 / 13) (8 / 13) / 2 / e^0.6.
    EXPECT_NEAR(run.state.tip.temperature_K - 310.15, exact, 0.02);
    EXPECT_EQ(run.work.active.count(), 0);
}

TEST(Tip, CharInsulates) {
    double given_J[2];
    for (const double char_kg : {0.0, 5e-6}) {
        HeatRun run = touched_block();
        run.state.tip.temperature_K = 473.15;
        run.state.tip.char_kg = char_kg;
        run.run(1000);
        given_J[char_kg > 0.0 ? 1 : 0] = -run.state.energy_J.tip;
    }
    EXPECT_LT(given_J[1], 0.8 * given_J[0]);
}

TEST(Tip, ColdTouchLeavesNoTrace) {
    HeatRun run = touched_block();
    const std::uint64_t before = tissue::hash(run.state);
    run.run(400);
    run.state.tick = 0;
    EXPECT_EQ(tissue::hash(run.state), before);
}

TEST(Tip, WhatBurnsBesideItSticks) {
    HeatRun run = touched_block();
    const std::int64_t hexel = run.exchange.near[3].hexel, other = run.model.hexels.index(1, 1, 1);
    for (const std::int64_t cell : {hexel, other}) {
        run.state.water_kg_per_m3[static_cast<std::size_t>(cell)] = 0.0f;
        run.state.enthalpy_J_per_m3[static_cast<std::size_t>(cell)] = 2e9f;
    }
    run.start();
    double smoke_kg = 0.0;
    for (int k = 0; k < 8; ++k) {
        run.tick();
        for (const tissue::GasEvent& event : run.exchange.gas) smoke_kg += static_cast<double>(event.smoke_kg);
    }
    EXPECT_EQ(run.state.hexels_burnt, 2);
    const tissue::Material& liver = run.model.materials[1];
    const double solids_kg = liver.density_kg_per_m3 * (1.0 - liver.water_mass_fraction) * run.model.hexel_volume_m3();
    EXPECT_NEAR(run.state.tip.char_kg, run.model.thermal.tip_char_share * solids_kg, 1e-6 * solids_kg);
    EXPECT_NEAR(smoke_kg + run.state.tip.char_kg, 2.0 * solids_kg, 1e-6 * solids_kg);
}

}  // namespace calot::thermal

// The solver and the generator, part by part.

#include <cmath>

#include <gtest/gtest.h>

#include "calot/base/random.h"
#include "calot/electric/generator.h"
#include "calot/validation/electric_rig.h"

namespace calot::electric {

// Multigrid keeps the number of iterations nearly independent of the size: doubling the window's edge three times.
TEST(Solver, IterationsGrowSlowly) {
    int first = 0;
    for (const int cells : {16, 32, 64}) {
        Rig rig = disc_rig(cells, 2.0, 0.1, 1e-6);
        rig.solve();
        if (first == 0) first = rig.work->iterations;
        EXPECT_GT(rig.work->iterations, 3);
        EXPECT_LE(rig.work->iterations, first + 8) << cells << " cells, " << first << " at 16";
        EXPECT_LT(rig.work->iterations, rig.model.electric.max_iterations);
    }
}

// Conjugate gradients need M symmetric and positive: u . M v = v . M u.
TEST(Solver, PreconditionerIsSymmetricPositive) {
    Rig rig = held_rig(1e-2);
    gather(rig.model, rig.state, rig.exchange, rig.input, *rig.work);
    assemble(rig.model, *rig.work);
    prepare(rig.state, *rig.work);
    Multigrid& grid = rig.work->grid;
    Level& fine = rig.work->grid.levels[0];
    const auto length = static_cast<std::size_t>(fine.length);
    auto random_vector = [&](std::uint64_t seed) {
        Random random(seed);
        Array<float> v(length);
        for (std::size_t i = 0; i < length; ++i)
            v[i] = fine.weight[i] > 0.0f ? static_cast<float>(random.uniform(-1.0, 1.0)) : 0.0f;
        return v;
    };
    auto dot = [&](const Array<float>& a, const Array<float>& b) {
        double sum = 0.0;
        for (std::size_t i = 0; i < length; ++i)
            if (fine.weight[i] > 0.0f) sum += static_cast<double>(a[i]) * static_cast<double>(b[i]);
        return sum;
    };
    auto precondition_of = [&](const Array<float>& v) {
        std::copy(v.begin(), v.end(), fine.right.begin());
        grid.norms.weighted = 0.0;
        for (std::size_t i = 0; i < length; ++i)
            grid.norms.weighted +=
                static_cast<double>(fine.weight[i]) * static_cast<double>(v[i]) * static_cast<double>(v[i]);
        const double product = precondition(grid);
        EXPECT_GT(product, 0.0);
        Array<float> z(grid.krylov.p.begin(), grid.krylov.p.end());
        EXPECT_NEAR(dot(v, z) / product, 1.0, 1e-5) << "r . z without a sweep of its own";
        return z;
    };
    const Array<float> u = random_vector(1), v = random_vector(2);
    const Array<float> mu = precondition_of(u), mv = precondition_of(v);
    const double scale = std::sqrt(dot(u, mu) * dot(v, mv));
    EXPECT_NEAR(dot(u, mv) / scale, dot(v, mu) / scale, 1e-5);  // floats
}

TEST(Solver, TissueApartFromTheMetalStaysCold) {
    Rig rig = held_rig(1e-5);
    // A block of 6^3 hexels cut loose from all others.
    for (int z = 8; z < 16; ++z)
        for (int y = 8; y < 16; ++y)
            for (int x = 8; x < 16; ++x)
                if (x == 8 || x == 15 || y == 8 || y == 15 || z == 8 || z == 15)
                    rig.state.hexel_present.clear(rig.model.hexels.index(x, y, z));
    rig.solve();
    ASSERT_TRUE(rig.state.status.ok);
    double heat = 0.0;
    for (int z = 9; z < 15; ++z)
        for (int y = 9; y < 15; ++y)
            for (int x = 9; x < 15; ++x) {
                const tissue::JouleHeat& joule = rig.exchange.joule;
                heat +=
                    static_cast<double>(joule.scale * joule.density[static_cast<std::size_t>(joule.index({x, y, z}))]);
            }
    EXPECT_LT(heat * rig.model.hexel_volume_m3(), 1e-9 * rig.exchange.joule.total_W);
}

TEST(Generator, PowerThenVoltageLimit) {
    tissue::Input input;
    input.pedal = true;
    input.power_setting_W = 40.0;
    tissue::ElectricParameters parameters;
    parameters.voltage_limit_V = 300.0;
    const tissue::GeneratorState wet = drive(input, parameters, 1.0 / 500.0);
    EXPECT_NEAR(wet.power_W, 40.0, 1e-9);
    EXPECT_NEAR(wet.voltage_V, std::sqrt(40.0 * 500.0), 1e-9);
    EXPECT_NEAR(wet.current_A * wet.impedance_Ohm, wet.voltage_V, 1e-9);
    const tissue::GeneratorState fat = drive(input, parameters, 1.0 / 9000.0);
    EXPECT_EQ(wet.limit, 2);
    EXPECT_EQ(fat.limit, 3);
    EXPECT_NEAR(fat.voltage_V, 300.0, 1e-9);
    EXPECT_NEAR(fat.power_W, 300.0 * 300.0 / 9000.0, 1e-9);
    const tissue::GeneratorState open = drive(input, parameters, 1e-12);
    EXPECT_EQ(open.power_W, 0.0);
    EXPECT_NEAR(open.voltage_V, 300.0, 1e-9) << "at its limit";
    EXPECT_EQ(open.impedance_Ohm, 0.0);
}

// Constant current, constant power, constant voltage, in this order, and continuous where they meet.
TEST(Generator, ThreeRegimesAsImpedanceRises) {
    tissue::Input input;
    input.pedal = true;
    input.power_setting_W = 30.0;
    const tissue::ElectricParameters parameters;
    std::int64_t last_limit = 0;
    double last_V = 0.0;
    for (double ohm = 0.1; ohm < 1e6; ohm *= 1.02) {
        const tissue::GeneratorState s = drive(input, parameters, 1.0 / ohm);
        EXPECT_GE(s.limit, last_limit);
        EXPECT_LE(s.power_W, 30.0 * (1.0 + 1e-9));
        EXPECT_LE(s.current_A, parameters.current_limit_A * (1.0 + 1e-9));
        EXPECT_LE(s.voltage_V, parameters.voltage_limit_V * (1.0 + 1e-9));
        EXPECT_GE(s.voltage_V, last_V * (1.0 - 1e-9));
        if (last_V > 0.0) {
            EXPECT_LE(s.voltage_V / last_V, 1.02 + 1e-9);
        }
        last_limit = s.limit;
        last_V = s.voltage_V;
    }
    EXPECT_EQ(last_limit, 3);
}

TEST(Generator, ModesDifferInCrestFactorAndPeak) {
    tissue::Input input;
    input.pedal = true;
    input.power_setting_W = 30.0;
    const tissue::ElectricParameters parameters;
    double last_crest = 1.0, last_peak = 0.0;
    for (const auto mode : {tissue::GeneratorMode::cut, tissue::GeneratorMode::blend, tissue::GeneratorMode::coag}) {
        input.mode = mode;
        const tissue::GeneratorState open = drive(input, parameters, 0.0),
                                     loaded = drive(input, parameters, 1.0 / 500.0);
        EXPECT_NEAR(loaded.power_W, 30.0, 1e-9) << "the same power from every waveform";
        const double crest = loaded.peak_voltage_V / loaded.voltage_V;
        EXPECT_GT(crest, last_crest);
        EXPECT_GT(open.peak_voltage_V, last_peak);
        last_crest = crest;
        last_peak = open.peak_voltage_V;
    }
    EXPECT_GT(last_peak, 4000.0) << "coag: several kilovolts";
}

TEST(Generator, SettingsReachTheTissue) {
    Rig rig = held_rig(1e-2);
    rig.input.power_setting_W = 2.0;
    rig.solve();
    EXPECT_NEAR(rig.state.generator.power_W, 2.0, 1e-9);
    EXPECT_NEAR(rig.exchange.joule.total_W + rig.exchange.joule.outflow_W, 2.0, 1e-9);
    rig.input.power_setting_W = 120.0;
    rig.solve();
    EXPECT_NEAR(rig.state.generator.voltage_V, rig.model.electric.voltage_limit_V, 1e-9);
    EXPECT_LT(rig.state.generator.power_W, 120.0);
    EXPECT_GT(rig.state.generator.impedance_Ohm, 1000.0) << "fat, four square millimetres";
}

namespace {
void expect_off(const Rig& rig) {
    EXPECT_EQ(rig.state.generator.power_W, 0.0);
    EXPECT_EQ(rig.state.generator.current_A, 0.0);
    EXPECT_EQ(rig.state.generator.impedance_Ohm, 0.0);
    EXPECT_EQ(rig.exchange.joule.total_W, 0.0);
    EXPECT_EQ(rig.exchange.joule.outflow_W, 0.0);
    EXPECT_EQ(rig.exchange.joule.size, Int3(0));
}
}  // namespace

namespace {
void tick(Rig& rig, int count = 1) {
    for (int k = 0; k < count; ++k) {
        step_field(rig.model, rig.state, rig.exchange, rig.input, *rig.work);
        ++rig.state.tick;
    }
}
}  // namespace

TEST(Contact, CurrentFlowsAfterAFrameAndEndsAtOnce) {
    Rig rig = held_rig(1e-2);
    const auto touching = rig.exchange.near;
    const int frame = rig.model.frame_ticks;
    rig.input.pedal = false;
    tick(rig, frame);
    expect_off(rig);
    EXPECT_EQ(rig.state.field.solved, 1) << "metal touches: the field is ready";
    rig.input.pedal = true;
    tick(rig);
    EXPECT_GT(rig.state.generator.power_W, 0.0) << "in the tick in which the pedal goes down";
    EXPECT_NEAR(rig.exchange.joule.total_W + rig.exchange.joule.outflow_W, rig.state.generator.power_W, 1e-9);
    rig.input.pedal = false;
    tick(rig);
    expect_off(rig);
    rig.input.pedal = true;
    tick(rig);
    EXPECT_GT(rig.state.generator.power_W, 0.0);
    rig.input.power_setting_W = 0.0;
    tick(rig);
    expect_off(rig);
    rig.input.power_setting_W = 30.0;

    for (tissue::NearHexel& near : rig.exchange.near) near.bare_gap_m = 1e-3f;  // lifted by a millimetre
    tick(rig);
    expect_off(rig);
    rig.exchange.near = touching;
    tick(rig);
    expect_off(rig);  // the old field is no longer that of a contact
    while (rig.state.tick % frame != 0) tick(rig);
    tick(rig, frame);
    EXPECT_GT(rig.state.generator.power_W, 0.0);
}

// Hexels that go while their field is being solved: no trouble, and no heat for them.
TEST(Contact, TissueMayGoInTheMiddleOfAFrame) {
    Rig rig = held_rig(1e-2);
    for (int frame = 0; frame < 3; ++frame)
        for (int part = 0; part < rig.model.frame_ticks; ++part) {
            rig.state.hexel_present.clear(rig.model.hexels.index(22 + frame, 20 + part, 18));
            tick(rig);
            ASSERT_TRUE(rig.state.status.ok);
        }
    ASSERT_GT(rig.exchange.joule.total_W, 0.0);
    const tissue::JouleHeat& joule = rig.exchange.joule;
    for (int part = 0; part < rig.model.frame_ticks; ++part)
        EXPECT_EQ(joule.density[static_cast<std::size_t>(joule.index({24, 20 + part, 18}))], 0.0f);
}

// Three iterations a frame follow a tip that goes on by a hexel in each, 75 mm/s.
TEST(Contact, SpreadSolvesFollowTheTip) {
    Rig spread = held_rig(1e-2), whole = held_rig(1e-6);
    double worst = 0.0;
    for (int frame = 0; frame < 12; ++frame) {
        for (Rig* rig : {&spread, &whole}) {
            rig->exchange.near.clear();
            for (int y = 20; y < 28; ++y) rig->touch({18 + frame, y, 19});
        }
        tick(spread, spread.model.frame_ticks);
        whole.solve();
        EXPECT_LT(spread.state.field.imbalance, 5e-4) << "V I is heat and outflow, converged or not";
        if (frame > 0) worst = std::max(worst, std::abs(spread.resistance_Ohm() / whole.resistance_Ohm() - 1.0));
    }
    EXPECT_LT(worst, 0.05);
}

TEST(Contact, ArcsStrikeAcrossAGapInCoagOnly) {
    Rig rig = held_rig(1e-3);
    for (tissue::NearHexel& near : rig.exchange.near) near.bare_gap_m = 1.0e-3f;
    rig.solve();
    expect_off(rig);
    EXPECT_NEAR(rig.state.generator.voltage_V, rig.model.electric.voltage_limit_V, 1e-9) << "open circuit";
    rig.input.mode = tissue::GeneratorMode::coag;
    rig.solve();
    EXPECT_EQ(rig.state.field.arcs, 16);
    EXPECT_EQ(rig.state.field.contacts, 0);
    EXPECT_GT(rig.state.generator.power_W, 1.0);
    const double through_arcs = rig.state.generator.impedance_Ohm;
    const tissue::JouleHeat& joule = rig.exchange.joule;
    EXPECT_GT(joule.wire_W, 0.0) << "an arc heats both its ends";
    EXPECT_LT(joule.wire_W, 0.5 * rig.state.generator.power_W);
    EXPECT_NEAR(joule.total_W + joule.outflow_W + joule.wire_W, rig.state.generator.power_W, 1e-9);
    for (tissue::NearHexel& near : rig.exchange.near) near.bare_gap_m = 0.0f;
    rig.solve();
    EXPECT_LT(rig.state.generator.impedance_Ohm, through_arcs) << "an arc has a resistance of its own";
    for (tissue::NearHexel& near : rig.exchange.near) near.bare_gap_m = 3e-3f;
    rig.state.generator = {};
    rig.solve();
    expect_off(rig);
}

// Without the pedal nothing burns, whatever the gap.
TEST(Contact, ArcsGoForTheNearest) {
    Rig rig = held_rig(1e-3);
    rig.input.mode = tissue::GeneratorMode::coag;
    for (std::size_t k = 0; k < rig.exchange.near.size(); ++k)
        rig.exchange.near[k].bare_gap_m = k < 4 ? 0.5e-3f : 1.2e-3f;
    rig.solve();
    EXPECT_EQ(rig.state.field.arcs, 4);
    rig.input.pedal = false;
    rig.solve();
    expect_off(rig);
    EXPECT_EQ(rig.state.field.solved, 0);
}

TEST(Contact, CharOnTheTipRaisesImpedance) {
    Rig rig = held_rig(1e-3);
    rig.solve();
    const double clean = rig.state.generator.impedance_Ohm;
    rig.state.tip.char_kg = 2e-6;  // a tenth of a millimetre
    rig.solve();
    EXPECT_GT(rig.state.generator.impedance_Ohm, 1.005 * clean);
    EXPECT_LT(rig.state.field.imbalance, 5e-4);
}

// Metal on a crumb that touches nothing: no load.
TEST(Contact, LoneHexelIsAnOpenCircuit) {
    Rig rig(full_box({4, 4, 4}, 0.1));
    rig.touch({5, 5, 5});
    rig.solve();
    expect_off(rig);
}

constexpr Reach kTouch{0.05e-3, false};

TEST(Window, StaysUntilTheTipLeavesItsMiddle) {
    tissue::Model model = full_box({96, 96, 64}, 0.1);
    model.electric.window_cells = 48;
    tissue::Exchange exchange;
    auto place = [&](const Int3& hexel, const Int3& low) {
        exchange.near.assign(1, {});
        exchange.near[0].hexel = model.hexels.index(hexel);
        exchange.near[0].bare_gap_m = 0.0f;
        return place_window(model, exchange, kTouch, low).low;
    };
    const Int3 low = place({50, 50, 60}, Int3(0));
    EXPECT_EQ(low, Int3(26, 26, 24)) << "48 cells, and not beyond the lattice's 72 in z";
    EXPECT_EQ(place({56, 44, 60}, low), low);
    EXPECT_EQ(place({57, 44, 60}, low), Int3(32, 26, 24));
    // A small lattice lies inside the window, wherever the tip is.
    tissue::Model small = full_box({8, 8, 8}, 0.1);
    exchange.near.assign(1, {});
    exchange.near[0].hexel = small.hexels.index(11, 4, 8);
    exchange.near[0].bare_gap_m = 0.0f;
    const Window window = place_window(small, exchange, kTouch, Int3(0));
    for (int k = 0; k < 3; ++k) EXPECT_EQ(window.end[k] - window.begin[k], 16);
}

}  // namespace calot::electric

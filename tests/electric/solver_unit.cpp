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
        EXPECT_LE(rig.work->iterations, first + 5) << cells << " cells, " << first << " at 16";
        EXPECT_LT(rig.work->iterations, rig.model.electric.max_iterations);
    }
}

// Conjugate gradients need M symmetric and positive: u . M v = v . M u.
TEST(Solver, PreconditionerIsSymmetricPositive) {
    Rig rig = held_rig(1e-2);
    begin_field(rig.model, rig.state, rig.exchange, *rig.work);
    Level& fine = rig.work->grid.levels[0];
    const auto length = static_cast<std::size_t>(fine.length);
    auto random_vector = [&](std::uint64_t seed) {
        Random random(seed);
        Array<float> v(length);
        for (std::size_t i = 0; i < length; ++i)
            v[i] = fine.weight[i] > 0.0f ? static_cast<float>(random.uniform(-1.0, 1.0)) : 0.0f;
        return v;
    };
    auto precondition_of = [&](const Array<float>& v) {
        std::copy(v.begin(), v.end(), fine.right.begin());
        for (std::size_t i = 0; i < length; ++i) fine.solution[i] = fine.weight[i] * v[i];
        EXPECT_GT(precondition(rig.work->grid), 0.0);
        return Array<float>(fine.scratch.begin(), fine.scratch.end());
    };
    auto dot = [&](const Array<float>& a, const Array<float>& b) {
        double sum = 0.0;
        for (std::size_t i = 0; i < length; ++i)
            if (fine.weight[i] > 0.0f) sum += static_cast<double>(a[i]) * static_cast<double>(b[i]);
        return sum;
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
                heat += static_cast<double>(joule.density_W_per_m3[static_cast<std::size_t>(joule.index({x, y, z}))]);
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
    EXPECT_NEAR(fat.voltage_V, 300.0, 1e-9);
    EXPECT_NEAR(fat.power_W, 300.0 * 300.0 / 9000.0, 1e-9);
    const tissue::GeneratorState open = drive(input, parameters, 1e-12);
    EXPECT_EQ(open.power_W, 0.0);
    EXPECT_EQ(open.impedance_Ohm, 0.0);
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

TEST(Contact, CurrentFlowsOnRefreshTicksAndEndsAtOnce) {
    Rig rig = held_rig(1e-2);
    const auto touching = rig.exchange.near;
    rig.state.tick = 3;
    rig.solve();
    expect_off(rig);  // waits for the next refresh
    rig.state.tick = rig.model.electric.refresh_ticks;
    rig.solve();
    EXPECT_GT(rig.state.generator.power_W, 0.0);
    ++rig.state.tick;
    rig.solve();
    EXPECT_GT(rig.state.generator.power_W, 0.0);  // nothing changed, nothing lost
    rig.input.pedal = false;
    rig.solve();
    expect_off(rig);

    rig.input.pedal = true;
    rig.state.tick = 2 * rig.model.electric.refresh_ticks;
    rig.solve();
    EXPECT_GT(rig.state.generator.power_W, 0.0);
    ++rig.state.tick;
    for (tissue::NearHexel& near : rig.exchange.near) near.bare_gap_m = 1e-4f;  // lifted by a tenth of a millimetre
    rig.solve();
    expect_off(rig);
    rig.exchange.near = touching;
    rig.state.tick = 3 * rig.model.electric.refresh_ticks;
    rig.input.power_setting_W = 0.0;
    rig.solve();
    expect_off(rig);
}

// Metal on a crumb that touches nothing: no load.
TEST(Contact, LoneHexelIsAnOpenCircuit) {
    Rig rig(full_box({4, 4, 4}, 0.1));
    rig.touch({5, 5, 5});
    rig.solve();
    expect_off(rig);
}

TEST(Window, StaysUntilTheTipLeavesItsMiddle) {
    tissue::Model model = full_box({96, 96, 64}, 0.1);
    tissue::Exchange exchange;
    auto place = [&](const Int3& hexel, const Int3& low) {
        exchange.near.assign(1, {});
        exchange.near[0].hexel = model.hexels.index(hexel);
        exchange.near[0].bare_gap_m = 0.0f;
        return place_window(model, exchange, low).low;
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
    const Window window = place_window(small, exchange, Int3(0));
    for (int k = 0; k < 3; ++k) EXPECT_EQ(window.end[k] - window.begin[k], 16);
}

}  // namespace calot::electric

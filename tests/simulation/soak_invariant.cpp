// Ten simulated minutes of pressing and burning: memory stays flat, nothing runs away.

#include <cmath>
#include <fstream>

#include <gtest/gtest.h>

#include "calot/simulation/simulation.h"
#include "simulation/test_setups.h"

namespace calot::simulation {

namespace {

std::int64_t resident_bytes() {
    std::int64_t total = 0, resident = 0;
    std::ifstream("/proc/self/statm") >> total >> resident;
    return resident * 4096;
}

/// The hook circles over a small block and presses every second; 60 W for 200 ms of each.
tissue::Input circling(const Vec3& trocar, double time_s) {
    tissue::Input input;
    const double angle = 0.3 * time_s, phase = 2.0 * M_PI * time_s;
    const Vec3 tip(0.003 * std::cos(angle), 0.003 * std::sin(angle), 0.002 - 0.0035 * (0.5 - 0.5 * std::cos(phase)));
    input.hook = instruments::pose_through_trocar(trocar, tip, angle);
    const double within = time_s - std::floor(time_s);
    input.pedal = within > 0.4 && within < 0.6;
    input.power_setting_W = 60.0;
    return input;
}

}  // namespace

TEST(Soak, TenMinutesKeepMemoryFlat) {
    auto setup = std::make_shared<simulation::Setup>();
    setup->anatomy = anatomy::make_block({.size_m = Vec3(0.0144, 0.0144, 0.0072)});
    setup->model = tissue::sample(setup->anatomy, {.hexel_spacing_m = 1.2e-3, .hexels_per_edge = 2});
    Simulation run(setup);
    const Vec3 trocar(0.0, -0.08, 0.14);
    std::int64_t after_one_minute = 0;
    for (int k = 0; k < 600'000; ++k) {
        ASSERT_TRUE(run.tick(circling(trocar, run.time_s()))) << run.state().status.field;
        if (k == 60'000) after_one_minute = resident_bytes();
    }
    EXPECT_LT(resident_bytes() - after_one_minute, 2 << 20);
    EXPECT_GT(run.state().hexels_burnt, 0);
    EXPECT_LT(std::abs(run.energy_imbalance()), 1e-3);
    EXPECT_LE(run.work().smoke.particles().size(), effects::SmokeParameters{}.max_particles);
}

}  // namespace calot::simulation

// A whole burn on a device beside the CPU's.

#include <algorithm>
#include <cmath>

#include "calot/anatomy/block.h"
#include "calot/deformation/embedding.h"
#include "calot/gpu/backend.h"
#include "calot/gpu/choose.h"
#include "calot/simulation/simulation.h"
#include "calot/surface/surface.h"
#include "calot/tissue/sampling.h"
#include "gpu/rig.h"

namespace calot::gpu {
namespace {

constexpr double kPedal_s = 0.1;

/// A small block of fat: pressed, burnt and dragged open, let go. The pedal goes down `later_s` after its time.
std::shared_ptr<simulation::Setup> small_burn(double later_s = 0.0) {
    auto setup = std::make_shared<simulation::Setup>();
    setup->name = "small burn";
    setup->anatomy = anatomy::make_block({.size_m = Vec3(0.0144, 0.0144, 0.0072)});
    setup->model = tissue::sample(setup->anatomy, {});
    setup->model.electric.window_cells = 24;  // PoCL is slow
    setup->script = simulation::Script(Vec3(0.0, -0.08, 0.14),
                                       {{0.0, Vec3(-0.001, 0.0, 0.001), 0.0},
                                        {0.08, Vec3(-0.001, 0.0, -0.001), 0.0},
                                        {0.5, Vec3(-0.001, 0.0, -0.002), 0.0},
                                        {0.8, Vec3(0.001, 0.0, -0.002), 0.0},
                                        {0.86, Vec3(0.001, 0.0, 0.006), 0.0}},
                                       {{kPedal_s + later_s, 0.8 + later_s, 80.0, tissue::GeneratorMode::cut}});
    setup->duration_s = 0.86;
    return setup;
}

std::shared_ptr<simulation::Setup> on_device(std::shared_ptr<simulation::Setup> setup) {
    use_backend({test_device()->info(), ""}, *setup);
    return setup;
}

void run_to(simulation::Simulation& run, double time_s) {
    while (run.time_s() < time_s - 0.5e-3)
        ASSERT_TRUE(run.tick(run.setup().script.at(run.time_s())))
            << run.figures().status.field << " at tick " << run.figures().status.tick;
}

/// What a burn came to.
struct Outcome {
    double burnt = 0.0, fallen = 0.0, delivered_J = 0.0, peak_N = 0.0, tip_K = 0.0, volume_m3 = 0.0;
    BitArray removed;
};
Outcome outcome_of(simulation::Simulation& run) {
    Outcome out;
    while (run.time_s() < run.setup().duration_s - 0.5e-3) {
        EXPECT_TRUE(run.tick(run.setup().script.at(run.time_s())));
        out.peak_N = std::max(out.peak_N, glm::length(run.figures().hook_force_N));
    }
    const tissue::State& state = run.state();
    out.burnt = static_cast<double>(state.hexels_burnt);
    out.fallen = static_cast<double>(state.hexels_fallen);
    out.delivered_J = state.energy_J.delivered;
    out.tip_K = state.tip.temperature_K;
    out.volume_m3 = surface::volume_m3(run.surface().rest_mesh());
    out.removed = run.model().hexel_initial;
    for (std::size_t w = 0; w < out.removed.words().size(); ++w)
        out.removed.words()[w] &= ~state.hexel_present.words()[w];
    return out;
}

/// Removed hexels of `a` with none of `b` beside them, corners counted.
int far_from(const Lattice& lattice, const BitArray& a, const BitArray& b) {
    int far = 0;
    for (std::int64_t h = lattice.first; h < lattice.last; ++h) {
        if (!a.test(h)) continue;
        bool near = false;
        for (int z = -1; z <= 1; ++z)
            for (int y = -1; y <= 1; ++y)
                for (int x = -1; x <= 1; ++x) near = near || b.test(h + lattice.offset(Int3(x, y, z)));
        far += !near;
    }
    return far;
}

}  // namespace

// A device takes a heat step whole, in one tick of eight; the CPU's blocks take their turns over all eight. The pedal
// thus comes up to a frame sooner or later for some tissue, and a burn amplifies that: so does the CPU's own with the
// pedal pressed a few milliseconds sooner or later. A device's burn must be one of those, or hardly beyond them.
TEST(WholeBurn, IsOneThatTheCpuMakesToo) {
    simulation::Simulation on_gpu(on_device(small_burn()));
    ASSERT_TRUE(on_gpu.notices().empty()) << on_gpu.notices()[0];
    const Outcome gpu = outcome_of(on_gpu);
    std::vector<Outcome> cpu;
    for (const double later_ms : {-6.0, -4.0, -2.0, 0.0, 2.0, 4.0, 6.0}) {
        simulation::Simulation run(small_burn(1e-3 * later_ms));
        cpu.push_back(outcome_of(run));
    }
    const auto expect_within = [&](double Outcome::*what, double share, const char* name) {
        double low = cpu[0].*what, high = low;
        for (const Outcome& o : cpu) low = std::min(low, o.*what), high = std::max(high, o.*what);
        EXPECT_GE(gpu.*what, low - share * std::abs(low)) << name << " of the CPU: " << low << " to " << high;
        EXPECT_LE(gpu.*what, high + share * std::abs(high)) << name << " of the CPU: " << low << " to " << high;
    };
    expect_within(&Outcome::burnt, 0.05, "hexels burnt");
    expect_within(&Outcome::fallen, 1.0, "hexels fallen");
    expect_within(&Outcome::delivered_J, 0.01, "energy");
    expect_within(&Outcome::peak_N, 0.02, "force");
    expect_within(&Outcome::tip_K, 0.002, "the wire's temperature");
    expect_within(&Outcome::volume_m3, 0.001, "the surface's volume");
    EXPECT_GT(gpu.burnt, 50.0);
    EXPECT_LT(std::abs(on_gpu.energy_imbalance()), 1e-3);  // the bound of the CPU's
    const Outcome& same = cpu[3];
    EXPECT_LE(far_from(on_gpu.model().hexels, gpu.removed, same.removed), 2);
    EXPECT_LE(far_from(on_gpu.model().hexels, same.removed, gpu.removed), 2);

    // The mesh is that of the hexels that are left.
    EXPECT_TRUE(surface::check(on_gpu.surface().rest_mesh()).closed);
    surface::Surface fresh(on_gpu.model());
    fresh.rebuild(on_gpu.model(), on_gpu.state());
    EXPECT_EQ(on_gpu.surface().rest_mesh().index, fresh.rest_mesh().index);

    // And its vertices hang on the tissue as the CPU would hang them on this state.
    simulation::WorldSurface seen;
    on_gpu.world_surface(seen);
    const deformation::Work work = deformation::make_work(on_gpu.model(), on_gpu.state());
    std::vector<Vec3f> expected_m(seen.position_m.size());
    deformation::embed_points(on_gpu.model(), on_gpu.state(), work, on_gpu.surface().smooth_mesh().position_m,
                              on_gpu.surface().owner(), expected_m);
    for (std::size_t v = 0; v < expected_m.size(); ++v)
        ASSERT_LT(glm::distance(seen.position_m[v], expected_m[v]), 1e-7f) << v;
}

// Without current nothing is spread otherwise: forces and places are the CPU's to rounding.
TEST(WholeBurn, PressesAsTheCpuDoes) {
    simulation::Simulation gpu(on_device(small_burn())), cpu(small_burn());
    while (cpu.time_s() < kPedal_s - 0.5e-3) {
        const tissue::Input input = cpu.setup().script.at(cpu.time_s());
        ASSERT_TRUE(cpu.tick(input));
        ASSERT_TRUE(gpu.tick(input));
        ASSERT_LT(glm::distance(gpu.figures().hook_force_N, cpu.state().hook_force_N), 1e-5) << cpu.state().tick;
    }
    EXPECT_GT(glm::length(cpu.state().hook_force_N), 0.01);
    const tissue::State& state = gpu.state();
    for (std::size_t r = 0; r < 3; ++r)
        for (std::size_t p = 0; p < state.displacement_m[r].size(); ++p)
            ASSERT_NEAR(state.displacement_m[r][p], cpu.state().displacement_m[r][p], 1e-8) << p;
    simulation::WorldSurface seen, expected;
    gpu.world_surface(seen);
    cpu.world_surface(expected);
    ASSERT_EQ(seen.position_m.size(), expected.position_m.size());
    for (std::size_t v = 0; v < seen.position_m.size(); ++v) {
        ASSERT_LT(glm::distance(seen.position_m[v], expected.position_m[v]), 1e-7f) << v;
        for (int c = 0; c < 3; ++c)
            ASSERT_LT(glm::distance(seen.deformation_gradient[v][c], expected.deformation_gradient[v][c]), 1e-4f) << v;
    }
}

// What is fetched is all of the state: the CPU goes on from it, and so does a device.
TEST(WholeBurn, ItsStateIsComplete) {
    const auto setup = on_device(small_burn());
    simulation::Simulation run(setup);
    run_to(run, 0.4);
    ASSERT_EQ(run.figures().tick % run.model().frame_ticks, 0);
    ASSERT_GT(run.figures().hexels_burnt, 0);
    const tissue::State saved = run.state();
    simulation::Simulation again(setup, saved), on_cpu(small_burn(), saved);
    EXPECT_EQ(tissue::hash_fields(again.state()), tissue::hash_fields(saved)) << "up and down";
    for (simulation::Simulation* each : {&run, &again, &on_cpu}) run_to(*each, 0.5);
    EXPECT_EQ(tissue::hash_fields(again.state()), tissue::hash_fields(run.state())) << "the same device goes on alike";
    EXPECT_LT(std::abs(on_cpu.energy_imbalance()), 1e-3);
    EXPECT_NEAR(static_cast<double>(on_cpu.state().hexels_burnt), static_cast<double>(run.state().hexels_burnt), 4.0);
}

}  // namespace calot::gpu

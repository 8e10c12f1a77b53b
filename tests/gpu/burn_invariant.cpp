// A whole burn on a device beside the CPU's.

#include <cstdio>

#include "calot/gpu/backend.h"
#include "calot/gpu/choose.h"
#include "calot/simulation/simulation.h"
#include "calot/surface/surface.h"
#include "gpu/rig.h"
#include "simulation/test_setups.h"

namespace calot::gpu {
namespace {

std::shared_ptr<simulation::Setup> on_device(std::shared_ptr<simulation::Setup> setup) {
    use_backend({test_device()->info(), ""}, *setup);
    return setup;
}

}  // namespace

TEST(GpuBurn, Compare) {
    const auto setup = simulation::burnt_block_setup();
    simulation::Simulation cpu(setup), gpu(on_device(simulation::burnt_block_setup()));
    for (const auto& n : gpu.notices()) std::printf("%s\n", n.c_str());
    double worst = 0;
    while (cpu.time_s() < setup->duration_s) {
        const tissue::Input input = setup->script.at(cpu.time_s());
        ASSERT_TRUE(cpu.tick(input));
        ASSERT_TRUE(gpu.tick(input)) << gpu.figures().status.field << " " << gpu.figures().tick;
        const auto &a = cpu.state(), &b = gpu.figures();
        worst = std::max(worst, glm::distance(a.hook_force_N, b.hook_force_N));
        if (a.tick % 100 == 0) {
            std::printf("%ld F %.5f %.5f  burnt %ld %ld fallen %ld %ld severed %ld %ld delivered %.6f %.6f tip %.3f %.3f field %.6g %.6g sev imb %.2e %.2e worstF %.2e\n", a.tick, glm::length(a.hook_force_N), glm::length(b.hook_force_N), a.hexels_burnt, b.hexels_burnt, a.hexels_fallen, b.hexels_fallen, a.links_severed, b.links_severed, a.energy_J.delivered, b.energy_J.delivered, a.tip.temperature_K, b.tip.temperature_K, a.field.conductance_S(), b.field.conductance_S(), cpu.energy_imbalance(), gpu.energy_imbalance(), worst);
            std::fflush(stdout);
        }
    }
}

}  // namespace calot::gpu

// Which backend a run gets, and that a device that fails costs nothing.

#include <gtest/gtest.h>

#include "calot/base/error.h"
#include "calot/gpu/backend.h"
#include "calot/gpu/choose.h"
#include "calot/simulation/simulation.h"
#include "gpu/rig.h"
#include "simulation/test_setups.h"

namespace calot::gpu {
namespace {

DeviceInfo device_named(const char* name, bool is_gpu) {
    DeviceInfo info;
    info.name = name;
    info.is_gpu = is_gpu;
    info.memory_bytes = std::uint64_t{6} << 30;
    return info;
}

}  // namespace

TEST(Choose, SaysWhatAndWhy) {
    const std::vector<DeviceInfo> none, all{device_named("Fast", true), device_named("Processor", false)};
    const std::int64_t large = kWorthADevice, small = kWorthADevice - 1;
    EXPECT_FALSE(choose_backend({BackendKind::cpu, -1}, all, large).device);
    EXPECT_EQ(choose_backend({BackendKind::gpu, -1}, all, small).device->name, "Fast");
    EXPECT_EQ(choose_backend({BackendKind::gpu, 1}, all, small).device->name, "Processor");
    EXPECT_EQ(choose_backend({BackendKind::gpu, 1}, all, small).why, "GPU: Processor (OpenCL, 6144 MB, not a GPU)");
    EXPECT_EQ(choose_backend({BackendKind::automatic, -1}, all, large).device->name, "Fast");
    const BackendChoice too_small = choose_backend({BackendKind::automatic, -1}, all, small);
    EXPECT_FALSE(too_small.device);
    EXPECT_NE(too_small.why.find("too small"), std::string::npos);
    EXPECT_FALSE(choose_backend({BackendKind::automatic, 1}, all, large).device) << "a processor is no GPU";
    EXPECT_FALSE(choose_backend({BackendKind::automatic, -1}, none, large).device);
    EXPECT_THROW(choose_backend({BackendKind::gpu, -1}, none, large), InputError);
    EXPECT_THROW(choose_backend({BackendKind::gpu, 2}, all, large), InputError);
}

// Too little memory: the CPU computes from the first tick on, and says why.
TEST(Choose, TooLittleMemoryMeansTheCpu) {
    auto setup = simulation::burnt_block_setup();
    BackendChoice choice;
    choice.device = test_device()->info();
    choice.device->memory_bytes = device_bytes(setup->model) - 1;
    use_backend(choice, *setup);
    simulation::Simulation run(setup), on_cpu(simulation::burnt_block_setup());
    for (int k = 0; k < 10; ++k) {
        const tissue::Input input = setup->script.at(run.time_s());
        run.tick(input);
        on_cpu.tick(input);
    }
    EXPECT_EQ(tissue::hash(run.state()), tissue::hash(on_cpu.state()));
    ASSERT_EQ(run.notices().size(), 1u);
    EXPECT_NE(run.notices()[0].find("MB of memory, the scene needs about"), std::string::npos) << run.notices()[0];
}

TEST(Choose, ADeviceThatIsGoneMeansTheCpu) {
    auto setup = simulation::burnt_block_setup();
    BackendChoice choice;
    choice.device = test_device()->info();
    choice.device->platform = 99;
    use_backend(choice, *setup);
    simulation::Simulation run(setup);
    EXPECT_TRUE(run.tick(setup->script.at(0.0)));
    EXPECT_EQ(run.backend().name(), "CPU");
    ASSERT_EQ(run.notices().size(), 1u);
    EXPECT_NE(run.notices()[0].find("is gone"), std::string::npos) << run.notices()[0];
}

}  // namespace calot::gpu

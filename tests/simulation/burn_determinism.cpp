// The same scene and input give the same bytes: for any number of threads, and again from a recording.

#include <filesystem>

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include "calot/base/parallel.h"
#include "calot/simulation/recording.h"
#include "calot/simulation/simulation.h"
#include "simulation/test_setups.h"

namespace calot::simulation {

namespace {
std::vector<std::uint64_t> hashes_after_burn(int threads, double duration_s = 1.6) {
    const ThreadLimit limit(threads);
    const auto setup = burnt_block_setup();
    Simulation run(setup);
    while (run.time_s() < duration_s) run.tick(setup->script.at(run.time_s()));
    EXPECT_GT(run.state().hexels_burnt, 0);
    return tissue::hash_fields(run.state());
}

/// Lets kernels use these instruction sets alone; 0 = all that the processor has.
void use_targets(std::int64_t targets) {
    hwy::SetSupportedTargetsForTest(targets);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}
}  // namespace

TEST(Determinism, SameBytesForOneTwoAndFourThreads) {
    const auto one = hashes_after_burn(1);
    EXPECT_EQ(one, hashes_after_burn(2));
    EXPECT_EQ(one, hashes_after_burn(4));
}

TEST(Determinism, SameBytesOnEveryInstructionSet) {
    constexpr double kBurn_s = 0.6;  // comes down, presses, burns its first hexels
    const auto best = hashes_after_burn(1, kBurn_s);
    for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
        use_targets(target);
        const auto hashes = hashes_after_burn(1, kBurn_s);
        use_targets(0);
        EXPECT_EQ(hashes, best) << hwy::TargetName(target);
    }
}

TEST(Determinism, RecordingReplaysToTheSameState) {
    const std::string path = (std::filesystem::temp_directory_path() / "calot-determinism.calot").string();
    const auto setup = burnt_block_setup();
    Simulation run(setup);
    {
        RecordingWriter writer(path, "test", "scene", run.state());
        while (run.time_s() < setup->duration_s) {
            const tissue::Input input = setup->script.at(run.time_s());
            run.tick(input);
            writer.add(input, run.state());
        }
        writer.finish(run.state());
    }
    const Recording recording = read_recording(path);
    std::filesystem::remove(path);
    ASSERT_TRUE(recording.complete);
    Simulation again(burnt_block_setup());
    std::size_t next = 0;
    for (const tissue::Input& input : recording.inputs) {
        again.tick(input);
        if (next < recording.hashes.size() && recording.hashes[next].tick == again.state().tick) {
            EXPECT_EQ(tissue::hash_fields(again.state()), recording.hashes[next++].fields);
        }
    }
    EXPECT_EQ(next, recording.hashes.size());
    EXPECT_EQ(tissue::hash(again.state()), tissue::hash(run.state()));
}

}  // namespace calot::simulation

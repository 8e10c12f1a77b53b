// A recording runs again to the last bit, whatever the number of threads; a run that differs is found out.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "apps/program.h"
#include "calot/scene/scene.h"
#include "calot/simulation/recording.h"
#include "calot/simulation/simulation.h"

namespace calot::test {
namespace {

std::string hash_of(const std::string& scene, const std::string& out, const std::string& threads) {
    const Outcome outcome = run({"simulate", scene, "--out", out, "--frames", "none", "--export-every", "0",
                                 "--progress", "none", "--threads", threads});
    EXPECT_EQ(outcome.code, 0) << outcome.output;
    return nlohmann::json::parse(read_file(out + "/summary.json"))["state_hash"];
}

TEST(Replay, SameBytesForAnyNumberOfThreads) {
    const Folder folder("threads");
    const std::string scene = folder.write("tiny.toml", kTinyScene);
    const std::string one = hash_of(scene, folder / "one", "1");
    EXPECT_EQ(hash_of(scene, folder / "two", "2"), one);
    EXPECT_EQ(hash_of(scene, folder / "four", "4"), one);
    const Outcome outcome = run({"replay", folder / "one/recording.calot", "--verify", "--threads", "2"});
    EXPECT_EQ(outcome.code, 0) << outcome.output;
    EXPECT_NE(outcome.output.find("verified: the state is the same"), std::string::npos) << outcome.output;
}

TEST(Replay, WritesTheSameTimeline) {
    const Folder folder("replay_out");
    const std::string hash = hash_of(folder.write("tiny.toml", kTinyScene), folder / "run", "2");
    const Outcome outcome = run({"replay", folder / "run/recording.calot", "--out", folder / "again", "--frames",
                                 "none", "--progress", "none"});
    ASSERT_EQ(outcome.code, 0) << outcome.output;
    EXPECT_EQ(nlohmann::json::parse(read_file(folder / "again/summary.json"))["state_hash"], hash);
    EXPECT_EQ(read_file(folder / "again/timeline.csv"), read_file(folder / "run/timeline.csv"));
}

TEST(Replay, KeepsWhatTheCommandLineChanged) {
    const Folder folder("overrides");
    const Outcome made =
        run({"simulate", folder.write("tiny.toml", kTinyScene), "--out", folder / "out", "--frames", "none",
             "--progress", "none", "--set", "materials.fat.youngs_modulus_kPa=7.3", "--duration", "0.05"});
    ASSERT_EQ(made.code, 0) << made.output;
    EXPECT_EQ(run({"replay", folder / "out/recording.calot", "--verify"}).code, 0);
}

TEST(Replay, NamesTickAndFieldOfTheFirstDifference) {
    const Folder folder("difference");
    const auto setup = std::make_shared<simulation::Setup>(scene::build(scene::parse(kTinyScene, "tiny.toml", ".")));
    simulation::Simulation simulation(setup);
    {
        simulation::RecordingWriter writer(folder / "false.calot", "test", setup->scene_text, simulation.state());
        for (int tick = 0; tick < 30; ++tick) {
            tissue::Input input = setup->script.at(simulation.time_s());
            simulation.tick(input);
            input.hook.position_m.z -= 1e-4;  // not what was simulated
            writer.add(input, simulation.state());
        }
        writer.finish(simulation.state());
    }
    const Outcome outcome = run({"replay", folder / "false.calot", "--verify", "--progress", "none"});
    EXPECT_EQ(outcome.code, 1) << outcome.output;
    EXPECT_NE(outcome.output.find("first difference at tick 30 in displacement_"), std::string::npos) << outcome.output;
}

}  // namespace
}  // namespace calot::test

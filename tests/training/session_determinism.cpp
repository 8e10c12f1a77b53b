// Sessions: any moment is reached again to the last bit, another goes on from it, what is damaged is told.

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "calot/base/error.h"
#include "calot/training/session.h"
#include "setups.h"

namespace calot::training {
namespace {

namespace fs = std::filesystem;

SessionStart start_with_task() {
    SessionStart start;
    start.task = parse_task(test::kTaskText, "test.toml");
    start.trainee = "A";
    start.program_version = "test";
    return start;
}

/// Runs the script's session to the end; hashes of the state at chosen ticks.
struct Stored {
    explicit Stored(Store& store) {
        simulation::Simulation run(test::coarse_setup());
        LiveSession live(store, start_with_task(), run);
        while (run.time_s() < 1.2 - 0.5e-3) {
            const tissue::Input input = run.setup().script.at(run.time_s());
            run.tick(input);
            live.after_tick(run, input);
            if (run.state().tick == 1100) smoke = run.work().smoke.particles();
            if (run.state().tick == 613 || run.state().tick == 1100) hashes.push_back(tissue::hash(run.state()));
        }
        row = live.finish(run);
        hashes.push_back(tissue::hash(run.state()));
    }
    SessionRow row;
    std::vector<std::uint64_t> hashes;
    std::vector<effects::SmokeParticle> smoke;  ///< at tick 1100
};

struct Shared {
    Shared() : folder("sessions"), store(folder.path()), stored(store) {}
    test::TestFolder folder;
    Store store;
    Stored stored;
};
Shared& shared() {
    static Shared all;
    return all;
}

TEST(Session, IsStoredWithItsOutcome) {
    const SessionRow& row = shared().stored.row;
    EXPECT_EQ(row.status, SessionStatus::finished);
    EXPECT_EQ(row.trainee, "A");
    EXPECT_EQ(row.task, "test");
    EXPECT_NEAR(row.duration_s, 1.2, 1e-9);
    ASSERT_TRUE(row.points);
    EXPECT_GT(*row.points, 0.0);
    EXPECT_GT(row.metrics.at("fat_removed_m3"), 0.0);
    const simulation::Recording recording = simulation::read_recording(shared().store.path(row.id, "recording.calot"));
    EXPECT_TRUE(recording.complete);
    EXPECT_EQ(recording.inputs.size(), 1200u);
    EXPECT_TRUE(shared().store.abandoned().empty());
}

TEST(Session, EveryMomentIsReachedToTheLastBit) {
    Store& store = shared().store;
    const std::int64_t id = shared().stored.row.id;
    const std::vector<std::int64_t> stored = CheckpointReader(store.path(id, "checkpoints.calot")).ticks();
    ASSERT_FALSE(stored.empty());
    EXPECT_EQ(stored.front(), 1000);
    // Before the first checkpoint, after it, at the end.
    const std::int64_t ticks[] = {613, 1100, 1200};
    for (std::size_t k = 0; k < 3; ++k) {
        const Moment moment = reach(store, id, ticks[k], test::coarse_setup());
        EXPECT_EQ(moment.run->state().tick, ticks[k]);
        EXPECT_EQ(tissue::hash(moment.run->state()), shared().stored.hashes[k]) << ticks[k];
    }
    // What is only seen is there as it was, too: from the checkpoint at 1000.
    const Moment seen = reach(store, id, 1100, test::coarse_setup());
    const std::vector<effects::SmokeParticle>& smoke = seen.run->work().smoke.particles();
    ASSERT_FALSE(shared().stored.smoke.empty());
    ASSERT_EQ(smoke.size(), shared().stored.smoke.size());
    for (std::size_t k = 0; k < smoke.size(); ++k)
        EXPECT_EQ(smoke[k].position_m, shared().stored.smoke[k].position_m) << k;
    const Moment end = reach(store, id, 1200, test::coarse_setup());
    Metrics told = end.meter->metrics();
    for (const auto& [name, value] : shared().stored.row.metrics) EXPECT_EQ(told.at(name), value) << name;
    EXPECT_THROW(reach(store, id, 1201, test::coarse_setup()), InputError);
}

TEST(Session, CheckpointsOfAnOlderVersionCountForNothing) {
    const test::TestFolder folder("older_checkpoints");
    const std::string path = folder.path() + "/checkpoints.calot";
    std::ofstream(path) << "CALOTCK1" << std::string(200, 'x');
    EXPECT_TRUE(CheckpointReader(path).ticks().empty());
    std::ofstream(path) << "CALOTCK9" << std::string(200, 'x');
    EXPECT_THROW(CheckpointReader{path}, InputError);
}

TEST(Session, AnotherGoesOnFromAMoment) {
    Store& store = shared().store;
    const std::int64_t id = shared().stored.row.id;
    Moment moment = reach(store, id, 1040, test::coarse_setup());
    LiveSession live(store, start_with_task(), moment);
    simulation::Simulation& run = *moment.run;
    while (run.time_s() < 1.2 - 0.5e-3) {
        const tissue::Input input = run.setup().script.at(run.time_s());
        run.tick(input);
        live.after_tick(run, input);
    }
    const SessionRow row = live.finish(run);
    EXPECT_EQ(row.parent, id);
    EXPECT_EQ(row.parent_tick, 1040);
    // The same hands: the same outcome.
    EXPECT_EQ(tissue::hash(run.state()), shared().stored.hashes.back());
    EXPECT_EQ(row.metrics, shared().stored.row.metrics);
    EXPECT_EQ(row.points, shared().stored.row.points);
    // Its recording stands on its own, checkpoints before the branch included.
    const simulation::Recording recording = simulation::read_recording(store.path(row.id, "recording.calot"));
    EXPECT_TRUE(recording.complete);
    EXPECT_EQ(recording.inputs.size(), 1200u);
    EXPECT_EQ(CheckpointReader(store.path(row.id, "checkpoints.calot")).ticks().front(), 1000);
    const Moment end = reach(store, row.id, 1200, test::coarse_setup());
    EXPECT_EQ(tissue::hash(end.run->state()), shared().stored.hashes.back());
}

TEST(Session, DamagedCheckpointsAreToldAndTheRecordingStillServes) {
    Store& store = shared().store;
    const std::int64_t id = shared().stored.row.id;
    const test::TestFolder copy("damaged");
    for (const char* file : {"recording.calot", "checkpoints.calot"})
        fs::copy_file(store.path(id, file), copy.path() + "/" + file);
    const std::string recording = copy.path() + "/recording.calot", checkpoints = copy.path() + "/checkpoints.calot";
    {
        std::fstream file(checkpoints, std::ios::in | std::ios::out | std::ios::binary);
        file.seekp(200);
        file.put('\x55');
        file.put('\xaa');
    }
    try {
        reach(recording, 1100, nullptr, test::coarse_setup());
        FAIL();
    } catch (const InputError& error) {
        EXPECT_NE(error.describe().find("damaged"), std::string::npos) << error.describe();
    }
    fs::resize_file(checkpoints, 300);  // cut off: nothing whole is left in it
    EXPECT_TRUE(CheckpointReader(checkpoints).ticks().empty());
    const Moment moment = reach(recording, 1100, nullptr, test::coarse_setup());
    EXPECT_EQ(tissue::hash(moment.run->state()), shared().stored.hashes[1]);
    std::ofstream(checkpoints, std::ios::binary) << "something else";
    EXPECT_THROW(CheckpointReader{checkpoints}, InputError);
}

TEST(Session, OneThatNobodyFinishedIsRecovered) {
    const test::TestFolder folder("recover");
    Store store(folder.path());
    {
        simulation::Simulation run(test::coarse_setup());
        LiveSession live(store, start_with_task(), run);
        while (run.state().tick < 1050) {
            const tissue::Input input = run.setup().script.at(run.time_s());
            run.tick(input);
            live.after_tick(run, input);
        }
    }  // never finished
    ASSERT_EQ(recover(store).size(), 1u);
    const SessionRow row = store.session(1);
    EXPECT_EQ(row.status, SessionStatus::recovered);
    EXPECT_NEAR(row.duration_s, 1.05, 1e-9);
    EXPECT_GT(row.metrics.at("fat_removed_m3"), 0.0);
    EXPECT_TRUE(recover(store).empty());
}

}  // namespace
}  // namespace calot::training

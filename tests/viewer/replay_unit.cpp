// A stored run is looked at again: any moment, in any order, as it was.

#include "calot/viewer/replay.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <thread>

#include "calot/training/session.h"
#include "calot/viewer/session_core.h"
#include "viewer/small_scene.h"

namespace calot::viewer {
namespace {

constexpr int kTicks = 2600;

struct Stored {
    Stored()
        : folder(std::filesystem::temp_directory_path() / ("calot_replay." + std::to_string(::getpid()))),
          store(folder.string()) {
        auto run = test::small_run();
        training::LiveSession session(store, {}, *run);
        id = session.id();
        HandTarget hand = theatre_of(run->setup()).right_start;
        for (int tick = 0; tick < kTicks; ++tick) {
            tissue::Input input;
            hand.tip_m.z -= 8e-6;
            input.hook = instruments::pose_through_trocar(run->setup().script.trocar_m(), hand.tip_m, hand.roll_rad,
                                                          run->setup().hook);
            input.pedal = tick >= 1200 && tick < 1900;
            input.mode = tick < 1500 ? tissue::GeneratorMode::cut : tissue::GeneratorMode::coag;
            input.power_setting_W = input.pedal ? 30.0 : 0.0;
            input.suction = tick > 2000;
            run->tick(input);
            session.after_tick(*run, input);
            inputs.push_back(input);
        }
        session.finish(*run);
    }
    ~Stored() { std::filesystem::remove_all(folder); }
    std::filesystem::path folder;
    training::Store store;
    std::int64_t id = 0;
    std::vector<tissue::Input> inputs;
};

void wait_for(const std::function<bool()>& condition) {
    for (int k = 0; k < 60000; ++k) {
        if (condition()) return;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    FAIL() << "waited for a minute";
}

TEST(Replay, shows_any_moment_forwards_and_back) {
    const Stored stored;
    Replay replay(stored.store.path(stored.id, "recording.calot"));
    wait_for([&] { return replay.ready(); });
    EXPECT_EQ(replay.ticks(), kTicks);
    ASSERT_EQ(replay.pedal().size(), 2u);
    EXPECT_NEAR(replay.pedal()[0].from_s, 1.2, 1e-9);
    EXPECT_NEAR(replay.pedal()[0].to_s, 1.5, 1e-9);
    EXPECT_FALSE(replay.pedal()[0].coag);
    EXPECT_TRUE(replay.pedal()[1].coag);
    for (const std::int64_t tick : {2600, 1, 1000, 1001, 2300, 1200, 1234}) {
        replay.wish(tick);
        wait_for([&] { return replay.snapshots().update() && replay.snapshots().front().tick == tick; });
        const Snapshot& shown = replay.snapshots().front();
        EXPECT_EQ(shown.input.hook.position_m, stored.inputs[static_cast<std::size_t>(tick - 1)].hook.position_m);
        EXPECT_EQ(shown.input.suction, tick > 2001);
        EXPECT_FALSE(shown.view.tissue.empty());
        EXPECT_FALSE(shown.view.instrument.empty());
    }
    EXPECT_EQ(replay.trouble(), "");
}

TEST(Replay, tells_what_is_wrong) {
    Replay replay("/tmp/no-such-recording.calot");
    wait_for([&] { return !replay.trouble().empty(); });
    EXPECT_FALSE(replay.ready());
    EXPECT_NE(replay.trouble().find("no-such-recording"), std::string::npos);
}

// The hands take over where they were: the instrument does not jump.
TEST(Replay, hands_go_on_where_a_run_has_them) {
    const Stored stored;
    training::Moment moment = training::reach(const_cast<training::Store&>(stored.store), stored.id, 1300);
    const Vec3 hook_m = moment.run->state().hook.position_m;
    SessionCore core(std::move(moment.run), {});
    Controls controls;
    controls.right = core.theatre().right_start;
    controls.left = core.theatre().left_start;
    core.tick(controls);
    EXPECT_LT(glm::length(core.run().state().hook.position_m - hook_m), 2e-5);
}

}  // namespace
}  // namespace calot::viewer

// Sessions without a window: hands in, snapshots out.

#include "calot/viewer/session.h"

#include <gtest/gtest.h>

#include <atomic>

#include "calot/viewer/mapping.h"
#include "viewer/small_scene.h"

namespace calot::viewer {
namespace {

struct Counter : Observer {
    std::atomic<int> begun{0}, ticks{0}, ended{0};
    void begin(const simulation::Simulation&) override { ++begun; }
    void after_tick(const simulation::Simulation&, const tissue::Input&) override { ++ticks; }
    void end(const simulation::Simulation&) override { ++ended; }
};

/// Presses the hook into the block and burns.
std::uint64_t burn(int ticks) {
    SessionCore core(test::small_run(), {});
    Mapping mapping(core.theatre());
    Scope scope(core.run().setup().camera);
    for (int tick = 0; tick < ticks; ++tick) {
        Devices devices;
        if (tick % 16 == 0) devices.wheel = tick < 160 ? 2.0 : 0.0;
        devices.hold(Action::yellow_pedal, tick > 120);
        mapping.apply(devices, 1e-3, scope);
        EXPECT_TRUE(core.tick(mapping.controls()));
    }
    return tissue::hash(core.run().state());
}

TEST(SessionCore, same_hands_same_bytes) {
    EXPECT_EQ(burn(200), burn(200));
}

TEST(SessionCore, hook_follows_the_mouse_and_pedals_reach_the_generator) {
    SessionCore core(test::small_run(), {});
    Mapping mapping(core.theatre());
    Scope scope(core.run().setup().camera);
    Snapshot before, after;
    core.fill(before);
    Devices devices;
    devices.mouse_right = 0.05;
    mapping.apply(devices, 1.0 / 60.0, scope);
    for (int tick = 0; tick < 200; ++tick) core.tick(mapping.controls());
    core.fill(after);
    EXPECT_GT(after.tip_m.x, before.tip_m.x + 0.5e-3);
    EXPECT_FALSE(after.input.pedal);

    devices = {};
    devices.hold(Action::blue_pedal, true);
    mapping.apply(devices, 1.0 / 60.0, scope);
    core.tick(mapping.controls());
    core.fill(after);
    EXPECT_TRUE(after.input.pedal);
    EXPECT_EQ(after.input.mode, tissue::GeneratorMode::coag);
    devices.hold(Action::yellow_pedal, true);  // both: cutting wins
    mapping.apply(devices, 1.0 / 60.0, scope);
    core.tick(mapping.controls());
    core.fill(after);
    EXPECT_EQ(after.input.mode, tissue::GeneratorMode::cut);
    EXPECT_FALSE(after.view.tissue.empty());
    EXPECT_FALSE(after.view.instrument.empty());
}

TEST(SessionCore, left_hand_closes_the_grasper) {
    SessionCore core(test::small_run(), {});
    Mapping mapping(core.theatre());
    Scope scope(core.run().setup().camera);
    for (int tick = 0; tick < 50; ++tick) core.tick(mapping.controls());
    EXPECT_EQ(core.run().state().grasper.present, 1);
    const double open = core.run().state().grasper.jaw;
    Devices devices;
    devices.grasp_toggled = true;
    mapping.apply(devices, 1e-3, scope);
    for (int tick = 0; tick < 300; ++tick) core.tick(mapping.controls());
    EXPECT_GT(open, 0.5);
    EXPECT_LT(core.run().state().grasper.jaw, 0.05);
}

TEST(Session, runs_pauses_and_stops) {
    auto counter = std::make_shared<Counter>();
    SessionOptions options;
    options.observers = {counter};
    Session session(test::small_run(), options);
    EXPECT_EQ(counter->begun, 1);
    ASSERT_TRUE(session.update());  // there is a picture before the first tick
    EXPECT_EQ(session.snapshot().tick, 0);
    EXPECT_FALSE(session.snapshot().view.tissue.empty());

    Mapping mapping(session.theatre());
    session.start();
    auto wait_for = [&](auto&& condition) {
        for (int k = 0; k < 20000 && !condition(); ++k) {
            session.update();
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        return condition();
    };
    EXPECT_TRUE(wait_for([&] { return session.snapshot().tick >= 50; }));

    mapping.controls().paused = true;
    mapping.controls().sequence = 77;
    session.set(mapping.controls());
    ASSERT_TRUE(wait_for([&] { return session.snapshot().paused && session.snapshot().sequence == 77; }));
    const std::int64_t tick = session.snapshot().tick;
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
    EXPECT_EQ(counter->ticks, tick);

    mapping.controls().paused = false;
    session.set(mapping.controls());
    EXPECT_TRUE(wait_for([&] { return session.snapshot().tick > tick + 20; }));
    session.stop();
    EXPECT_EQ(counter->ended, 1);
    const int ticks = counter->ticks;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    EXPECT_EQ(counter->ticks, ticks);
}

TEST(Session, snapshot_answers_the_newest_controls) {
    Session session(test::small_run());
    Mapping mapping(session.theatre());
    session.start();
    for (int sample = 1; sample <= 20; ++sample) {
        mapping.controls().sequence = sample;
        mapping.controls().sampled_s = steady_s();
        session.set(mapping.controls());
        for (int k = 0; k < 20000 && session.snapshot().sequence != sample; ++k) {
            session.update();
            std::this_thread::sleep_for(std::chrono::microseconds(200));
        }
        ASSERT_EQ(session.snapshot().sequence, sample);
        EXPECT_EQ(session.snapshot().sampled_s, mapping.controls().sampled_s);
    }
}

}  // namespace
}  // namespace calot::viewer

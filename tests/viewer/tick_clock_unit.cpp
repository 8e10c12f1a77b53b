// Ticks against wall time, told by hand.

#include "calot/viewer/tick_clock.h"

#include <gtest/gtest.h>

namespace calot::viewer {
namespace {

TEST(TickClock, keeps_the_rate_when_ticks_are_in_time) {
    TickClock clock(1e-3);
    clock.start(10.0);
    for (int tick = 0; tick < 1000; ++tick) clock.begin_tick(clock.next_due_s() + 0.2e-3);
    EXPECT_NEAR(clock.next_due_s(), 11.0, 1e-9);
    EXPECT_EQ(clock.late_ticks(), 0);
    EXPECT_EQ(clock.lost_s(), 0.0);
}

TEST(TickClock, makes_up_for_a_short_hold_up) {
    TickClock clock(1e-3);
    clock.start(0.0);
    clock.begin_tick(0.0);
    double now = 0.006;  // 5 ms late: five ticks follow at once, then the schedule is kept again
    int at_once = 0;
    while (clock.next_due_s() <= now) {
        clock.begin_tick(now);
        ++at_once;
    }
    EXPECT_EQ(at_once, 6);
    EXPECT_EQ(clock.late_ticks(), 4);  // those more than one interval late
    EXPECT_EQ(clock.lost_s(), 0.0);
    EXPECT_NEAR(clock.next_due_s(), 0.007, 1e-12);
}

TEST(TickClock, slows_simulated_time_instead_of_spiralling) {
    TickClock clock(1e-3);
    clock.start(0.0);
    double now = 0.0;
    for (int tick = 0; tick < 1000; ++tick) {  // every tick takes twice its interval
        clock.begin_tick(now);
        now += 2e-3;
        EXPECT_LE(now - clock.next_due_s(), TickClock::kMostLag_s + 2e-3);
    }
    EXPECT_NEAR(clock.lost_s(), 1.0, 0.02);  // 1 s simulated in 2 s
    EXPECT_GT(clock.late_ticks(), 950);
}

TEST(TickClock, a_pause_is_not_made_up_for) {
    TickClock clock(1e-3);
    clock.start(0.0);
    clock.begin_tick(0.0);
    clock.start(100.0);
    clock.begin_tick(100.0);
    EXPECT_EQ(clock.late_ticks(), 0);
    EXPECT_EQ(clock.lost_s(), 0.0);
    EXPECT_NEAR(clock.next_due_s(), 100.001, 1e-9);
}

TEST(RateMeter, counts_events_a_second) {
    RateMeter meter;
    EXPECT_EQ(meter.per_s(), 0.0);
    for (int k = 0; k <= 1200; ++k) meter.add(5.0 + k / 1000.0);
    EXPECT_NEAR(meter.per_s(), 1000.0, 3.0);
    for (int k = 1; k <= 120; ++k) meter.add(6.2 + k / 60.0);
    EXPECT_NEAR(meter.per_s(), 60.0, 2.0);
}

}  // namespace
}  // namespace calot::viewer

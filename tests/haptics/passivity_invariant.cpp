// The virtual world never gives the hand energy, however badly it behaves.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "calot/base/random.h"
#include "calot/haptics/passivity.h"

namespace calot::haptics {

namespace {

constexpr double kStep_s = 1e-3, kMass_kg = 0.05;

/// The start's energy, and what the hand's accelerations between samples take that nobody foresees: 3 N over what
/// 20 m/s^2 beyond the expected move in a millisecond.
const double kLeastEnergy_J = -PassivityParameters{}.start_J - 3.0 * 0.5 * 20.0 * 1e-6;

/// A mass held by a limp hand (30 N/m, 0.5 N s/m) in front of a world that answers to its position of some steps ago.
struct LimpHand {
    double position_m = 0.0, velocity_m_per_s = 0.0, target_m = 0.0;

    void move(double force_N) {
        for (int k = 0; k < 10; ++k) {
            const double push_N = 30.0 * (target_m - position_m) - 0.5 * velocity_m_per_s + force_N;
            velocity_m_per_s += 0.1 * kStep_s * push_N / kMass_kg;
            position_m += 0.1 * kStep_s * velocity_m_per_s;
        }
    }
};

}  // namespace

// A stiff wall that answers five milliseconds late throws the hand off and buzzes when nothing is done about it; with
// the controller the hand comes to rest at the wall.
TEST(Passivity, CalmsADelayedWall) {
    for (const bool control : {false, true}) {
        PassivityControl passivity;
        LimpHand hand;
        std::array<double, 5> past{};
        double force_N = 0.0, fastest = 0.0;
        for (int k = 0; k < 4000; ++k) {
            hand.target_m = -0.02;
            const double before_m = hand.position_m;
            hand.move(force_N);
            passivity.observe(Vec3(0.0, hand.position_m - before_m, 0.0));
            const auto slot = static_cast<std::size_t>(k) % past.size();
            const double seen_m = past[slot];
            past[slot] = hand.position_m;
            const Vec3 wanted_N(0.0, seen_m < -0.01 ? std::min(3.3, -1500.0 * (seen_m + 0.01)) : 0.0, 0.0);
            const Vec3 given_N = passivity.limit(wanted_N, Vec3(0.0, hand.velocity_m_per_s, 0.0), kStep_s, kMass_kg);
            force_N = control ? given_N.y : wanted_N.y;
            if (k > 3000) fastest = std::max(fastest, std::abs(hand.velocity_m_per_s));
        }
        if (control) {
            EXPECT_LT(fastest, 0.05);
            EXPECT_GE(passivity.least_absorbed_J(), kLeastEnergy_J);
            EXPECT_GT(passivity.limited(), 0);
        } else {
            EXPECT_GT(fastest, 0.1) << "otherwise this test shows nothing";
        }
    }
}

// Forces that have nothing to do with the hand: random, and pushing along with it.
TEST(Passivity, NeverPaysOutMoreThanItTook) {
    for (const bool along : {false, true}) {
        PassivityControl passivity;
        Random random(1);
        LimpHand hand;
        double force_N = 0.0, given_J = 0.0;
        for (std::uint64_t k = 0; k < 20000; ++k) {
            hand.target_m = 0.02 * std::sin(0.004 * static_cast<double>(k));
            const double before_m = hand.position_m;
            hand.move(force_N);
            const double moved_m = hand.position_m - before_m;
            given_J += force_N * moved_m;
            passivity.observe(Vec3(0.0, moved_m, 0.0));
            const double wanted_N = along ? std::copysign(2.0, hand.velocity_m_per_s) : random.uniform(-3.0, 3.0);
            force_N =
                passivity.limit(Vec3(0.0, wanted_N, 0.0), Vec3(0.0, hand.velocity_m_per_s, 0.0), kStep_s, kMass_kg).y;
            ASSERT_GE(passivity.absorbed_J(), kLeastEnergy_J) << k;
        }
        // But for the first step, where the hand did not move yet.
        EXPECT_NEAR(given_J, -passivity.absorbed_J(), 1e-5) << "the observer counts what there was";
        EXPECT_GT(passivity.withheld_J(), 1e-3);
    }
}

// A spring gives back what it took. Sampling costs 20 uJ a cycle, so the last 0.06 N may be missing, no more.
TEST(Passivity, LeavesASpringAlone) {
    PassivityControl passivity;
    double withheld_N = 0.0, before_m = 0.0;
    Vec3 force_N(0.0);
    for (int k = 0; k < 6000; ++k) {
        const double phase = 1e-3 * k, position_m = -0.01 * std::pow(std::sin(phase), 2.0);
        const double velocity = -0.01 * std::sin(2.0 * phase);
        passivity.observe(Vec3(0.0, position_m - before_m, 0.0));
        before_m = position_m;
        const Vec3 wanted_N(0.0, -100.0 * position_m, 0.0);
        force_N = passivity.limit(wanted_N, Vec3(0.0, velocity, 0.0), kStep_s, kMass_kg);
        if (wanted_N.y > 0.15) withheld_N = std::max(withheld_N, wanted_N.y - force_N.y);
    }
    EXPECT_EQ(withheld_N, 0.0);
    EXPECT_GE(passivity.least_absorbed_J(), -PassivityParameters{}.start_J);
}

// A hand that comes very slowly from the first moment on feels what is there.
TEST(Passivity, SlowHandsFeelToo) {
    PassivityControl passivity;
    for (int k = 0; k < 20000; ++k) {
        const double position_m = -5e-7 * k;  // 0.5 mm/s
        passivity.observe(Vec3(0.0, k == 0 ? 0.0 : -5e-7, 0.0));
        const Vec3 wanted_N(0.0, -30.0 * position_m, 0.0);
        ASSERT_EQ(passivity.limit(wanted_N, Vec3(0.0, -5e-4, 0.0), kStep_s, kMass_kg), k == 0 ? Vec3(0.0) : wanted_N);
    }
}

// What tissue dissipated is no licence to be active later.
TEST(Passivity, TheTankIsBounded) {
    PassivityControl passivity;
    for (int k = 0; k < 10000; ++k) {
        passivity.limit(Vec3(0.0, 1.0, 0.0), Vec3(0.0, -0.1, 0.0), kStep_s, kMass_kg);
        passivity.observe(Vec3(0.0, -1e-4, 0.0));
    }
    EXPECT_NEAR(passivity.absorbed_J(), 1.0, 1e-9);
    EXPECT_EQ(passivity.tank_J(), PassivityParameters{}.capacity_J);
}

// Encoders that show movement in steps: the observer still counts the work that was done.
TEST(Passivity, CountsThroughCoarseEncoders) {
    PassivityControl passivity;
    double shown_m = 0.0, true_J = 0.0, position_m = 0.0;
    Vec3 force_N(0.0);
    for (int k = 0; k < 8000; ++k) {
        const double before_m = position_m;
        position_m = -0.01 * std::pow(std::sin(0.5e-3 * k), 2.0);
        true_J -= force_N.y * (position_m - before_m);
        const double seen_m = 0.055e-3 * std::round(position_m / 0.055e-3);
        passivity.observe(Vec3(0.0, seen_m - shown_m, 0.0));
        shown_m = seen_m;
        force_N = passivity.limit(Vec3(0.0, -30.0 * seen_m, 0.0), Vec3(0.0), kStep_s, kMass_kg);
        ASSERT_NEAR(passivity.absorbed_J(), true_J, 0.03 * 1.5e-3 + 5e-6) << k;  // of what the spring stores at most
    }
}

}  // namespace calot::haptics

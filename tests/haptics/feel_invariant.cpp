// What the hand of the simulated device feels: a soft block, a wall, a cut. And that it never gets energy back that it
// did not put in.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "rig.h"

namespace calot::haptics {

namespace {

/// What the passivity controller may give before it took anything.
const double kLeastEnergy_J = -PassivityParameters{}.start_J;

HandParameters exact_hand() {
    HandParameters hand;
    hand.resolution_m = 0.0;
    return hand;
}

}  // namespace

// Pressing into 5 kPa fat and releasing it (the paper's Fig. 16): the force on the hand grows with depth, is that of
// fat (docs/physics.md section 8), is the tissue's own to a few millinewtons, and goes as it came.
TEST(SoftBlock, PushesBackTheMoreTheDeeper) {
    Rig rig(fat_setup(), press_and_release(16e-3, 4.0), Vec3(0.0, 0.0, 3e-3), rig_options(), exact_hand());
    constexpr double kBin_m = 0.5e-3, kMostDip_N = 0.01, kMostDifference_N = 2e-2;  // 10 mN seen
    std::vector<double> sum_N(40, 0.0);
    std::vector<int> count(40, 0);
    double touched_z = 1.0, deepest_m = 0.0, greatest_N = 0.0, at_5mm_N = 0.0;
    Vec3 before_N(0.0);
    for (int k = 0; k < 3900; ++k) {
        const Moment& m = rig.tick();
        ASSERT_EQ(m.servo.fault, Fault::none);
        const double force_N = m.servo.device_force_N.y;
        if (touched_z == 1.0 && m.tissue_N.z > 1e-3) touched_z = m.tip_m.z;
        const double depth_m = touched_z == 1.0 ? 0.0 : touched_z - m.tip_m.z;
        if (k > 400 && k < 1800) {
            ASSERT_NEAR(m.servo.true_force_N.y, before_N.z, kMostDifference_N) << "at " << m.time_s;
        }
        before_N = m.tissue_N;
        if (k < 1800 && depth_m > 0.0) {
            const auto bin = static_cast<std::size_t>(depth_m / kBin_m);
            ASSERT_LT(bin, sum_N.size());
            sum_N[bin] += force_N;
            ++count[bin];
            if (depth_m <= 5e-3) at_5mm_N = force_N;
            deepest_m = std::max(deepest_m, depth_m);
            greatest_N = std::max(greatest_N, force_N);
        }
    }
    EXPECT_GT(deepest_m, 9e-3);
    EXPECT_LT(deepest_m, 15e-3);
    EXPECT_GT(at_5mm_N, 0.06);
    EXPECT_LT(greatest_N, 0.45);
    double most_N = 0.0;
    for (std::size_t bin = 0; bin < sum_N.size(); ++bin) {
        if (count[bin] == 0) continue;
        const double mean_N = sum_N[bin] / count[bin], depth_m = kBin_m * (static_cast<double>(bin) + 0.5);
        EXPECT_GT(mean_N, most_N - kMostDip_N) << "at " << depth_m * 1e3 << " mm";
        if (depth_m > 5e-3 && depth_m < 10e-3) {
            EXPECT_GT(mean_N, 0.06);
            EXPECT_LT(mean_N, 0.3);
        }
        most_N = std::max(most_N, mean_N);
    }
    const SessionStatus end = rig.session().status();
    EXPECT_GT(end.servo.absorbed_J, 0.0) << "tissue damps";
    EXPECT_GE(end.servo.least_absorbed_J, kLeastEnergy_J);
    EXPECT_NEAR(glm::length(end.servo.device_force_N), 0.0, 2e-3) << "off the tissue there is nothing to feel";
}

// A rigid organ is a wall: the instrument stops, the force is the coupling's spring, and nothing buzzes.
TEST(Wall, StopsTheInstrumentAndHoldsStill) {
    for (const double resolution_m : {0.0, 0.055e-3}) {
        HandParameters hand;
        hand.resolution_m = resolution_m;
        Rig rig(wall_setup(), press_and_release(12e-3, 2.0), Vec3(0.03, 0.0, 4e-3), rig_options(), hand);
        double least_z = 1.0, least_N = 1e9, greatest_N = 0.0, touched_z = -1.0;
        for (int k = 0; k < 1950; ++k) {
            const Moment& m = rig.tick();
            ASSERT_EQ(m.servo.fault, Fault::none);
            if (touched_z < 0.0 && m.tissue_N.z > 0.0) touched_z = m.tip_m.z;
            least_z = std::min(least_z, m.tip_m.z);
            if (k > 1000 && k < 1100) {
                least_N = std::min(least_N, m.servo.device_force_N.y);
                greatest_N = std::max(greatest_N, m.servo.device_force_N.y);
            }
        }
        EXPECT_LT(touched_z - least_z, 2.5e-3) << "the hand asked for 9 mm and more";
        EXPECT_GT(least_N, 1.0);
        EXPECT_LT(greatest_N - least_N, 0.08) << "three steps of the encoder";
        EXPECT_GE(rig.session().status().servo.least_absorbed_J, kLeastEnergy_J);
    }
}

// The pedal is the stylus' first button: the fat under the hook burns away and the push is gone.
TEST(Cut, TakesTheForceAway) {
    const std::vector<HandKey> script{{0.0, Vec3(0.0)},
                                      {0.4, Vec3(0.0, -9e-3, 0.0)},
                                      {0.7, Vec3(0.0, -9e-3, 0.0), 1},
                                      {2.2, Vec3(0.0, -9e-3, 0.0), 0}};
    Rig rig(fat_setup(), script, Vec3(0.0, 0.0, 3e-3));
    rig.input().mode = tissue::GeneratorMode::cut;
    rig.input().power_setting_W = 60.0;
    double before_N = 0.0, after_N = 0.0;
    for (int k = 0; k < 2300; ++k) {
        const Moment& m = rig.tick();
        ASSERT_EQ(m.servo.fault, Fault::none);
        if (k == 690) before_N = m.servo.device_force_N.y;
        if (k == 2290) after_N = m.servo.device_force_N.y;
    }
    EXPECT_GT(rig.simulation().state().hexels_burnt, 50);
    EXPECT_GT(before_N, 0.08);
    EXPECT_LT(after_N, 0.6 * before_N);  // 0.52 seen: the crater's wall still touches the wire
}

}  // namespace calot::haptics

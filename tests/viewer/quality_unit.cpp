#include "calot/viewer/quality.h"

#include <gtest/gtest.h>

namespace calot::viewer {
namespace {

/// Feeds pictures that take `draw_s` each for a while; returns the tier at the end.
int after(QualityGovernor& governor, double draw_s, double for_s, double& now_s) {
    for (const double until_s = now_s + for_s; now_s < until_s; now_s += 1.0 / 30.0) governor.add(draw_s, now_s);
    return governor.tier();
}

TEST(Quality, gets_coarser_until_pictures_come_quickly_enough) {
    QualityGovernor governor(3);
    double now_s = 0.0;
    EXPECT_EQ(after(governor, 0.2, 20.0, now_s), 0);   // hopeless: the coarsest
    EXPECT_EQ(after(governor, 0.03, 20.0, now_s), 0);  // neither slow nor quick: stays
}

TEST(Quality, gets_finer_where_there_is_time_and_does_not_swing) {
    QualityGovernor governor(3);
    double now_s = 0.0;
    const int finest = static_cast<int>(tiers().size()) - 1;
    EXPECT_EQ(after(governor, 0.004, 60.0, now_s), finest);
    // The finest turns out too slow: one down, and it is not tried again at once.
    int changes = 0;
    for (int k = 0; k < 600; ++k, now_s += 1.0 / 30.0)
        changes += governor.add(governor.tier() == finest ? 0.09 : 0.006, now_s);
    EXPECT_EQ(changes, 1);
    EXPECT_EQ(governor.tier(), finest - 1);
}

TEST(Quality, what_is_chosen_stays) {
    QualityGovernor governor(3);
    double now_s = 0.0;
    governor.fix(5);
    EXPECT_EQ(after(governor, 0.3, 10.0, now_s), 5);
    governor.release();
    EXPECT_LT(after(governor, 0.3, 10.0, now_s), 5);
}

TEST(Quality, software_renderers_start_coarse) {
    EXPECT_LT(start_tier("llvmpipe (LLVM 15.0.6, 256 bits)"), start_tier("NVIDIA GeForce RTX 3060/PCIe/SSE2"));
}

}  // namespace
}  // namespace calot::viewer

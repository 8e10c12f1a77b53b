#include "calot/haptics/spread.h"

#include <gtest/gtest.h>

namespace calot::haptics {

TEST(Spread, TellsMeanQuantilesAndTheGreatest) {
    Spread spread;
    for (int k = 1; k <= 100; ++k) spread.add(k * 1e-4);
    EXPECT_EQ(spread.count(), 100u);
    EXPECT_NEAR(spread.mean_s(), 50.5e-4, 1e-9);
    EXPECT_NEAR(spread.quantile_s(0.5), 50e-4, 2e-5);
    EXPECT_NEAR(spread.quantile_s(0.99), 99e-4, 2e-5);
    EXPECT_NEAR(spread.most_s(), 1e-2, 1e-12);
    spread.add(7.0);
    EXPECT_EQ(spread.quantile_s(1.0), 7.0);
}

}  // namespace calot::haptics

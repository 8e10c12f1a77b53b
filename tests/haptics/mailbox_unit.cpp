// The latest value, whole, in order, without waiting.
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <thread>

#include "calot/haptics/mailbox.h"
#include "calot/haptics/spread.h"

namespace calot::haptics {

TEST(Mailbox, GivesEachValueOnceAndTheLatestOnly) {
    Mailbox<int> box;
    int value = -1;
    EXPECT_FALSE(box.take(value));
    box.put(1);
    box.put(2);
    EXPECT_TRUE(box.take(value));
    EXPECT_EQ(value, 2);
    EXPECT_FALSE(box.take(value));
    EXPECT_EQ(value, 2);
    box.put(3);
    EXPECT_TRUE(box.take(value));
    EXPECT_EQ(value, 3);
}

// A writer and a reader at full speed: never a torn value, never one older than the last.
TEST(Mailbox, IsWholeAndInOrderBetweenThreads) {
    using Value = std::array<long, 40>;
    constexpr long kLast = 200000;
    Mailbox<Value> box;
    std::thread writer([&] {
        Value value;
        for (long k = 1; k <= kLast; ++k) {
            value.fill(k);
            box.put(value);
        }
    });
    Value value{};
    long before = 0, taken = 0;
    while (before < kLast) {
        if (!box.take(value)) continue;
        ++taken;
        for (const long part : value) ASSERT_EQ(part, value[0]);
        ASSERT_GT(value[0], before);
        before = value[0];
    }
    writer.join();
    EXPECT_GT(taken, 0);
}

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

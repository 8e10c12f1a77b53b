#include "calot/base/triple_buffer.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <thread>

namespace calot {
namespace {

TEST(TripleBuffer, gives_the_newest_value_once) {
    TripleBuffer<int> buffer;
    EXPECT_FALSE(buffer.update());
    buffer.back() = 1;
    buffer.publish();
    buffer.back() = 2;
    buffer.publish();
    EXPECT_TRUE(buffer.waiting());
    ASSERT_TRUE(buffer.update());
    EXPECT_EQ(buffer.front(), 2);
    EXPECT_FALSE(buffer.update());
    EXPECT_EQ(buffer.front(), 2);
    buffer.back() = 3;
    EXPECT_FALSE(buffer.update());  // not before it is published
}

TEST(TripleBuffer, puts_and_takes_copies) {
    TripleBuffer<int> buffer;
    int value = -1;
    EXPECT_FALSE(buffer.take(value));
    buffer.put(1);
    buffer.put(2);
    EXPECT_TRUE(buffer.take(value));
    EXPECT_EQ(value, 2);
    EXPECT_FALSE(buffer.take(value));
    EXPECT_EQ(value, 2);
}

TEST(TripleBuffer, reader_never_sees_a_half_written_value) {
    struct Value {
        std::array<std::uint64_t, 64> words{};
    };
    TripleBuffer<Value> buffer;
    constexpr std::uint64_t kLast = 200'000;
    std::thread writer([&] {
        for (std::uint64_t k = 1; k <= kLast; ++k) {
            buffer.back().words.fill(k);
            buffer.publish();
        }
    });
    std::uint64_t seen = 0;
    bool whole = true, forwards = true;
    while (seen != kLast) {
        if (!buffer.update()) {
            std::this_thread::yield();
            continue;
        }
        const auto& words = buffer.front().words;
        for (const std::uint64_t word : words) whole = whole && word == words[0];
        forwards = forwards && words[0] > seen;
        seen = words[0];
    }
    writer.join();
    EXPECT_TRUE(whole);
    EXPECT_TRUE(forwards);
}

}  // namespace
}  // namespace calot

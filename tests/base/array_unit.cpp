// Where arrays come from: shared stretches of memory for large ones.

#include "calot/base/array.h"

#include <algorithm>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace calot {
namespace {

TEST(Array, KeepsItsContentsWhileOthersComeAndGo) {
    constexpr std::size_t kSizes[] = {1, 1000, 5000, 300000, 3000000};
    std::vector<Array<std::uint32_t>> kept;
    for (std::uint32_t round = 0; round < 40; ++round) {
        const std::size_t size = kSizes[round % std::size(kSizes)];
        kept.emplace_back(size, round);
        ASSERT_EQ(reinterpret_cast<std::uintptr_t>(kept.back().data()) % 64, 0u);
        if (round % 3 == 2) kept.erase(kept.begin() + round % static_cast<std::ptrdiff_t>(kept.size()));
        Array<std::uint32_t> passing(size, ~0u);
        for (const auto& array : kept)
            ASSERT_TRUE(std::all_of(array.begin(), array.end(), [&](std::uint32_t x) { return x == array.front(); }));
    }
}

TEST(Array, LargeOnesBeginAtDifferentPlacesWithinPages) {
    std::vector<Array<float>> arrays;
    std::vector<std::uintptr_t> places;
    for (int k = 0; k < 40; ++k) {
        arrays.emplace_back(65536 / sizeof(float));
        places.push_back(reinterpret_cast<std::uintptr_t>(arrays.back().data()) % 4096);
    }
    std::sort(places.begin(), places.end());
    // 64 lines a page: of 40 arrays few may share one.
    EXPECT_GT(std::unique(places.begin(), places.end()) - places.begin(), 20);
}

TEST(Array, LargeOnesAreCountedWhileTheyLive) {
    const std::size_t before = large_array_bytes();
    {
        const Array<float> large(1000000);
        EXPECT_GE(large_array_bytes() - before, 4000000u);
        EXPECT_LT(large_array_bytes() - before, 4100000u);
    }
    EXPECT_EQ(large_array_bytes(), before);
}

TEST(Array, ComesFromSeveralThreads) {
    std::vector<std::thread> threads;
    for (std::uint32_t t = 0; t < 4; ++t)
        threads.emplace_back([t] {
            for (std::uint32_t k = 0; k < 200; ++k) {
                const Array<std::uint32_t> array(20000 + 1000 * (k % 7), t);
                ASSERT_EQ(std::count(array.begin(), array.end(), t), static_cast<std::ptrdiff_t>(array.size()));
            }
        });
    for (std::thread& thread : threads) thread.join();
}

}  // namespace
}  // namespace calot

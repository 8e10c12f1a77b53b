#include "support/allocations.h"

#include <array>
#include <memory>

#include <gtest/gtest.h>

#include "calot/base/array.h"

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

namespace calot::test {

// Other tests ask that this count does not move; here it must.
TEST(Allocations, AreCounted) {
    const long before = allocations();
    const auto something = std::make_unique<std::array<double, 8>>();
    EXPECT_EQ(allocations(), before + 1);
    EXPECT_NE(something, nullptr);
}

TEST(Allocations, LargeArraysAreCounted) {
    const long before = allocations();
    const Array<float> large(100000);
    EXPECT_GT(allocations(), before);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(large.data()) % 64, 0u);
}

}  // namespace calot::test

#endif

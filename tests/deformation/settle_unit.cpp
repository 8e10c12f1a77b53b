#include "calot/deformation/settle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace calot::deformation {
namespace {

TEST(Settle, LeavesNothingSubnormalAndAllThatMoves) {
    tissue::State state;
    const std::array<float, 8> values{
        0.0f, -0.0f, std::numeric_limits<float>::denorm_min(), -3e-39f, -2e-15f, 1.5e-6f, std::nanf(""), 1e-3f};
    for (auto& u : state.displacement_m) u.assign(values.size(), 0.0f);
    for (auto& v : state.velocity_m_per_s) v.assign(values.size(), 0.0f);
    for (std::size_t k = 0; k < values.size(); ++k)
        state.displacement_m[1][k] = values[k], state.velocity_m_per_s[2][k] = 1e3f * values[k];
    settle(state);
    for (const std::size_t still : {0, 1, 2, 3}) {
        EXPECT_EQ(state.displacement_m[1][still], 0.0f);
        EXPECT_EQ(state.velocity_m_per_s[2][still], 0.0f);
    }
    for (const std::size_t moves : {4, 5, 7}) {
        EXPECT_EQ(state.displacement_m[1][moves], values[moves]);
        EXPECT_EQ(state.velocity_m_per_s[2][moves], 1e3f * values[moves]);
    }
    EXPECT_TRUE(std::isnan(state.displacement_m[1][6]));  // trouble stays to be seen
}

}  // namespace
}  // namespace calot::deformation

#include "calot/surface/field.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>

#include "calot/base/random.h"
#include "calot/surface/vertex_batch.h"

namespace calot::surface {

namespace {

Window window_of(const std::function<bool(int, int, int)>& filled) {
    Window window{};
    for (int z = -kReach; z < Window::kEdge + kReach; ++z)
        for (int y = -kReach; y < Window::kEdge + kReach; ++y)
            for (int x = -kReach; x < Window::kEdge + kReach; ++x)
                if (filled(x, y, z)) window.row(y, z) |= 1u << (x + kReach);
    return window;
}

float value_at(const Window& window, int x, int y, int z) {
    return field_value(moments_at(window, x, y, z), window.test(x, y, z));
}

/// Eq. (19) in units of L, with the weights of (17).
double printed_value(const Window& window, int x, int y, int z) {
    const Moments m = moments_at_reference(window, x, y, z);
    return m.weight == 0 ? 2.0 : glm::length(Vec3(m.mean) / double{1.0 * m.weight}) - 0.5;
}

constexpr int c = 4;  // a point in the middle

}  // namespace

TEST(Field, WeightsAreThoseOfTheKernel) {
    int sum = 0;
    for (int dz = -3; dz <= 3; ++dz)
        for (int dy = -3; dy <= 3; ++dy)
            for (int dx = -3; dx <= 3; ++dx) {
                const int d2 = dx * dx + dy * dy + dz * dz;
                const double w = d2 < 6.25 ? std::pow(1.0 - d2 / 6.25, 3) : 0.0;
                EXPECT_NEAR(field_weight(d2) / 15625.0, w, 1e-15);
                EXPECT_NEAR(slope_weight(d2) * 240.0 / 117649.0, d2 < 12.25 ? std::pow(1.0 - d2 / 12.25, 3) : 0.0,
                            1.0 / 490.0);
                sum += field_weight(d2);
            }
    EXPECT_EQ(sum, kFullFieldWeight);
}

TEST(Field, TablesEqualNeighbourByNeighbour) {
    Random random(7);
    for (double share : {0.02, 0.5, 0.97, 1.0}) {
        const Window window = window_of([&](int, int, int) { return random.uniform() < share; });
        for (int z = 0; z < Window::kEdge; ++z)
            for (int y = 0; y < Window::kEdge; ++y)
                for (int x = 0; x < Window::kEdge; ++x)
                    ASSERT_EQ(moments_at(window, x, y, z), moments_at_reference(window, x, y, z))
                        << x << ' ' << y << ' ' << z;
    }
}

TEST(Field, TablesHoldTheLargestMoments) {
    for (int axis = 0; axis < 3; ++axis)
        for (bool upper : {false, true}) {
            const Window half = window_of(
                [&](int x, int y, int z) { return upper ? Int3(x, y, z)[axis] >= c : Int3(x, y, z)[axis] <= c; });
            EXPECT_EQ(moments_at(half, c, c, c), moments_at_reference(half, c, c, c));
        }
}

TEST(Field, IsDistanceFromAFlatSurface) {
    const Window window = window_of([](int, int, int z) { return z <= c; });
    // The surface lies half-way between the last hexel and the first gap.
    const float inside = value_at(window, c, c, c), outside = value_at(window, c, c, c + 1);
    EXPECT_FLOAT_EQ(inside / (inside - outside), 0.5f);
    EXPECT_NEAR(inside, -0.5f, 0.02f);
    // As printed it lies at 0.218 L above the centre.
    const double printed = printed_value(window, c, c, c), printed_above = printed_value(window, c, c, c + 1);
    EXPECT_NEAR(printed / (printed - printed_above), 0.218, 0.001);
}

TEST(Field, KeepsWhatIsThin) {
    const Window lone = window_of([](int x, int y, int z) { return x == c && y == c && z == c; });
    EXPECT_FLOAT_EQ(value_at(lone, c, c, c), -0.5f);
    EXPECT_GT(value_at(lone, c + 1, c, c), 0.4f);
    const Window sheet = window_of([](int x, int, int) { return x == c; });
    EXPECT_FLOAT_EQ(value_at(sheet, c, c, c), -0.5f);
    EXPECT_GT(value_at(sheet, c + 1, c, c), 0.4f);
    // A gap one hexel wide is the sheet's mirror image; as printed it is closed.
    const Window gap = window_of([](int x, int, int) { return x != c; });
    EXPECT_FLOAT_EQ(value_at(gap, c, c, c), 0.5f);
    EXPECT_LT(printed_value(gap, c, c, c), 0.0);
    // So is a cluster of 2^3, which as printed has no surface at all.
    const Window cluster =
        window_of([](int x, int y, int z) { return x / 2 == c / 2 && y / 2 == c / 2 && z / 2 == c / 2; });
    EXPECT_LE(value_at(cluster, c, c, c), -kLeastValue);
    EXPECT_GT(printed_value(cluster, c, c, c), 0.0);
}

TEST(Field, SignIsPresence) {
    Random random(11);
    const Window window = window_of([&](int, int, int) { return random.uniform() < 0.5; });
    for (int z = 0; z < Window::kEdge; ++z)
        for (int y = 0; y < Window::kEdge; ++y)
            for (int x = 0; x < Window::kEdge; ++x) {
                const float v = value_at(window, x, y, z);
                EXPECT_EQ(v < 0.0f, window.test(x, y, z));
                EXPECT_GE(std::abs(v), kLeastValue);
                EXPECT_LE(std::abs(v), 3.0f);
            }
}

TEST(Field, WideEqualsScalar) {
    // Every count up to two vectors: no lane is forgotten, none runs over.
    Random random(13);
    for (std::size_t count = 0; count <= 33; ++count) {
        const double share = random.uniform();
        const Window window = window_of([&](int, int, int) { return random.uniform() < share; });
        PointBatch points;
        for (std::size_t k = 0; k < count; ++k) {
            const int x = static_cast<int>(k % 9), y = static_cast<int>(k / 9);
            points.add(moments_at(window, x, y, c), window.test(x, y, c));
        }
        evaluate(points);
        const auto wide = points.value;
        evaluate_reference(points);
        ASSERT_EQ(std::memcmp(wide.data(), points.value.data(), count * sizeof(float)), 0);

        EdgeBatch edges;
        for (std::size_t k = 0; k + 1 < count; ++k)
            if ((points.value[k] < 0.0f) != (points.value[k + 1] < 0.0f))
                edges.add(points, k, k + 1, static_cast<int>(k % 3));
        // One without any slope: its normal falls back on the edge.
        for (auto* slope : {&edges.lower_slope, &edges.upper_slope})
            for (auto& lane : *slope) lane[0] = 0.0f;
        evaluate(edges);
        const auto share_of = edges.share;
        const auto normal = edges.normal;
        evaluate_reference(edges);
        ASSERT_EQ(std::memcmp(share_of.data(), edges.share.data(), edges.count * sizeof(float)), 0);
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t e = 0; e < edges.count; ++e)
                ASSERT_EQ(normal[k][e], edges.normal[k][e]) << count << ' ' << e;
    }
}

}  // namespace calot::surface

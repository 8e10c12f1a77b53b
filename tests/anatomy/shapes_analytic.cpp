#include <gtest/gtest.h>

#include <cmath>

#include "calot/anatomy/cached.h"
#include "calot/anatomy/noise.h"
#include "calot/anatomy/shapes.h"
#include "calot/anatomy/tube.h"
#include "calot/base/random.h"

namespace calot::anatomy {

namespace {

Vec3 random_point(Random& random, double reach) {
    return Vec3(random.uniform(-reach, reach), random.uniform(-reach, reach), random.uniform(-reach, reach));
}

}  // namespace

TEST(Tube, IsACapsuleWhenStraight) {
    const Tube tube({{Vec3(0.0), 0.002}, {Vec3(0.01, 0.0, 0.0), 0.002}});
    EXPECT_NEAR(tube.distance_m(Vec3(0.005, 0.003, 0.004)), 0.003, 1e-15);
    EXPECT_NEAR(tube.distance_m(Vec3(0.013, 0.0, 0.004)), 0.003, 1e-15);
    EXPECT_NEAR(tube.distance_m(Vec3(0.002, 0.0, 0.0)), -0.002, 1e-15);
}

TEST(Tube, CurvePassesThroughItsControlPoints) {
    const std::vector<TubePoint> control{
        {Vec3(0, 0, 0), 1}, {Vec3(1, 0, 0), 2}, {Vec3(2, 1, 0), 1}, {Vec3(2, 2, 1), 3}};
    const std::vector<TubePoint> curve = smooth_curve(control, 6);
    for (std::size_t k = 0; k < control.size(); ++k) {
        EXPECT_NEAR(glm::length(curve[6 * k].position_m - control[k].position_m), 0.0, 1e-14);
        EXPECT_NEAR(curve[6 * k].radius_m, control[k].radius_m, 1e-14);
    }
    const std::vector<TubePoint> even = resample(curve, 40);
    EXPECT_NEAR(length_m(even) / length_m(curve), 1.0, 2e-3);  // chords cut corners
}

TEST(Noise, StaysInItsRangeAndSlope) {
    Random random(7);
    double steepest_gradient = 0.0, steepest_lobule = 0.0, sum = 0.0;
    constexpr int kPoints = 40000;
    constexpr double kStep = 1e-4;
    for (int k = 0; k < kPoints; ++k) {
        const Vec3 p = random_point(random, 50.0), q = p + kStep * glm::normalize(random_point(random, 1.0));
        const double g = gradient_noise(p, 3), l = lobule_noise(p, 3);
        ASSERT_LE(std::abs(g), 1.0);
        ASSERT_GE(l, 0.0);
        ASSERT_LE(l, 1.0);
        steepest_gradient = std::max(steepest_gradient, std::abs(gradient_noise(q, 3) - g) / kStep);
        steepest_lobule = std::max(steepest_lobule, std::abs(lobule_noise(q, 3) - l) / kStep);
        sum += g;
    }
    EXPECT_LT(steepest_gradient, kGradientNoiseSlope);
    EXPECT_LT(steepest_lobule, kLobuleNoiseSlope);
    EXPECT_NEAR(sum / kPoints, 0.0, 0.01);  // standard error 0.0014
}

TEST(Union, BlendStaysABound) {
    const ShapePtr a = make_sphere(Vec3(-0.006, 0, 0), 0.008), b = make_sphere(Vec3(0.006, 0, 0), 0.008);
    const ShapePtr sharp = make_union({a, b}), soft = make_union({a, b}, 0.004);
    Random random(3);
    for (int k = 0; k < 2000; ++k) {
        const Vec3 p = random_point(random, 0.03), q = random_point(random, 0.03);
        EXPECT_LE(soft->distance_m(p), sharp->distance_m(p));
        EXPECT_LE(std::abs(soft->distance_m(p) - soft->distance_m(q)), glm::length(p - q) * (1 + 1e-12));
    }
    EXPECT_LT(soft->distance_m(Vec3(0, 0.0055, 0)), sharp->distance_m(Vec3(0, 0.0055, 0)));  // the seam is filled
}

TEST(Bounds, AreTight) {
    const ShapePtr ball = make_sphere(Vec3(0.01, 0.0, 0.0), 0.005);
    const Box wide{Vec3(-0.1), Vec3(0.1)};
    const Box tight = tight_bounds_m(*make_shape([&](const Vec3& p) { return ball->distance_m(p); }, wide), 1e-4);
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_LE(tight.low[axis], ball->bounds_m().low[axis]);
        EXPECT_GE(tight.high[axis], ball->bounds_m().high[axis]);
        EXPECT_NEAR(tight.low[axis], ball->bounds_m().low[axis], 3e-4);  // resolution, and the slack about a piece
        EXPECT_NEAR(tight.high[axis], ball->bounds_m().high[axis], 3e-4);
    }
}

TEST(Cached, ReproducesASphere) {
    const double radius = 0.01, spacing = 0.5e-3;
    const ShapePtr cached = make_cached(make_sphere(Vec3(0.001, 0.002, 0.003), radius), spacing);
    Random random(5);
    // Trilinear interpolation of a distance of curvature 1/r in two directions: at most spacing^2 / 4r; floats add
    // 1e-9.
    const double tolerance = spacing * spacing / (4.0 * radius) * 1.2;
    for (int k = 0; k < 5000; ++k) {
        const Vec3 direction = glm::normalize(random_point(random, 1.0));
        const Vec3 p = Vec3(0.001, 0.002, 0.003) + radius * random.uniform(0.9, 1.1) * direction;
        EXPECT_NEAR(cached->distance_m(p), glm::length(p - Vec3(0.001, 0.002, 0.003)) - radius, tolerance);
        // Far away, outside its grid: a bound, and not a useless one.
        const Vec3 far = Vec3(0.001, 0.002, 0.003) + radius * random.uniform(2.0, 9.0) * direction;
        const double truth = glm::length(far - Vec3(0.001, 0.002, 0.003)) - radius;
        EXPECT_LE(cached->distance_m(far), truth + tolerance);
        EXPECT_GE(cached->distance_m(far), 0.5 * truth);
    }
}

TEST(Cached, KeepsToItsMemory) {
    // 1000 points may be 2^3 blocks of 4 cells; the sphere is then coarse, but still there.
    const ShapePtr cached = make_cached(make_sphere(Vec3(0.0), 0.01), 1e-5, 1000);
    EXPECT_LT(cached->distance_m(Vec3(0.0)), -0.008);
    EXPECT_GT(cached->distance_m(Vec3(0.013, 0.0, 0.0)), 0.0);
}

}  // namespace calot::anatomy

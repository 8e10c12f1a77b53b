// Path and smoothness of movements whose answers are known.

#include <cmath>

#include <gtest/gtest.h>

#include "calot/training/movement.h"

namespace calot::training {
namespace {

/// Speed of the smoothest reach from rest to rest (Flash & Hogan 1985) over `samples`.
std::vector<float> minimum_jerk(int samples) {
    std::vector<float> speed;
    for (int k = 0; k < samples; ++k) {
        const double t = static_cast<double>(k) / (samples - 1);
        speed.push_back(static_cast<float>(30.0 * t * t * (1.0 - t) * (1.0 - t)));
    }
    return speed;
}

TEST(SpectralArcLength, OfTheSmoothestReachIsAsPublished) {
    // Balasubramanian et al. 2015 report about -1.4 for a minimum-jerk movement, whatever its duration.
    EXPECT_NEAR(spectral_arc_length(minimum_jerk(100), 100.0), -1.41, 0.03);
    EXPECT_NEAR(spectral_arc_length(minimum_jerk(400), 100.0), -1.41, 0.03);
}

TEST(SpectralArcLength, DoesNotDependOnSizeAndFallsWithEveryStop) {
    const std::vector<float> once = minimum_jerk(100);
    std::vector<float> larger = once, twice = once, thrice;
    for (float& v : larger) v *= 7.0f;
    twice.insert(twice.end(), once.begin(), once.end());
    thrice = twice;
    thrice.insert(thrice.end(), once.begin(), once.end());
    const double s1 = spectral_arc_length(once, 100.0);
    EXPECT_NEAR(spectral_arc_length(larger, 100.0), s1, 1e-6);
    EXPECT_LT(spectral_arc_length(twice, 100.0), s1 - 0.3);
    EXPECT_LT(spectral_arc_length(thrice, 100.0), spectral_arc_length(twice, 100.0) - 0.3);
}

TEST(SpectralArcLength, IsUnknownForRest) {
    EXPECT_TRUE(std::isnan(spectral_arc_length(std::vector<float>(100, 0.0f), 100.0)));
    EXPECT_TRUE(std::isnan(spectral_arc_length(std::vector<float>{1.0f, 1.0f}, 100.0)));
}

TEST(MovementWatch, CountsPathAndMovements) {
    MovementWatch watch(1e-3);
    // Two strokes of 20 mm in half a second, a rest between them.
    double x = 0.0;
    std::int64_t tick = 0;
    for (int stroke = 0; stroke < 2; ++stroke) {
        for (int k = 0; k < 500; ++k) {
            x += 0.020 / 500;
            watch.after_tick(Vec3(x, 0.0, 0.0), ++tick);
        }
        for (int k = 0; k < 300; ++k) watch.after_tick(Vec3(x, 0.0, 0.0), ++tick);
    }
    EXPECT_NEAR(watch.path_m(), 0.040 - 0.020 / 500, 1e-9);  // the first tick only says where it is
    EXPECT_EQ(watch.movements(), 2);
    EXPECT_LT(watch.smoothness(), 0.0);
}

}  // namespace
}  // namespace calot::training

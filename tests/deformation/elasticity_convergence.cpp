// Held bodies that sag under small loads, against finite elements.

#include <gtest/gtest.h>

#include "calot/validation/elastic_rig.h"
#include "calot/validation/fem.h"

namespace calot::deformation::rig {

namespace {

/// Lets a held block come to rest under gravity. `slowest_rad_per_s` is about its lowest frequency.
Body settled(const Int3& phyxels, const Vec3& gravity, double slowest_rad_per_s) {
    Body body(block(phyxels, true));
    body.model.deformation.gravity_m_per_s2 = gravity;
    body.model.deformation.damping_per_s = 2.0 * slowest_rad_per_s;
    body.refresh();
    const int ticks = static_cast<int>(12.0 / slowest_rad_per_s / body.model.tick_s);
    for (int k = 0; k < ticks; ++k) body.tick();
    return body;
}

/// Mean displacement of the top layer along `axis`, relative to what `fem` says at the same places, minus 1.
double error_at_top(const Body& body, const ClampedBox& fem, int axis, int layers) {
    double sum = 0.0, expected = 0.0;
    const Vec3 size = kSpacing_m * (Vec3(body.model.phyxels.size) - 2.0);
    const Vec3 corner = body.model.phyxels.centre_m(Int3(1)) - 0.5 * kSpacing_m;
    body.for_each_phyxel([&](std::int64_t p) {
        if (body.model.phyxels.coordinates(p).z != layers) return;
        sum += body.displacement_m(p)[axis];
        // One reference for all resolutions: displacements grow as the square of the size.
        expected += size.x * size.x * fem.displacement_m((body.model.phyxels.centre_m(p) - corner) / size.x)[axis];
    });
    return sum / expected - 1.0;
}

}  // namespace

// Strain energy is summed at phyxel centres, which misses 1 / n^2 of that of bending (6 % for n = 4): the error falls
// with n and stays below that plus what the finite elements, 8 deep, are off themselves.
TEST(Convergence, Cantilever) {
    const tissue::Material fat = tissue::default_materials()[1];
    const double gravity = 0.02;  // deflections of 1e-3 of the length
    const ClampedBox fem(Vec3(1, 1, 4), Int3(8, 8, 32), fat.youngs_modulus_Pa, fat.poisson_ratio,
                         Vec3(gravity * fat.density_kg_per_m3, 0, 0));
    double previous = 1.0;
    for (const int n : {4, 6, 8}) {
        const double length = 4 * n * kSpacing_m;
        const double slowest = 3.516 * (length / 4 / std::sqrt(12.0)) / (length * length) *
                               std::sqrt(fat.youngs_modulus_Pa / fat.density_kg_per_m3);
        const Body body = settled({n, n, 4 * n}, Vec3(gravity, 0, 0), slowest);
        const double error = error_at_top(body, fem, 0, 4 * n);
        RecordProperty("error_" + std::to_string(n), std::to_string(error));
        EXPECT_LT(std::abs(error), 0.025 + 1.0 / (n * n)) << n;
        EXPECT_LT(std::abs(error), previous);
        previous = std::abs(error);
    }
}

// A fixed layer of ghosts instead of mirrored ones is off by 16, 10 and 7 %.
TEST(Convergence, Cube) {
    constexpr double kTolerance = 0.015;
    const tissue::Material fat = tissue::default_materials()[1];
    const double gravity = 0.1;
    const ClampedBox fem(Vec3(1, 1, 1), Int3(12), fat.youngs_modulus_Pa, fat.poisson_ratio,
                         Vec3(0, 0, -gravity * fat.density_kg_per_m3));
    for (const int n : {4, 8, 12}) {
        const double slowest =
            0.5 * 1.5708 / (n * kSpacing_m) * std::sqrt(fat.youngs_modulus_Pa / fat.density_kg_per_m3);
        const Body body = settled(Int3(n), Vec3(0, 0, -gravity), slowest);
        const double error = error_at_top(body, fem, 2, n);
        RecordProperty("error_" + std::to_string(n), std::to_string(error));
        EXPECT_LT(std::abs(error), kTolerance) << n;
    }
}

}  // namespace calot::deformation::rig

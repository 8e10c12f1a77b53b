// Closed forms: bars in series, a disc on a half-space, a buried sphere.

#include <cmath>

#include <gtest/gtest.h>

#include "calot/validation/electric_rig.h"

namespace calot::electric {

namespace {

/// A bar one hexel thick and 60 long, the metal on its 21st hexel, in a window of 32: exactly one-dimensional.
Rig bar_rig() {
    tissue::Model model = full_box({1, 1, 60}, 0.25, 1);
    model.electric.window_cells = 32;
    model.electric.relative_residual = 1e-6;
    Rig rig(std::move(model));
    rig.touch({1, 1, 21});
    return rig;
}

/// Far return through an outer face at distance r (in hexels) from the electrode, half a hexel included: the current
/// density through it is sigma phi / (r s).
double outer_resistance(double r) {
    return r + 0.5;
}

}  // namespace

TEST(FieldAnalytic, BarIsExact) {
    Rig rig = bar_rig();
    rig.solve();
    const Window& window = rig.work->window;
    const int below = 21 - window.low.z, above = window.low.z + 31 - 21;  // faces on either side of the metal
    const double down = below + outer_resistance(below + 0.5), up = above + outer_resistance(above + 0.5);
    const double unit = 1.0 / (0.25 * rig.model.hexels.spacing_m);  // of one hexel
    const double expected = unit / (1.0 / down + 1.0 / up);
    EXPECT_NEAR(rig.resistance_Ohm() / expected, 1.0, 1e-5);  // floats, residual 1e-6
}

TEST(FieldAnalytic, SlabsInSeriesAreExact) {
    Rig rig = bar_rig();
    // Everything above hexel 30 conducts a hundred times better, below 12 ten times worse: harmonic means are then
    // exact.
    auto conductivity = [](int z) { return z > 30 ? 25.0 : z < 12 ? 0.025 : 0.25; };
    for (int z = 1; z <= 60; ++z)
        rig.work->hexel_conductivity_S_per_m[static_cast<std::size_t>(rig.model.hexels.index(1, 1, z))] =
            static_cast<float>(conductivity(z));
    rig.solve();
    const Window& window = rig.work->window;
    auto branch = [&](int direction, int last) {
        double sum = 0.0;
        for (int z = 21; z != last; z += direction) sum += 0.5 / conductivity(z) + 0.5 / conductivity(z + direction);
        return (sum + outer_resistance(std::abs(last - 21) + 0.5) / conductivity(last)) / rig.model.hexels.spacing_m;
    };
    const double down = branch(-1, window.low.z), up = branch(1, window.low.z + 31);
    EXPECT_NEAR(rig.resistance_Ohm() * (1.0 / down + 1.0 / up), 1.0, 1e-5);
}

// R = 1 / (4 sigma a). Metal is made of hexels, so a is taken from their number, pi a^2 = N s^2. A hexel is metal from
// its centre on and the field bends around its edge, so that the disc acts like one about half a hexel larger: first
// order in s / a, with a logarithm for the edge's thickness.
TEST(FieldConvergence, DiscOnHalfSpace) {
    const double sigma = 0.025;
    double last_error = 1.0;
    for (const int radius : {2, 4, 8}) {
        Rig rig = disc_rig(12 * radius, radius, sigma, 1e-4);
        rig.solve();
        const double a =
            rig.model.hexels.spacing_m * std::sqrt(static_cast<double>(rig.work->electrode_cells.size()) / M_PI);
        const double error = std::abs(rig.resistance_Ohm() * 4.0 * sigma * a - 1.0);
        EXPECT_LT(error, last_error / 1.4) << "radius " << radius;
        EXPECT_LT(error * radius, 0.65) << "the disc acts like one up to 0.65 hexels larger";
        last_error = error;
    }
    EXPECT_LT(last_error, 0.075);
}

// R = 1 / (4 pi sigma a), with a from the number of hexels: 4/3 pi a^3 = N s^3.
TEST(FieldConvergence, BuriedSphere) {
    const double sigma = 0.1;
    double last_error = 1.0;
    for (const int radius : {2, 4, 8}) {
        const int cells = 12 * radius;
        tissue::Model model = full_box(Int3(cells + 16), sigma);
        model.electric.window_cells = cells;
        model.electric.relative_residual = 1e-4;
        Rig rig(std::move(model));
        const int middle = 4 + (cells + 16) / 2;
        rig.state.field_low = Int3(middle - cells / 2);
        for (int z = -radius; z < radius; ++z)
            for (int y = -radius; y < radius; ++y)
                for (int x = -radius; x < radius; ++x)
                    if (glm::length(Vec3(x, y, z) + 0.5) < radius) rig.touch(Int3(middle) + Int3(x, y, z));
        rig.solve();
        const double count = static_cast<double>(rig.work->electrode_cells.size());
        const double a = rig.model.hexels.spacing_m * std::cbrt(3.0 * count / (4.0 * M_PI));
        const double error = std::abs(rig.resistance_Ohm() * 4.0 * M_PI * sigma * a - 1.0);
        EXPECT_LT(error, last_error / 1.9) << "first order, radius " << radius;
        last_error = error;
    }
    EXPECT_LT(last_error, 0.045);
}

}  // namespace calot::electric

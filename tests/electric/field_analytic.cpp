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

/// From metal on the bar's sides to the middle of its hexel, in resistances of one hexel: half a cell through as much of
/// faces and edges as counts at most (assemble.cpp).
double bar_entry() {
    return 0.5 / (3.0 + 4.0 * 0.8);
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
    const double expected = unit / (1.0 / down + 1.0 / up) + unit * bar_entry();
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
    const double entry = bar_entry() / (0.25 * rig.model.hexels.spacing_m);
    EXPECT_NEAR((rig.resistance_Ohm() - entry) * (1.0 / down + 1.0 / up), 1.0, 1e-5);
}

// R = 1 / (4 sigma a). Metal covers whole faces, so a is taken from their number, pi a^2 = N s^2.
TEST(FieldConvergence, DiscOnHalfSpace) {
    const double sigma = 0.025;
    for (const int radius : {2, 3, 4, 8}) {
        Rig rig = disc_rig(12 * radius, radius, sigma, 1e-4);
        rig.solve();
        const double a =
            rig.model.hexels.spacing_m * std::sqrt(static_cast<double>(rig.work->electrode_cells.size()) / M_PI);
        const double error = std::abs(rig.resistance_Ohm() * 4.0 * sigma * a - 1.0);
        EXPECT_LT(error * radius, 0.06) << "the disc acts like one less than 0.06 hexels larger or smaller";
        if (radius == 4) {
            EXPECT_LT(error, 0.02) << "eight cells across";
        }
    }
}

// R = 1 / (4 pi sigma a) of metal that fills a hole of N hexels, 4/3 pi a^3 = N s^3. Steps on the sphere's surface make
// it rough at every size, so the error does not fall steadily.
TEST(FieldConvergence, BuriedSphere) {
    const double sigma = 0.1;
    for (const int radius : {3, 4, 6, 8}) {
        const int cells = 12 * radius, reach = radius + 1;
        tissue::Model model = full_box(Int3(cells + 16), sigma);
        model.electric.window_cells = cells;
        model.electric.relative_residual = 1e-4;
        Rig rig(std::move(model));
        const Int3 middle(4 + (cells + 16) / 2);
        rig.state.field_low = middle - cells / 2;
        auto metal = [&](const Int3& c) { return glm::length(Vec3(c) + 0.5) < radius; };
        double count = 0.0;
        for (int z = -reach; z < reach; ++z)
            for (int y = -reach; y < reach; ++y)
                for (int x = -reach; x < reach; ++x) {
                    const Int3 c(x, y, z);
                    bool beside = false;
                    for (int axis = 0; axis < 3; ++axis) {
                        Int3 step(0);
                        step[axis] = 1;
                        beside = beside || metal(c - step) || metal(c + step);
                    }
                    if (metal(c)) {
                        rig.state.hexel_present.clear(rig.model.hexels.index(middle + c));
                        count += 1.0;
                    } else if (beside) {
                        rig.touch(middle + c);
                    }
                }
        rig.solve();
        const double a = rig.model.hexels.spacing_m * std::cbrt(3.0 * count / (4.0 * M_PI));
        EXPECT_NEAR(rig.resistance_Ohm() * 4.0 * M_PI * sigma * a, 1.0, 0.015) << "radius " << radius;
    }
}

// A disc on a layer of thickness h over another tissue, k = (s1 - s2)/(s1 + s2). Its images lie at 2 n h; where h is
// well above a they act like points:
//     R = 1 / (4 s1 a) + (1 / (2 pi s1)) 2 sum_n k^n / (2 n h)
TEST(FieldAnalytic, LayeredHalfSpace) {
    for (const double lower : {0.1, 0.4}) {
        const double upper = 0.2;
        const int radius = 3, window = 64, thickness = 9;
        Rig rig = disc_rig(window, radius, upper, 1e-4);
        const Lattice& lattice = rig.model.hexels;
        const int top = 4 + window + 8 - 1;
        for (std::int64_t h = lattice.first; h < lattice.last; ++h)
            if (lattice.coordinates(h).z <= top - thickness && rig.model.hexel_initial.test(h))
                rig.work->hexel_conductivity_S_per_m[static_cast<std::size_t>(h)] = static_cast<float>(lower);
        rig.solve();
        const double s = lattice.spacing_m, depth = thickness * s, k = (upper - lower) / (upper + lower);
        const double a = s * std::sqrt(static_cast<double>(rig.work->electrode_cells.size()) / M_PI);
        double images = 0.0, power = 1.0;
        for (int n = 1; n < 200; ++n) {
            power *= k;
            images += 2.0 * power / (2.0 * n * depth);
        }
        const double expected = 1.0 / (4.0 * upper * a) + images / (2.0 * M_PI * upper);
        // Points for discs: (a / 2h)^2 / 3 of the images' part, 1 %. Robin 1/r at the window's edge knows one layer
        // only.
        EXPECT_NEAR(rig.resistance_Ohm() / expected, 1.0, 0.03) << "below " << lower;
    }
}

}  // namespace calot::electric

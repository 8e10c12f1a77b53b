// Closed forms: bars in series. Points, discs, spheres and layers: calot/validation/electric.cpp.

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

/// From metal on the bar's sides to the middle of its hexel, in resistances of one hexel: half a cell through as much
/// of faces and edges as counts at most (assemble.cpp).
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

}  // namespace calot::electric

// Conduction converges with second order: dt shrinks with s_h^2, so that explicit Euler's first order counts twice.

#include <gtest/gtest.h>

#include "calot/validation/heat_rig.h"

namespace calot::thermal {

namespace {

constexpr double kDiffusivity = 0.5 / 4e6;

/// A Gaussian of 1.2 mm spreads in a block of n^3 cells and 16 mm for 5 s, to 1.64 mm.
struct Spread {
    double error_K, variance_error;
};
Spread spread_gaussian(int n) {
    const double edge = 16e-3, s = edge / n, sigma = 1.2e-3, dt = 0.1 * s * s / kDiffusivity;
    tissue::Model model = box_model({n, n, n}, s, dt, {plain_material()});
    insulate(model);
    HeatRun run(std::move(model));
    auto each = [&](const auto& body) {
        for (int z = 0; z < n; ++z)
            for (int y = 0; y < n; ++y)
                for (int x = 0; x < n; ++x) {
                    const Vec3 p = (Vec3(x, y, z) + 0.5) * s - 0.5 * edge;
                    body(run.model.hexels.index(x, y, z), glm::dot(p, p));
                }
    };
    each([&](std::int64_t cell, double r2) {
        run.heat(cell, run.model.thermal.body_temperature_K + 60.0 * std::exp(-r2 / (2.0 * sigma * sigma)));
    });
    run.start();
    const int steps = static_cast<int>(std::lround(5.0 / dt));
    run.run(steps);
    const double variance = sigma * sigma + 2.0 * kDiffusivity * steps * dt;
    double sum = 0.0, moment = 0.0, error = 0.0;
    each([&](std::int64_t cell, double r2) {
        const double rise = run.rise_K(cell);
        const double exact = 60.0 * std::pow(sigma * sigma / variance, 1.5) * std::exp(-r2 / (2.0 * variance));
        sum += rise;
        moment += rise * r2 / 3.0;
        error = std::max(error, std::abs(rise - exact));
    });
    return {error, std::abs(moment / sum - variance) / variance};
}

}  // namespace

TEST(ConductionConvergence, GaussianSpreadsWithSecondOrder) {
    const Spread coarse = spread_gaussian(16), middle = spread_gaussian(32), fine = spread_gaussian(64);
    EXPECT_GT(std::log2(coarse.error_K / middle.error_K), 1.8);
    EXPECT_GT(std::log2(middle.error_K / fine.error_K), 1.8);
    EXPECT_LT(fine.error_K, 0.02);
    // The variance grows by exactly 2 a dt per step, whatever the spacing, until the tail reaches the walls (4.9
    // sigma), but for what tissue::kRest_K holds back in the tails: a thousandth.
    for (const Spread& spread : {coarse, middle, fine}) EXPECT_LT(spread.variance_error, 1.5e-3);
}

namespace {

/// Largest error of a slab of 6 mm that cools by convection at both ends, against its series (Incropera, 5.5): the
/// rise is sum C_n exp(-zeta_n^2 Fo) cos(zeta_n x/L), zeta tan zeta = Bi, C = 4 sin zeta / (2 zeta + sin 2 zeta).
double cool_slab(int n) {
    const double half = 3e-3, s = 2.0 * half / n, dt = 0.2 * s * s / kDiffusivity, h = 300.0;
    tissue::Model model = bar_model(n, s, dt, {plain_material()});
    insulate(model);
    model.thermal.gas_transfer_W_per_m2K = h;
    model.thermal.gas_temperature_K = model.thermal.body_temperature_K;
    HeatRun run(std::move(model));
    for (int k = 0; k < n; ++k) run.heat(bar_cell(run.model, k), run.model.thermal.body_temperature_K + 50.0);
    run.start();
    const int steps = static_cast<int>(std::lround(20.0 / dt));
    run.run(steps);
    const double biot = h * half / 0.5, fourier = kDiffusivity * steps * dt / (half * half);
    double worst = 0.0;
    for (int k = 0; k < n; ++k) {
        const double x = (k + 0.5) * s - half;
        double exact = 0.0;
        for (int mode = 0; mode < 30; ++mode) {
            double low = mode * std::numbers::pi, high = low + 0.5 * std::numbers::pi - 1e-12;
            for (int it = 0; it < 100; ++it) {
                const double mid = 0.5 * (low + high);
                (mid * std::tan(mid) < biot ? low : high) = mid;
            }
            const double zeta = 0.5 * (low + high);
            exact += 50.0 * 4.0 * std::sin(zeta) / (2.0 * zeta + std::sin(2.0 * zeta)) *
                     std::exp(-zeta * zeta * fourier) * std::cos(zeta * x / half);
        }
        worst = std::max(worst, std::abs(run.rise_K(bar_cell(run.model, k)) - exact));
    }
    return worst;
}

}  // namespace

TEST(ConductionConvergence, CooledSlabConvergesWithSecondOrder) {
    const double coarse = cool_slab(10), middle = cool_slab(20), fine = cool_slab(40);
    EXPECT_GT(std::log2(coarse / middle), 1.8);
    EXPECT_GT(std::log2(middle / fine), 1.8);
    EXPECT_LT(fine, 0.05);
}

}  // namespace calot::thermal

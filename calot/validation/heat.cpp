// Conduction, surroundings and perfusion against closed forms.

#include "calot/validation/closed_forms.h"
#include "calot/validation/heat_rig.h"
#include "calot/validation/spoil.h"

namespace calot::validation {

namespace {

using thermal::bar_cell;
using thermal::bar_model;
using thermal::HeatRun;
using thermal::plain_material;

constexpr double kConductivity = 0.5, kCapacity = 4e6;  // of plain_material
constexpr double kDiffusivity = kConductivity / kCapacity;
constexpr double kTolerance = 0.01;  // at 8 cells across the feature
const char* const kSuite = "heat";

/// Cells across the feature. The value that a tolerance is asked of is that at 8.
std::vector<int> refinements(const Options& options) {
    return options.quick ? std::vector<int>{4, 8, 16} : std::vector<int>{4, 8, 16, 32};
}

struct Profile {
    Points seen, exact;
    double error = 0.0;  ///< largest difference, by `scale`

    void add(double x, double value, double expected, double scale) {
        seen.emplace_back(x, value);
        exact.emplace_back(x, expected);
        error = std::max(error, std::abs(value - expected) / scale);
    }
    Figure figure(const std::string& title, const std::string& x_label, const std::string& y_label) const {
        return {title, x_label, y_label, {{"closed form", exact, false}, {"Calot", seen, true}}, false};
    }
};

/// A case of a profile at 8 cells with its convergence. `run` makes the profile at so many cells across.
template <class Run>
std::vector<Case> profile_case(const Options& options, const std::string& name, const std::string& source,
                               const std::string& across, const char* x_label, double least_order, const Run& run) {
    Points errors;
    Profile at8;
    for (const int cells : refinements(options)) {
        const Profile profile = run(cells);
        errors.emplace_back(cells, profile.error);
        if (cells == 8) at8 = profile;
    }
    Case result = below(kSuite, name, at8.error, "1", kTolerance, source);
    result.note = "largest error of the profile at 8 cells across " + across;
    result.figures.push_back(at8.figure(name, x_label, "K above body temperature"));
    converge(result, errors, least_order, "cells across " + across);
    return {result};
}

/// Two half-spaces of 40 and 0 K meet: the face between stays at 20 K, T = 20 erfc(x / sqrt(4 a t)).
Profile half_space(const Options& options, int cells) {
    const double length = 2e-3, s = length / cells, dt = 0.25 * s * s / kDiffusivity;
    const int n = 8 * cells, steps = cells * cells;  // until sqrt(4 a t) = length
    tissue::Model model = bar_model(n, s, dt, {plain_material()});
    thermal::insulate(model);
    HeatRun run(spoiled(options, std::move(model)));
    for (int k = 0; k < n / 2; ++k) run.heat(bar_cell(run.model, k), run.model.thermal.body_temperature_K + 40.0);
    run.start();
    run.run(steps);
    Profile profile;
    for (int k = n / 2; k < n; ++k) {
        const double x = (k - n / 2 + 0.5) * s;
        profile.add(x * 1e3, run.rise_K(bar_cell(run.model, k)), 20.0 * std::erfc(x / length), 20.0);
    }
    return profile;
}

/// A Gaussian of standard deviation 1.2 mm spreads for 5 s in a block of 16.8 mm; its width is four of these.
Profile gaussian(const Options& options, int cells) {
    const double sigma = 1.2e-3, s = 4.0 * sigma / cells, dt = 0.1 * s * s / kDiffusivity;
    const int n = static_cast<int>(std::lround(16.8e-3 / s)), steps = static_cast<int>(std::lround(5.0 / dt));
    const double variance = sigma * sigma + 2.0 * kDiffusivity * steps * dt;
    tissue::Model model = thermal::box_model({n, n, n}, s, dt, {plain_material()});
    thermal::insulate(model);
    HeatRun run(spoiled(options, std::move(model)));
    const auto radius2 = [&](int x, int y, int z) {
        const Vec3 p = (Vec3(x, y, z) + 0.5) * s - 0.5 * n * s;
        return glm::dot(p, p);
    };
    for (int z = 0; z < n; ++z)
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x)
                run.heat(run.model.hexels.index(x, y, z), run.model.thermal.body_temperature_K +
                                                              60.0 * std::exp(-radius2(x, y, z) / (2 * sigma * sigma)));
    run.start();
    run.run(steps);
    Profile profile;
    const double peak = 60.0 * std::pow(sigma * sigma / variance, 1.5);
    for (int x = n / 2; x < n; ++x) {
        const double r2 = radius2(x, n / 2, n / 2);
        profile.add(std::sqrt(r2) * 1e3, run.rise_K(run.model.hexels.index(x, n / 2, n / 2)),
                    peak * std::exp(-r2 / (2.0 * variance)), peak);
    }
    return profile;
}

/// A slab of 6 mm that cools by convection at both ends (Incropera et al. 2007, 5.5).
Profile slab(const Options& options, int cells) {
    const double half = 3e-3, s = 2.0 * half / cells, dt = 0.1 * s * s / kDiffusivity, h = 300.0;
    tissue::Model model = bar_model(cells, s, dt, {plain_material()});
    thermal::insulate(model);
    model.thermal.gas_transfer_W_per_m2K = h;
    model.thermal.gas_temperature_K = model.thermal.body_temperature_K;
    HeatRun run(spoiled(options, std::move(model)));
    for (int k = 0; k < cells; ++k) run.heat(bar_cell(run.model, k), run.model.thermal.body_temperature_K + 50.0);
    run.start();
    const int steps = static_cast<int>(std::lround(20.0 / dt));
    run.run(steps);
    Profile profile;
    for (int k = 0; k < cells; ++k) {
        const double x = (k + 0.5) * s - half;
        const double exact =
            50.0 * cooled_slab(h * half / kConductivity, kDiffusivity * steps * dt / (half * half), x / half);
        profile.add(x * 1e3, run.rise_K(bar_cell(run.model, k)), exact, 50.0);
    }
    return profile;
}

/// A ball of tissue in gas (Incropera et al. 2007, 5.6). Its surface is a staircase of hexels.
Profile sphere(const Options& options, int cells) {
    const double radius = 4e-3, s = 2.0 * radius / cells, dt = 0.1 * s * s / kDiffusivity, h = 60.0, until = 40.0;
    const int n = cells + 2;
    const auto place = [&](const Int3& c) { return (Vec3(c) + 0.5 - 0.5 * n) * s; };
    int count = 0;
    tissue::Model model = thermal::box_model({n, n, n}, s, dt, {plain_material()}, [&](const Int3& c) {
        const bool inside = glm::length(place(c)) < radius;
        count += inside;
        return inside ? tissue::MaterialIndex{1} : tissue::kNoMaterial;
    });
    thermal::insulate(model);
    model.thermal.gas_transfer_W_per_m2K = h;
    model.thermal.gas_temperature_K = model.thermal.body_temperature_K;
    HeatRun run(spoiled(options, std::move(model)));
    for (std::int64_t i = run.model.hexels.first; i < run.model.hexels.last; ++i)
        if (run.state.hexel_present.test(i)) run.heat(i, run.model.thermal.body_temperature_K + 50.0);
    run.start();
    const int steps = static_cast<int>(std::lround(until / dt));
    run.run(steps);
    // The ball that has the volume of its hexels.
    const double own = s * std::cbrt(3.0 * count / (4.0 * std::numbers::pi));
    Profile profile;
    for (int x = n / 2; x < n; ++x) {
        const Int3 c(x, n / 2, n / 2);
        if (!run.state.hexel_present.test(run.model.hexels.index(c))) continue;
        const double r = glm::length(place(c));
        const double exact =
            50.0 * cooled_sphere(h * own / kConductivity, kDiffusivity * steps * dt / (own * own), r / own);
        profile.add(r * 1e3, run.rise_K(run.model.hexels.index(c)), exact, 50.0);
    }
    return profile;
}

/// Pennes: k T'' = w (T - T_a), a flux q at one end: T - T_a = q / (k m) exp(-m x), m = sqrt(w / k).
Profile pennes(const Options& options, int cells) {
    tissue::Material material = plain_material();
    material.perfusion_m3_per_s_kg = 8e-4;
    tissue::Model model = bar_model(8 * cells, 1.0, 1.0, {material});
    const double w = material.perfusion_m3_per_s_kg * material.density_kg_per_m3 *
                     model.thermal.blood_density_kg_per_m3 * model.thermal.blood_specific_heat_J_per_kgK;
    const double m = std::sqrt(w / kConductivity), flux = 2e4, s = 1.0 / (m * cells);
    const double dt = std::min(0.3 * s * s / kDiffusivity, 0.1 * kCapacity / w);
    model = bar_model(8 * cells, s, dt, {material});
    thermal::insulate(model);
    HeatRun run(spoiled(options, std::move(model)));
    run.set_joule({1, 1, 1}, {1, 1, 1}, [&](const Int3&) { return flux / s; });
    run.run(static_cast<int>(10.0 * kCapacity / w / dt));  // ten times the slowest time constant
    Profile profile;
    const double top = flux / (kConductivity * m);
    for (int k = 1; k < 5 * cells; ++k)
        profile.add((k + 0.5) * s * 1e3, run.rise_K(bar_cell(run.model, k)), top * std::exp(-m * (k + 0.5) * s), top);
    return profile;
}

}  // namespace

std::vector<Check> heat_checks() {
    const auto profile = [](const char* name, const char* source, const char* across, const char* x_label, double order,
                            Profile (*run)(const Options&, int)) {
        return Check{kSuite, name, true, [=](const Options& options) {
                         return profile_case(options, name, source, across, x_label, order,
                                             [&](int cells) { return run(options, cells); });
                     }};
    };
    return {
        profile("heated half-space", "T = T_s erfc(x / sqrt(4 a t)): Carslaw & Jaeger 1959, 2.4", "sqrt(4 a t)",
                "depth, mm", 1.5, half_space),
        profile("Gaussian spread", "heat kernel in three dimensions: Carslaw & Jaeger 1959, 10.2",
                "four standard deviations", "distance, mm", 1.5, gaussian),
        profile("slab with surface exchange", "series of Incropera et al. 2007, 5.5", "the slab", "place, mm", 1.5,
                slab),
        profile("sphere with surface exchange", "series of Incropera et al. 2007, 5.6", "the diameter", "radius, mm",
                0.0, sphere),
        profile("perfused tissue at rest", "Pennes 1948: T = q / (k m) exp(-m x), m = sqrt(w / k)", "1/m", "depth, mm",
                1.5, pennes),
    };
}

}  // namespace calot::validation

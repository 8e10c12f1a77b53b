#include "calot/validation/closed_forms.h"

#include <cmath>
#include <numbers>

#include "calot/base/units.h"

namespace calot::validation {

namespace {

constexpr double kPi = std::numbers::pi;

/// Where a growing function crosses zero.
template <class F>
double root(double low, double high, const F& f) {
    for (int k = 0; k < 100; ++k) {
        const double middle = 0.5 * (low + high);
        (f(middle) < 0.0 ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

constexpr int kModes = 40;

}  // namespace

double cooled_slab(double biot, double fourier, double x) {
    double sum = 0.0;
    for (int n = 0; n < kModes; ++n) {
        const double zeta = root(n * kPi, (n + 0.5) * kPi - 1e-12, [&](double z) { return z * std::tan(z) - biot; });
        sum += 4.0 * std::sin(zeta) / (2.0 * zeta + std::sin(2.0 * zeta)) * std::exp(-zeta * zeta * fourier) *
               std::cos(zeta * x);
    }
    return sum;
}

double cooled_sphere(double biot, double fourier, double r) {
    double sum = 0.0;
    for (int n = 0; n < kModes; ++n) {
        const double zeta = root(n * kPi + 1e-9, (n + 1) * kPi - 1e-9,
                                 [&](double z) { return 1.0 - z * std::cos(z) / std::sin(z) - biot; });
        const double angle = zeta * r;
        sum += 4.0 * (std::sin(zeta) - zeta * std::cos(zeta)) / (2.0 * zeta - std::sin(2.0 * zeta)) *
               std::exp(-zeta * zeta * fourier) * (angle > 1e-9 ? std::sin(angle) / angle : 1.0);
    }
    return sum;
}

double stefan_lambda(double stefan) {
    return root(0.0, 5.0, [&](double l) { return l * std::exp(l * l) * std::erf(l) - stefan / std::sqrt(kPi); });
}

double square_torsion_constant() {
    double sum = 0.0;
    for (int n = 1; n < 100; n += 2) sum += std::tanh(0.5 * n * kPi) / std::pow(n, 5.0);
    return 1.0 / 3.0 - 64.0 / std::pow(kPi, 5.0) * sum;
}

double arrhenius_time_s(double frequency_per_s, double energy_J_per_mol, double temperature_K) {
    return std::exp(energy_J_per_mol / (kGasConstant_J_per_molK * temperature_K) - std::log(frequency_per_s));
}

double layered_disc_factor(double conductivity_1, double conductivity_2, double depth_in_radii) {
    const double k = (conductivity_1 - conductivity_2) / (conductivity_1 + conductivity_2);
    const int steps = 200000;
    const double end = 20.0 / depth_in_radii, dt = end / steps;  // e = exp(-40) there
    double sum = 0.0;
    for (int n = 0; n < steps; ++n) {
        const double t = (n + 0.5) * dt, shape = std::sin(t) / t, e = std::exp(-2.0 * t * depth_in_radii);
        sum += shape * shape * 2.0 * k * e / (1.0 - k * e) * dt;
    }
    return 1.0 + 2.0 / kPi * sum;
}

}  // namespace calot::validation

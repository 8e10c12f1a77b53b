#pragma once
// Closed forms that more than one check needs.

namespace calot::validation {

/// Temperature of a slab that cools by convection at both ends, as a share of the start: sum C_n exp(-zeta_n^2 Fo)
/// cos(zeta_n x), zeta tan zeta = Bi, C = 4 sin zeta / (2 zeta + sin 2 zeta); x in half thicknesses.
double cooled_slab(double biot, double fourier, double x);

/// The same of a ball: sum C_n exp(-zeta_n^2 Fo) sin(zeta_n r) / (zeta_n r), 1 - zeta cot zeta = Bi,
/// C = 4 (sin zeta - zeta cos zeta) / (2 zeta - sin 2 zeta); r in radii.
double cooled_sphere(double biot, double fourier, double r);

/// Neumann's one-phase similarity solution: lambda exp(lambda^2) erf(lambda) = Ste / sqrt(pi); the front is at
/// 2 lambda sqrt(a t).
double stefan_lambda(double stefan);

/// Saint-Venant's torsion constant of a square bar by its edge to the fourth power (0.1406).
double square_torsion_constant();

/// Time to Omega = 1 at a constant temperature: exp(Ea / (R T)) / A.
double arrhenius_time_s(double frequency_per_s, double energy_J_per_mol, double temperature_K);

/// Resistance of a disc of radius a on a layer of thickness h over another tissue, times 4 sigma_1 a. Images of a disc
/// with the flux 1 / sqrt(a^2 - r^2), K = (sigma_1 - sigma_2) / (sigma_1 + sigma_2):
/// 1 + (2 / pi) int_0^inf (sin t / t)^2 2 K e / (1 - K e) dt, e = exp(-2 t h / a). The flux is that of a uniform
/// half-space; a resistance is wrong by the square of how much it changes only.
double layered_disc_factor(double conductivity_1, double conductivity_2, double depth_in_radii);

}  // namespace calot::validation

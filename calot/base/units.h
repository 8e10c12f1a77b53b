#pragma once
// Inside, everything is SI. Celsius and millimetres exist only in scene files and on screens; these convert.

namespace calot {

inline constexpr double kKelvinAtZeroCelsius = 273.15;
inline constexpr double kGasConstant_J_per_molK = 8.314462618;
inline constexpr double kLatentHeatOfWater_J_per_kg = 2.26e6;
inline constexpr double kMillimetre = 1e-3;

constexpr double kelvin_from_celsius(double celsius) { return celsius + kKelvinAtZeroCelsius; }
constexpr double celsius_from_kelvin(double kelvin) { return kelvin - kKelvinAtZeroCelsius; }

}  // namespace calot

#pragma once
// The electrosurgical generator: what it drives into a load.

#include "calot/tissue/input.h"
#include "calot/tissue/model.h"
#include "calot/tissue/state.h"

namespace calot::electric {

/// Loads that conduct less than this (10 MOhm; dry tissue under a tip has some 100 kOhm) are an open circuit.
inline constexpr double kOpenCircuit_S = 1e-7;

/// RMS voltage, current and power into a load of the given conductance: constant power at the setting, V = sqrt(P R),
/// until the voltage limit takes over. An open circuit gets nothing and has impedance 0, as State documents.
tissue::GeneratorState drive(const tissue::Input& input, const tissue::ElectricParameters& parameters,
                             double conductance_S);

}  // namespace calot::electric

#pragma once
// The electrosurgical generator: what voltage it puts on the load that the tissue is.
//
//     V                  ________  voltage limit: the mode's peak over its crest factor
//     |            ....''
//     |      ..''     constant power: V = sqrt(P R)
//     |   /
//     |  /  constant current: V = I R
//     |_/____________________________ R
//
// Modes differ in their waveform: cut is a continuous sine (crest factor 1.4), blend is interrupted (2 to 3), coag is
// short bursts, 5 to 8 % of the time, with crest factor 5 to 8 and peaks of several kilovolts. Figures of the kind are
// in every manufacturer's manual; these are rounded from Valleylab Force FX and ERBE VIO data sheets.

#include "calot/tissue/input.h"
#include "calot/tissue/state.h"

namespace calot::electric {

/// Loads that conduct less are an open circuit (real ones are kilohms; tissue that hangs on nothing shows the rounding
/// of floats, some 1e-9 S).
inline constexpr double kOpenCircuit_S = 1e-7;

double crest_factor(const tissue::ElectricParameters& parameters, tissue::GeneratorMode mode);
/// RMS, of a mode.
double voltage_limit_V(const tissue::ElectricParameters& parameters, tissue::GeneratorMode mode);

/// Without pedal all is zero. On an open circuit the voltage stands at its limit and no current flows.
tissue::GeneratorState drive(const tissue::Input& input, const tissue::ElectricParameters& parameters,
                             double conductance_S);

}  // namespace calot::electric

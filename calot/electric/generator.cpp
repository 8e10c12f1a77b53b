#include "calot/electric/generator.h"

#include <algorithm>
#include <cmath>

namespace calot::electric {

tissue::GeneratorState drive(const tissue::Input& input, const tissue::ElectricParameters& parameters,
                             double conductance_S) {
    tissue::GeneratorState state;
    if (!input.pedal || input.power_setting_W <= 0.0 || conductance_S < kOpenCircuit_S) return state;
    state.impedance_Ohm = 1.0 / conductance_S;
    state.voltage_V = std::min(std::sqrt(input.power_setting_W * state.impedance_Ohm), parameters.voltage_limit_V);
    state.current_A = state.voltage_V * conductance_S;
    state.power_W = state.voltage_V * state.current_A;
    return state;
}

}  // namespace calot::electric

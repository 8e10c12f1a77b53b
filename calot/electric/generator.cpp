#include "calot/electric/generator.h"

#include <algorithm>
#include <cmath>

namespace calot::electric {

double crest_factor(const tissue::ElectricParameters& parameters, tissue::GeneratorMode mode) {
    return parameters.crest_factor[static_cast<std::size_t>(mode)];
}

double voltage_limit_V(const tissue::ElectricParameters& parameters, tissue::GeneratorMode mode) {
    return std::min(parameters.voltage_limit_V,
                    parameters.peak_voltage_V[static_cast<std::size_t>(mode)] / crest_factor(parameters, mode));
}

tissue::GeneratorState drive(const tissue::Input& input, const tissue::ElectricParameters& parameters,
                             double conductance_S) {
    enum Limit : std::int64_t { none, current, power, voltage };
    tissue::GeneratorState state;
    if (!input.pedal || input.power_setting_W <= 0.0) return state;
    const double crest = crest_factor(parameters, input.mode);
    state.voltage_V = voltage_limit_V(parameters, input.mode);
    state.limit = voltage;
    if (conductance_S < kOpenCircuit_S) {
        state.limit = none;
    } else {
        const double by_power_V = std::sqrt(input.power_setting_W / conductance_S);
        const double by_current_V = parameters.current_limit_A / conductance_S;
        if (by_power_V < state.voltage_V) {
            state.voltage_V = by_power_V;
            state.limit = power;
        }
        if (by_current_V < state.voltage_V) {
            state.voltage_V = by_current_V;
            state.limit = current;
        }
        state.impedance_Ohm = 1.0 / conductance_S;
        state.current_A = state.voltage_V * conductance_S;
        state.power_W = state.voltage_V * state.current_A;
    }
    state.peak_voltage_V = state.voltage_V * crest;
    return state;
}

}  // namespace calot::electric

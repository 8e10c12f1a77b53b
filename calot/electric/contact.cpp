#include "calot/electric/contact.h"

#include <algorithm>

#include "calot/electric/generator.h"

namespace calot::electric {

double arc_reach_m(const tissue::ElectricParameters& parameters, double peak_voltage_V) {
    const double spare_V = peak_voltage_V - parameters.arc_threshold_V;
    return spare_V > 0.0 ? spare_V / parameters.arc_field_V_per_m : 0.0;
}

double offered_peak_V(const tissue::Model& model, const tissue::State& state, const tissue::Input& input) {
    if (!input.pedal || input.power_setting_W <= 0.0) return 0.0;
    if (state.generator.current_A > 0.0) return state.generator.peak_voltage_V;
    return voltage_limit_V(model.electric, input.mode) * crest_factor(model.electric, input.mode);
}

double bare_reach_m(const tissue::Model& model, const tissue::State& state, const tissue::Input& input) {
    const double arcs_m = arc_reach_m(model.electric, offered_peak_V(model, state, input));
    return std::max(model.electric.contact_gap_m, arcs_m) + 0.5 * model.hexels.spacing_m;
}

Reach find_reach(const tissue::Model& model, const tissue::State& state, const tissue::Exchange& exchange,
                 const tissue::Input& input) {
    const tissue::ElectricParameters& parameters = model.electric;
    Reach reach{parameters.contact_gap_m, false};
    const double peak_V = offered_peak_V(model, state, input);
    if (peak_V <= parameters.arc_threshold_V) return reach;
    reach.arcs = true;
    double nearest_m = 1e9;
    for (const tissue::NearHexel& near : exchange.near)
        nearest_m = std::min(nearest_m, static_cast<double>(near.bare_gap_m));
    // Of what the arc could reach, it takes the nearest: within half a hexel.
    const double near_m = std::max(nearest_m, 0.0) + 0.5 * model.hexels.spacing_m;
    reach.gap_m = std::max(reach.gap_m, std::min(arc_reach_m(parameters, peak_V), near_m));
    return reach;
}

bool any_reached(const Reach& reach, const tissue::Exchange& exchange) {
    return std::any_of(exchange.near.begin(), exchange.near.end(),
                       [&](const tissue::NearHexel& near) { return reaches(reach, near); });
}

}  // namespace calot::electric

#include "calot/simulation/step_parts.h"

#include <algorithm>

#include "calot/deformation/grasp.h"
#include "calot/electric/contact.h"
#include "calot/instruments/contact.h"

namespace calot::simulation {

namespace {

/// Hexels this close to a grasper that holds nothing may come between its jaws.
constexpr double kJawReach_m = 2e-3;

}  // namespace

void clear_exchange(tissue::Exchange& exchange) {
    exchange.removed_hexels.clear();
    exchange.changed_phyxels.clear();
    exchange.gas.clear();
}

void place_instruments(const tissue::Model& model, const tissue::State& state, Work& work, const tissue::Input& input) {
    instruments::place_hook(work.hook, input.hook, state.tick == 0 ? input.hook : state.hook, model.tick_s,
                            work.exchange.capsules);
    tissue::GrasperInput& grasper = work.exchange.grasper;
    grasper = input.grasper;
    grasper.jaw = deformation::stopped_jaw(grasper, state.grasper.held);
    const tissue::GrasperInput before{state.grasper.present != 0, state.grasper.pose, state.grasper.jaw};
    instruments::place_grasper(work.grasper, grasper, before, state.grasper.held > 0, model.tick_s,
                               work.exchange.capsules);
}

deformation::NearReach near_reach(const tissue::Model& model, const tissue::State& state,
                                  const tissue::Exchange& exchange, const tissue::Input& input) {
    const double contact_m = instruments::contact_reach_m(model, exchange);
    // Char of what goes sticks to the wire a hexel beyond what it touches.
    const double bare_m = electric::bare_reach_m(model, state, input) + model.hexels.spacing_m;
    return {std::max(contact_m, bare_m), contact_m,
            state.grasper.held > 0 ? contact_m : std::max(contact_m, kJawReach_m)};
}

void find_contacts(const tissue::Model& model, tissue::State& state, Work& work) {
    instruments::find_contacts(model, state, work.exchange);
    deformation::update_grasp(model, state, work.exchange,
                              {work.grasper.jaw_length_m, 0.5 * work.grasper.jaw_diameter_m, work.grasper.opening_rad});
}

void remember_instruments(tissue::State& state, const tissue::Exchange& exchange, const tissue::Input& input) {
    state.hook = input.hook;
    state.grasper.present = exchange.grasper.present ? 1 : 0;
    state.grasper.pose = exchange.grasper.pose;
    state.grasper.jaw = exchange.grasper.jaw;
    state.hook_force_N = exchange.contact_force_N + exchange.organ_force_N;
    state.grasper.force_N = exchange.grasper_contact_force_N + exchange.grasper_organ_force_N;
}

void list_gas(const tissue::Model& model, Work& work) {
    GasPlaces& gas = work.gas;
    gas.rest_m.clear();
    gas.owner.clear();
    gas.phyxel.clear();
    gas.source.clear();
    for (const tissue::GasEvent& event : work.exchange.gas) {
        const std::int64_t phyxel = model.phyxel_of(model.hexels.coordinates(event.hexel));
        const auto found = std::find(gas.phyxel.begin(), gas.phyxel.end(), phyxel);
        gas.source.push_back(static_cast<std::int32_t>(found - gas.phyxel.begin()));
        if (found != gas.phyxel.end()) continue;
        gas.phyxel.push_back(phyxel);
        gas.owner.push_back(event.hexel);
        gas.rest_m.push_back(Vec3f(model.hexels.centre_m(event.hexel)));
    }
    gas.world_m.resize(gas.rest_m.size());
}

void place_gas(const tissue::Model& model, Work& work) {
    GasPlaces& gas = work.gas;
    gas.event_m.clear();
    for (std::size_t k = 0; k < gas.source.size(); ++k) {
        const auto source = static_cast<std::size_t>(gas.source[k]);
        const Vec3f rest_m(model.hexels.centre_m(work.exchange.gas[k].hexel));
        gas.event_m.push_back(gas.world_m[source] + (rest_m - gas.rest_m[source]));
    }
}

}  // namespace calot::simulation

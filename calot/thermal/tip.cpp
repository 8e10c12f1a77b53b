#include "calot/thermal/tip.h"

#include <algorithm>
#include <numbers>

namespace calot::thermal {

namespace {

// Stainless steel AISI 304 (ASM Handbook, vol. 1).
constexpr double kSteelDensity_kg_per_m3 = 8000.0;
constexpr double kSteelSpecificHeat_J_per_kgK = 500.0;
constexpr double kSteelConductivity_W_per_mK = 16.2;
// Char of wood and of proteins conducts 0.05 to 0.15 W/(m K) (SFPE Handbook of Fire Protection Engineering).
constexpr double kCharConductivity_W_per_mK = 0.1;

/// From the wire to a hexel's centre, without what sticks to the wire [m^2 K/W].
double resistance_m2K_per_W(const tissue::Model& model, std::int64_t hexel) {
    const double k =
        model.materials[model.hexel_material[static_cast<std::size_t>(hexel)]].thermal_conductivity_W_per_mK;
    return 1.0 / model.thermal.tip_transfer_W_per_m2K + 0.5 * model.hexels.spacing_m / std::max(k, 1e-6);
}

}  // namespace

BareWire bare_wire(const tissue::ThermalParameters& thermal, const std::vector<tissue::Capsule>& capsules) {
    BareWire wire;
    double length = 0.0, covered = 0.0, radius = 0.0;
    for (const tissue::Capsule& capsule : capsules)
        if (capsule.bare) {
            length += glm::length(capsule.b_m - capsule.a_m);
            radius = std::max(radius, capsule.radius_m);
        }
    if (length <= 0.0) return wire;
    for (const tissue::Capsule& capsule : capsules)  // the same wire where it is insulated; not the shaft
        if (!capsule.bare && capsule.radius_m < 1.5 * radius) covered += glm::length(capsule.b_m - capsule.a_m);
    const double section = std::numbers::pi * radius * radius;
    wire.area_m2 = 2.0 * std::numbers::pi * radius * length;
    wire.heat_capacity_J_per_K = section * length * kSteelDensity_kg_per_m3 * kSteelSpecificHeat_J_per_kgK;
    wire.loss_W_per_K = thermal.gas_transfer_W_per_m2K * wire.area_m2 +
                        kSteelConductivity_W_per_mK * section / (0.5 * length + covered);
    return wire;
}

bool touches(const tissue::Model& model, const tissue::State& state, const tissue::NearHexel& near) {
    return near.bare_gap_m <= static_cast<float>(model.electric.contact_gap_m) && state.hexel_present.test(near.hexel);
}

WireContact find_wire_contact(const tissue::Model& model, const tissue::State& state,
                              const tissue::Exchange& exchange) {
    WireContact contact;
    contact.wire = bare_wire(model.thermal, exchange.capsules);
    if (contact.wire.area_m2 <= 0.0) return contact;
    const double s = model.hexels.spacing_m;
    std::int64_t touched = 0;
    for (const tissue::NearHexel& near : exchange.near) touched += touches(model, state, near) ? 1 : 0;
    // Together they cannot touch more of the wire than there is.
    contact.area_m2 = std::min(s * s, contact.wire.area_m2 / static_cast<double>(std::max<std::int64_t>(touched, 1)));
    contact.film_m2K_per_W =
        state.tip.char_kg / (model.electric.char_density_kg_per_m3 * contact.wire.area_m2) / kCharConductivity_W_per_mK;
    return contact;
}

double passed_J_per_m3K(const tissue::Model& model, const Properties& properties, const WireContact& contact,
                        std::int64_t hexel, double dt_s) {
    const double share = contact.area_m2 * dt_s / (resistance_m2K_per_W(model, hexel) + contact.film_m2K_per_W) /
                         model.hexel_volume_m3();
    // Never more than a quarter of what would even out the temperatures: stable at any step.
    const tissue::MaterialIndex m = model.hexel_material[static_cast<std::size_t>(hexel)];
    return std::min(share, 0.25 * static_cast<double>(properties.dry_capacity_J_per_m3K[m]));
}

void settle_wire(const tissue::Model& model, tissue::State& state, const BareWire& wire, double tissue_J, double arcs_J,
                 double dt_s) {
    tissue::TipState& tip = state.tip;
    state.energy_J.delivered += arcs_J;
    const double taken_J = tissue_J + arcs_J;
    const double lost_J = wire.loss_W_per_K * (tip.temperature_K - model.thermal.body_temperature_K) * dt_s;
    tip.heat_W = taken_J / dt_s;
    tip.lost_J += lost_J;
    tip.temperature_K += (taken_J - lost_J) / wire.heat_capacity_J_per_K;
    state.energy_J.tip += taken_J;
}

void exchange_with_tip(const tissue::Model& model, tissue::State& state, const tissue::Exchange& exchange, Work& work,
                       double dt_s) {
    const WireContact contact = find_wire_contact(model, state, exchange);
    if (contact.wire.area_m2 <= 0.0) return;
    const double volume = model.hexel_volume_m3(), body_K = model.thermal.body_temperature_K;
    double taken_J = 0.0;
    for (const tissue::NearHexel& near : exchange.near) {
        if (!touches(model, state, near)) continue;
        const auto h = static_cast<std::size_t>(near.hexel);
        // Both above body temperature, so that what is at rest is so exactly.
        const float rise_K = work.temperature_K[h] - static_cast<float>(body_K);
        const double gained = passed_J_per_m3K(model, work.properties, contact, near.hexel, dt_s) *
                              (state.tip.temperature_K - body_K - static_cast<double>(rise_K));
        float& enthalpy = state.enthalpy_J_per_m3[h];
        const float before = enthalpy;
        enthalpy += static_cast<float>(gained);
        if (enthalpy == before) continue;
        work.active_groups.set((near.hexel - model.hexels.first) / kGroupCells);
        taken_J -= static_cast<double>(enthalpy - before) * volume;
    }
    settle_wire(model, state, contact.wire, taken_J, exchange.joule.wire_W * dt_s, dt_s);
}

void stick_char(const tissue::Model& model, tissue::State& state, const tissue::Exchange& exchange, Work& work,
                std::size_t count) {
    work.sticks.assign(count, 0.0f);
    const auto end = work.spent.begin() + static_cast<std::ptrdiff_t>(count);
    const auto reach_m = static_cast<float>(model.electric.contact_gap_m + model.hexels.spacing_m);
    for (const tissue::NearHexel& near : exchange.near) {
        if (near.bare_gap_m > reach_m) continue;
        const auto hexel = static_cast<std::int32_t>(near.hexel);
        const auto found = std::lower_bound(work.spent.begin(), end, hexel);
        if (found == end || *found != hexel) continue;
        work.sticks[static_cast<std::size_t>(found - work.spent.begin())] =
            static_cast<float>(model.thermal.tip_char_share);
        const tissue::MaterialIndex m = model.hexel_material[static_cast<std::size_t>(hexel)];
        state.tip.char_kg += model.thermal.tip_char_share * static_cast<double>(work.properties.solids_kg_per_m3[m]) *
                             model.hexel_volume_m3();
    }
}

}  // namespace calot::thermal

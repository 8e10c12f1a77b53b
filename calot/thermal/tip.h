#pragma once
// The bare wire of the hook as one lump of steel: tissue and arcs heat it, gas and the shaft cool it, and it goes on heating
// what it touches after the pedal is released. Residual heat is a known cause of injury: hooks exceed 100 C at every
// length of activation (Matsuura 2021, doi 10.31083/j.ejgo.2021.01.2311).
//
//     C dT/dt = P_arc + sum over touched hexels of h a (T_i - T)  -  h_gas A (T - T_0)  -  k A_wire / l (T - T_0)
//
//     1/h = 1/h_contact + char / k_char + s_h / 2k         contact, what sticks to the wire, half a hexel, in series
//
// Departures: the wire has one temperature (along 10 mm of steel it evens out within seconds only), and at rest that of
// the body in which it works, so that touching cold tissue leaves no trace. The wire's own resistance makes no heat
// worth counting (10 mOhm, milliwatts).

#include "calot/thermal/heat.h"

namespace calot::thermal {

/// What the capsules of an instrument say of its bare wire.
struct BareWire {
    double area_m2 = 0.0;  ///< of its surface; 0: no bare wire
    double heat_capacity_J_per_K = 0.0;
    double loss_W_per_K = 0.0;  ///< to gas and up the shaft
};
BareWire bare_wire(const tissue::ThermalParameters& thermal, const std::vector<tissue::Capsule>& capsules);

/// Whether the wire touches a near hexel that is there.
bool touches(const tissue::Model& model, const tissue::State& state, const tissue::NearHexel& near);

/// How the wire meets tissue in a heat step. Its parts, for heat steps elsewhere than in this room's kernels:
struct WireContact {
    BareWire wire;
    double area_m2 = 0.0;         ///< that one hexel touches
    double film_m2K_per_W = 0.0;  ///< resistance of what sticks to the wire
};
WireContact find_wire_contact(const tissue::Model& model, const tissue::State& state, const tissue::Exchange& exchange);
/// What a touched hexel takes in a step per kelvin between wire and hexel [J/(m^3 K)].
double passed_J_per_m3K(const tissue::Model& model, const Properties& properties, const WireContact& contact,
                        std::int64_t hexel, double dt_s);
/// Books a step of the wire, in which tissue and arcs gave it so much: losses, its temperature.
void settle_wire(const tissue::Model& model, tissue::State& state, const BareWire& wire, double tissue_J, double arcs_J,
                 double dt_s);

/// One heat step's exchange between the wire, arcs and the hexels that it touches. Adds the blocks that it heats to
/// Work::active.
void exchange_with_tip(const tissue::Model& model, tissue::State& state, const tissue::Exchange& exchange, Work& work,
                       double dt_s);

/// Share of the solids of Work::spent[k], k < count, that stays on the wire, into Work::sticks; and the char that this
/// makes, into State::tip.
void stick_char(const tissue::Model& model, tissue::State& state, const tissue::Exchange& exchange, Work& work,
                std::size_t count);

}  // namespace calot::thermal

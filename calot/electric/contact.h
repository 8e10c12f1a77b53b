#pragma once
// Where current enters the tissue: through hexels that bare metal touches, and by arcs.
//
//       metal, 1 V                      touches: bare gap <= contact gap       arc: gap <= reach
//      ----------------                 g = 1 / (1/g_char + 1/g_half)          g = 1 / (s R_arc + 1/g_half)
//       char     | g_char
//      ----------                       g_half = 2 sigma times the exposed faces that look at the metal
//       hexel    | g_half
//          o centre: unknown
//
// An arc strikes when the peak voltage exceeds a threshold of about 200 V, below which none burns between metal and
// tissue (Palanker et al. 2008, doi 10.1109/TBME.2007.906502, and manufacturers: "cutting needs 200 V peak"), plus the
// strength of the gas times the gap. Carbon dioxide at atmospheric pressure holds 2.6 kV/mm (0.88 of air's 3 kV/mm). It
// goes for what is nearest. Tissue that has dried at the metal is burnt through by arcs: there, conductivity is at
// least that of a hexel full of arcs. An arc's resistance is chosen: some hundred volts at some tenths of an ampere.
//
// An arc heats both its ends. Electrosurgical arcs are glow discharges of 1 kA/cm2 in a column of 1 to 2 S/cm (Sci.
// Rep. 2015, doi 10.1038/srep09946), so that the column takes some 15 to 30 V over 0.3 mm; nearly all the rest falls
// before whichever end is the cathode, by turns. So the wire takes half, as long as the gap is short (arc_wire_share).

#include <cstdint>
#include <vector>

#include "calot/base/vec.h"
#include "calot/electric/window.h"
#include "calot/tissue/exchange.h"
#include "calot/tissue/input.h"
#include "calot/tissue/state.h"

namespace calot::electric {

/// A hexel that current enters.
struct Entry {
    std::int32_t cell = 0;  ///< of the finest level
    float g = 0.0f;         ///< from the metal to its centre, S/m
    float wire = 0.0f;      ///< share of the heat between metal and centre that the metal takes
};

/// What an edge of the metal adds to a face, so that a disc has the resistance of its area at every size: with 0, 0.4,
/// 0.6, 0.8 a disc of radius a acts like one that is 0.32, 0.12, 0.06, 0.01 hexels smaller.
inline constexpr double kEdge = 0.8;

/// How far arcs reach at a peak voltage [m]; at most the contact gap when none burn.
double arc_reach_m(const tissue::ElectricParameters& parameters, double peak_voltage_V);

/// Peak voltage that the generator offers now: its limit when nothing flows, else the present one; 0 without pedal.
double offered_peak_V(const tissue::Model& model, const tissue::State& state, const tissue::Input& input);

/// How far from the surface of bare metal hexels can be that current enters, or that it could within this tick [m].
double bare_reach_m(const tissue::Model& model, const tissue::State& state, const tissue::Input& input);

/// What current enters at present: the bare gap up to which hexels count, and whether arcs burn.
struct Reach {
    double gap_m = 0.0;
    bool arcs = false;
};
Reach find_reach(const tissue::Model& model, const tissue::State& state, const tissue::Exchange& exchange,
                 const tissue::Input& input);
/// Whether a near hexel is that close.
inline bool reaches(const Reach& reach, const tissue::NearHexel& near) {
    return static_cast<double>(near.bare_gap_m) <= reach.gap_m;
}
bool any_reached(const Reach& reach, const tissue::Exchange& exchange);

}  // namespace calot::electric

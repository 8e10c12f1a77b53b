#pragma once
// Contact between instruments and tissue, and between instruments and rigid organs (docs/physics.md section 8).
//
// Tissue: surface hexels are points with a radius of half a spacing; each near one gives a one-sided constraint against
// the capsule it is deepest in, and a second where it is wedged between two. Many points share the load, so that the
// wire cannot slip between them. The constraint is a half-space that moves with the instrument, taken at the start of
// the tick, so that a fast wire cannot jump over a hexel within a tick: its far side is behind the half-space too.
//
// Sides. A hexel that overlaps a capsule is pushed along the tissue's own normal there, inward, until it is out:
//
//          away from the axis (does not work)         along the tissue's normal
//               .---.                                    .---.
//              (     )                                  (     )
//            <- o   o ->   surface hexels under         | o   o |
//              tissue      the wire slip aside          v tissue v
//
// Along the wire's normals, the few hexels under a tip 1 mm thick are driven apart and the wire sinks in between them
// at 5 to 9 mm of indentation; and once a hexel's centre has come over the axis it is pushed on outwards. Along its own
// normal it is pushed back from either side of the axis, without any memory of where it came from. Hexels whose free
// side faces away from the wire (the far side of a thin sheet) and those of sheets one hexel thick, which have no
// normal, go by the wire's.

#include "calot/tissue/exchange.h"
#include "calot/tissue/state.h"

namespace calot::instruments {

/// Stiffness of rigid organs against the hook. Chosen: 1 mm of depth gives 1 N, firm to the hand, stable at 1 kHz.
inline constexpr double kOrganStiffness_N_per_m = 1000.0;

/// From Exchange::capsules and ::near: one-sided constraints into Exchange::contacts, and the penalty force of rigid
/// organs on the instruments into Exchange::organ_force_N and ::grasper_organ_force_N: per organ, its stiffness times
/// the greatest depth found at points along the capsules, along the gradient of its distance.
void find_contacts(const tissue::Model& model, const tissue::State& state, tissue::Exchange& exchange);

/// Hexels further than this from every instrument make no contact in this tick: half a hexel, what the fastest moves,
/// and a margin.
double contact_reach_m(const tissue::Model& model, const tissue::Exchange& exchange);

/// How a capsule touches a point of radius `point_radius_m` at the start of the tick.
struct Touch {
    Vec3f normal{0.0f};  ///< unit, out of the capsule
    float gap_m = 0.0f;
    Vec3f tool_velocity_m_per_s{0.0f};
    tissue::Instrument instrument = tissue::Instrument::hook;
};

/// A capsule at the start of the tick, for many points.
struct StartCapsule {
    const tissue::Capsule* capsule = nullptr;
    Vec3 a_m{0.0}, ab_m{0.0};
    Vec3 axis{0.0};  ///< unit; 0 where a capsule is a ball
    double length2_m2 = 0.0, inverse_length2_per_m2 = 0.0;

    StartCapsule() = default;
    StartCapsule(const tissue::Capsule& end, double dt_s);
    /// Whether a place is certainly further than this from the capsule's axis; cheap.
    bool further_than(const Vec3& p, double distance_m) const;
};
Touch touch(const StartCapsule& capsule, const tissue::NearHexel& hexel, double point_radius_m);

}  // namespace calot::instruments

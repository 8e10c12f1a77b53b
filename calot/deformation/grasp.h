#pragma once
// What the grasper holds.
//
// When the jaws close on tissue, surface hexels between them become held points: each follows its place in the
// grasper's frame on a spring. Together the springs give no more than the grip; beyond it the tissue slips through the
// jaws (its places move after it), and what slips out past their tips is lost. So is a hexel that burns or falls.
// Opening lets go of all. The jaws stop where they took hold: there is tissue in between.

#include "calot/deformation/work.h"

namespace calot::deformation {

inline constexpr double kTakeJaw = 0.3;          ///< jaws closing past this take hold, and stop here while they hold
inline constexpr double kLetGoJaw = 0.4;         ///< opened further than this they let go
inline constexpr double kGrip_N = 4.0;           ///< chosen: a pull that slips out of atraumatic jaws
inline constexpr double kHold_N_per_m = 3000.0;  ///< of all points together: at the grip's limit they lag by 1.3 mm

/// The space between the jaws.
struct JawSpace {
    double length_m = 20e-3;
    double radius_m = 1.25e-3;    ///< of a jaw
    double opening_rad = 1.0472;  ///< between the jaws, wide open
};

/// How far the jaws really are open: tissue in between stops them.
inline double stopped_jaw(const tissue::GrasperInput& input, std::int64_t held) {
    return held > 0 && input.jaw < kTakeJaw ? kTakeJaw : input.jaw;
}

/// Takes hold, lets go, drops what is lost: State::grasper's points, from Exchange::grasper, ::near and the last tick's
/// State::grasper. Before integrate().
void update_grasp(const tissue::Model& model, tissue::State& state, const tissue::Exchange& exchange,
                  const JawSpace& space);

/// Parts of prepare_contacts: appends the held points; once psi is known, says where they are.
void add_held(const tissue::Model& model, const tissue::State& state, ContactWork& contact);
void place_held(const tissue::Model& model, const tissue::State& state, const tissue::Exchange& exchange,
                ContactWork& contact);

/// Says of a held point where it is, moved by so much from rest, and how its place moves.
void place_point(const tissue::Model& model, const tissue::State& state, const tissue::Exchange& exchange,
                 const Vec3f& moved_m, ContactPoint& point);
/// From where a held point is held to where it is at rest, before rounding.
Vec3 away_at_rest_m(const tissue::Model& model, const tissue::State& state, const ContactPoint& point);

/// After the last substep: places that slipped move after their points.
void slip_held(tissue::State& state, const tissue::Exchange& exchange, const ContactWork& contact);

}  // namespace calot::deformation

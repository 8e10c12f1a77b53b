#pragma once
// The grasper: a 5 mm shaft about a trocar with two jaws at its end that open symmetrically.
//
//      trocar
//        |  shaft              the instrument's frame: origin between the tips of the closed jaws,
//       [ ]                    z from the trocar to the tips, the jaws open along +x and -x
//       / \   jaws
//      /   \                   jaw = 1: opened by opening_rad, 0: closed, side by side
//        o
//
// Jaws collide with tissue as the hook does. When they close they take hold of the tissue between them
// (deformation/grasp.h); from then on the hold moves it, and the jaws themselves collide no more until they open.

#include <vector>

#include "calot/tissue/exchange.h"
#include "calot/tissue/input.h"

namespace calot::instruments {

/// Dimensions; defaults are those of a common atraumatic 5 mm grasper.
struct GrasperShape {
    double shaft_diameter_m = 5e-3;
    double shaft_length_m = 0.33;
    double jaw_length_m = 20e-3;
    double jaw_diameter_m = 2.5e-3;
    double opening_rad = 1.0471975511965976;  ///< between the jaws, wide open: 60 degrees
};

/// Frame of a grasper whose shaft's axis passes through `trocar_m`, with its tip at `tip_m`, turned by `roll_rad` about
/// its shaft (right-handed). At roll 0 one jaw opens as far "down" (-y) as the shaft allows.
tissue::Pose grasper_pose_through_trocar(const Vec3& trocar_m, const Vec3& tip_m, double roll_rad);

/// Appends the grasper's capsules in world space, with velocities over dt_s: both jaws (not solid while `holds`), then
/// the shaft. Nothing is allocated where three more fit.
void place_grasper(const GrasperShape& shape, const tissue::GrasperInput& now, const tissue::GrasperInput& previous,
                   bool holds, double dt_s, std::vector<tissue::Capsule>& capsules);

}  // namespace calot::instruments

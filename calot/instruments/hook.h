#pragma once
// The electro-hook: a 5 mm insulated shaft about a trocar, a bare L-shaped wire at its end.
//
//      trocar                         the instrument's frame: origin in the middle of the foot,
//        |  shaft, insulated          z from the trocar to the tip, x along the foot
//        |
//       [ ]                                 z
//        |  heel, insulated above           |
//        |  heel, bare                      v
//        +--o--> foot, bare                 o---> x

#include <vector>

#include "calot/tissue/exchange.h"
#include "calot/tissue/input.h"

namespace calot::instruments {

/// Dimensions; defaults are those of a common laparoscopic L-hook (docs/physics.md section 8).
struct HookShape {
    double shaft_diameter_m = 5e-3;
    double shaft_length_m = 0.33;
    double wire_diameter_m = 1e-3;
    double heel_length_m = 10e-3;    ///< along the shaft's axis, from the insulation to the bend
    double foot_length_m = 5e-3;     ///< across, from the bend to the tip, between the ends of the wire's axis
    double insulated_heel_m = 5e-3;  ///< part of the heel that is still insulated
};

/// Frame of an instrument whose shaft's axis passes through `trocar_m` with its reference point at `tip_m`: the shaft
/// runs along local -z from the bend, the foot along local +x, turned by `roll_rad` about the line from the trocar to
/// the tip (right-handed; the shaft's axis itself lies half a foot beside the reference point). At roll 0 the foot
/// points as far "down" (-y) as the shaft allows. Requires tip and trocar to be more than half a foot apart.
tissue::Pose pose_through_trocar(const Vec3& trocar_m, const Vec3& tip_m, double roll_rad, const HookShape& shape = {});

/// The hook's capsules in world space, with velocities from the change of pose over dt_s: foot, bare heel, insulated
/// heel, shaft; a part of no length is left out. Writes into `capsules` (cleared, then filled; no allocation once
/// reserved for 8).
void place_hook(const HookShape& shape, const tissue::Pose& pose, const tissue::Pose& previous, double dt_s,
                std::vector<tissue::Capsule>& capsules);

}  // namespace calot::instruments

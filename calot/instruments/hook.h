#pragma once
// The electro-hook: a 5 mm insulated shaft about a trocar, a bare L-shaped wire at its end.

#include <vector>

#include "calot/tissue/exchange.h"
#include "calot/tissue/input.h"

namespace calot::instruments {

/// Dimensions; defaults are those of a common laparoscopic L-hook (docs/physics.md section 8).
struct HookShape {
    double shaft_diameter_m = 5e-3;
    double shaft_length_m = 0.33;
    double wire_diameter_m = 1e-3;
    double heel_length_m = 10e-3;      ///< along the shaft's axis, from the insulation to the bend
    double foot_length_m = 5e-3;       ///< across, from the bend to the tip
    double insulated_heel_m = 5e-3;    ///< part of the heel that is still insulated
};

/// Frame of an instrument whose shaft passes through `trocar_m` with its reference point at `tip_m`: the shaft runs
/// along local -z, the foot along local +x, turned about the shaft by `roll_rad`. At roll 0 the foot points as far
/// "down" (-y) as the shaft allows.
tissue::Pose pose_through_trocar(const Vec3& trocar_m, const Vec3& tip_m, double roll_rad);

/// The hook's capsules in world space, with velocities from the change of pose over dt_s. Writes into `capsules`
/// (cleared, then filled; no allocation once reserved for 8).
void place_hook(const HookShape& shape, const tissue::Pose& pose, const tissue::Pose& previous, double dt_s, std::vector<tissue::Capsule>& capsules);

}  // namespace calot::instruments

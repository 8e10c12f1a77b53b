#pragma once
// A hand and the instrument in it. The instrument passes through its port (fulcrum): only where its tip is and how it
// is rolled can be chosen.

#include "calot/base/vec.h"
#include "calot/instruments/hook.h"
#include "calot/render/view.h"
#include "calot/tissue/input.h"
#include "calot/viewer/controls.h"

namespace calot::viewer {

/// Where an instrument may go.
struct Reach {
    Vec3 port_m{0.0};
    Vec3 centre_m{0.0};           ///< of the operating field
    double radius_m = 0.075;      ///< the tip stays this close to the centre
    double least_depth_m = 0.03;  ///< of the tip beyond the port
};

/// The nearest allowed tip.
Vec3 within_reach(const Vec3& tip_m, const Reach& reach);

/// Moves a tip by `right` and `up` in the picture (fractions of its height) at the tip's own depth, so that it stays
/// under the hand whatever the scope does, and by `deeper_m` along the shaft.
Vec3 moved_in_view(const Vec3& tip_m, const render::Camera& camera, const Reach& reach, double right, double up,
                   double deeper_m);

/// The instrument as it is held: the hand is a spring and a damper between where it wants to be and where the
/// instrument is, as a device's virtual coupling. So hands that come at the picture's rate move smoothly at the
/// tick's, and an instrument that presses on something stays behind the hand.
class HeldInstrument {
  public:
    HeldInstrument() = default;
    explicit HeldInstrument(const HandTarget& start) : tip_m_(start.tip_m), roll_rad_(start.roll_rad) {}

    /// One tick towards `target`; `force_N` is what acted on the instrument during the last one.
    void advance(const HandTarget& target, const Vec3& force_N, double dt_s);

    const Vec3& tip_m() const { return tip_m_; }
    double roll_rad() const { return roll_rad_; }
    tissue::Pose pose(const Vec3& port_m, const instruments::HookShape& shape) const {
        return instruments::pose_through_trocar(port_m, tip_m_, roll_rad_, shape);
    }

  private:
    Vec3 tip_m_{0.0};
    Vec3 velocity_m_per_s_{0.0};
    double roll_rad_ = 0.0;
};

}  // namespace calot::viewer

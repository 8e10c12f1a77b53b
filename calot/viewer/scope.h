#pragma once
// The laparoscope: a rod through a port of its own with a lens at its end that looks 30 degrees aside.

#include "calot/render/view.h"
#include "calot/simulation/setup.h"

namespace calot::viewer {

class Scope {
  public:
    static constexpr double kLensAngle_rad = 0.5235987755982988;  ///< 30 degrees
    static constexpr double kDepth_m = 0.16;                      ///< of the lens beyond the port, at the start

    /// Looks as the scene's camera does; the rod comes from caudal, under the abdominal wall.
    explicit Scope(const simulation::CameraSetup& camera);

    void turn(double right_rad, double up_rad);  ///< about the port, as seen in the picture
    void advance(double deeper_m);
    void rotate_lens(double angle_rad);  ///< the light post goes round, the camera head stays: the horizon is kept
    void roll(double angle_rad);         ///< the camera head: the horizon turns

    enum class Preset { start, overview, close, from_side };
    void go(Preset preset);

    render::Camera camera() const;
    double lens_rad() const { return lens_rad_; }
    double horizon_rad() const { return roll_rad_; }
    Vec3 tip_m() const;

  private:
    struct Frame {
        Vec3 rod, side, above;  ///< of the rod: where it goes, right and up in the picture
    };
    Frame frame() const;

    Vec3 port_m_{0.0};
    Vec3 rod_{0.0};        ///< unit, at the start
    Vec3 look_at_m_{0.0};  ///< what the scene's camera looks at: focus and exposure
    double field_of_view_deg_ = 60.0;
    double yaw_rad_ = 0.0, pitch_rad_ = 0.0, depth_m_ = kDepth_m;
    double lens_rad_ = 0.0, roll_rad_ = 0.0;
};

}  // namespace calot::viewer

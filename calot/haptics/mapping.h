#pragma once
// From the device's workspace to the instrument, about the trocar.
//
//      handle (hand)                 Lever::tip     the hand moves the tip as it sees it on the screen
//         \                          Lever::handle  the hand holds the handle: its sideways movements come out mirrored
//          \  d_out                                 and scaled by d_in / d_out, as through a real abdominal wall
//     ------o------ trocar
//            \  d_in
//             \ tip
//
// With u the unit vector from the trocar to the tip, the lever's derivative d tip / d handle is
// J = u u^T - (d_in / d_out) (I - u u^T), and forces go back by its transpose, which is J itself.

#include "calot/base/vec.h"
#include "calot/haptics/device.h"
#include "calot/instruments/hook.h"
#include "calot/tissue/input.h"

namespace calot::haptics {

enum class Lever { tip, handle };

struct MappingParameters {
    Lever lever = Lever::tip;
    double scale = 1.0;         ///< how far the instrument goes for a metre of the hand
    Mat3 device_to_world{1.0};  ///< rotation: columns are the device's axes in the world
    Vec3 trocar_m{0.0, -0.08, 0.14};
    double instrument_length_m = 0.36;  ///< handle to tip
    double least_depth_m = 0.03;        ///< of the tip beyond the trocar
    double least_handle_m = 0.04;       ///< of the handle outside it
};

/// Rotation such that what the hand does to the right, up and towards itself goes right, up and towards the camera.
Mat3 device_to_world(const Vec3& eye_m, const Vec3& target_m, const Vec3& up);

/// Roll of an instrument's pose: pose_through_trocar(trocar, tip, roll_of(pose)) gives the pose again.
double roll_of(const Vec3& trocar_m, const tissue::Pose& pose, const instruments::HookShape& hook);

/// The anchored correspondence of device and instrument.
class Mapping {
  public:
    explicit Mapping(const MappingParameters& parameters = {}) : parameters_(parameters) {}

    /// Here the device corresponds to this tip and roll: at the start, and while the clutch is held.
    void anchor(const DeviceSample& device, const Vec3& tip_m, double roll_rad);

    /// Follows the device: the tip that it asks for, within reach, the derivative of that tip by the device's position
    /// (device_to_world, scale and lever), and the roll, which follows the stylus about its own axis.
    void follow(const DeviceSample& device);
    const Vec3& tip_m() const { return tip_m_; }
    /// The same without the limits of reach: the difference is felt as a wall.
    const Vec3& asked_m() const { return asked_m_; }
    const Mat3& derivative() const { return derivative_; }
    double roll_rad() const { return roll_rad_; }
    /// Forces at the tip, as the hand feels them: lever and rotation, true newtons whatever the scale of movement.
    Mat3 force_to_device() const { return glm::transpose(derivative_) / parameters_.scale; }
    const MappingParameters& parameters() const { return parameters_; }

  private:
    MappingParameters parameters_;
    Vec3 device_anchor_m_{0.0}, held_anchor_m_{0.0};  ///< held: of the tip or the handle
    Quat last_orientation_{1.0, 0.0, 0.0, 0.0};
    Vec3 tip_m_{0.0}, asked_m_{0.0};
    Mat3 derivative_{1.0};
    double roll_rad_ = 0.0;
};

}  // namespace calot::haptics

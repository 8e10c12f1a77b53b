#pragma once
// The virtual coupling (Colgate et al. 1995): hand and instrument hang on each other by a spring and a damper, so that
// neither noise nor delays of one shake the other, and so that the hand never feels more than the spring's stiffness.
//
//     hand --[ k, b ]-- instrument (mass m) -- tissue (the simulation itself)
//
//     m v' = k (target - x) + b (v_target - v) + F_tissue
//
// one implicit step a tick, F_tissue being that of the tick before. Tissue stiffness must stay below m / dt^2
// (10 kN/m), which it does by far: fat gives some 40 N/m, rigid organs 1 kN/m.
//
// The servo loop gets where the instrument is in the device's workspace and how stiff the spring is there, so that it
// can answer to the device's own, newer position: f = A (p + w age - x) + D (w - v). Carrying the instrument on by its
// own velocity keeps free movement free: without it, two milliseconds of delay at 0.1 m/s would drag with 0.06 N.

#include <cstdint>

#include "calot/haptics/device.h"
#include "calot/haptics/mapping.h"
#include "calot/tissue/input.h"

namespace calot::haptics {

struct CouplingParameters {
    double stiffness_N_per_m = 300.0;  ///< k; an encoder step of the Touch (0.055 mm) is then 0.017 N
    double damping_N_s_per_m = 2.0;    ///< b; 0.6 of critical with m. More makes encoder steps felt
    double mass_kg = 0.01;             ///< m; of the instrument's end as the coupling moves it
    double most_speed_m_per_s = 0.5;   ///< of the instrument: faster, a wire 1 mm thick skips hexels in a tick
};

/// From the servo loop to the simulation: the hand. `present` is false while the device is not to be followed.
struct HandMessage {
    DeviceSample sample;
    double time_s = 0.0;
    bool present = false;
};

/// From the simulation to the servo loop: where the instrument is, in the device's workspace.
struct ToolMessage {
    Vec3 position_m{0.0};
    Vec3 velocity_m_per_s{0.0};
    Mat3 stiffness_N_per_m{0.0};
    Mat3 damping_N_s_per_m{0.0};
    double hand_time_s = 0.0;  ///< of the hand's sample that it answers
    bool engaged = false;      ///< otherwise there is no force, and no hurry
    bool finite = true;        ///< false: the simulation has gone wrong
};

/// The instrument's end of the coupling; lives on the simulation's thread.
class Coupling {
  public:
    Coupling(const CouplingParameters& parameters, const MappingParameters& mapping, const instruments::HookShape& hook)
        : parameters_(parameters), mapping_(mapping), hook_(hook) {}

    /// The instrument is here, moved by others.
    void place(const tissue::Pose& pose);
    bool anchored() const { return anchored_; }
    /// The hand lets go: it will find the instrument where it is.
    void let_go() { anchored_ = false; }
    /// One tick with the hand: the instrument's new pose.
    tissue::Pose advance(const HandMessage& hand, bool clutch, const Vec3& tissue_force_N, double dt_s);
    ToolMessage message(const HandMessage& hand) const;

  private:
    CouplingParameters parameters_;
    Mapping mapping_;
    instruments::HookShape hook_;
    Vec3 tip_m_{0.0}, velocity_m_per_s_{0.0};
    double roll_rad_ = 0.0;
    bool anchored_ = false, clutch_ = false;
};

}  // namespace calot::haptics

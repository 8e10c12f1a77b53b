#pragma once
// Energy is never generated: whatever the tissue, the delays and the coupling do, the hand gets back at most the energy
// that it put in.
//
// Observer (Hannaford & Ryu 2002, with the exact energy of a force that is held between samples, Ryu et al. 2005): from
// one sample to the next the device did the work f . dx on the hand. The tank holds what the hand put in, less what it
// got back:
//
//     tank(n) = min(capacity, tank(n-1) - f(n-1) . (x(n) - x(n-1)))
//
// Encoders show movement in steps (the Touch: 0.055 mm). While an axis shows none, the hand creeps on under forces that
// differ: the step, when it comes, is booked with their mean. With the last force alone, pressing and releasing 5 kPa
// fat seemed to return a quarter more than it took.
//
// Controller: the force of the coming step is scaled by the greatest s in [0, 1] whose work can be paid,
//
//     expected movement     s f . v dt * safety                                         <=  tank
//     any movement          s f . v dt + 1/2 a dt^2 |s f| + 1/2 |s f|^2 dt^2 / m        <=  tank + start
//
// In the second line the hand accelerates by `a` meanwhile and the device by the force itself. Passivity allows a fixed
// energy at the start; here it only ever pays for the unexpected. Without it, a hand that comes slowly would get no
// force, so put in no energy, so get no force. Departure from the damper of the sources: scaling needs no division by a
// noisy velocity, and it acts before the energy is gone instead of after.
//
// The capacity is the second departure: energy that tissue dissipated would otherwise pile up as a licence to be active
// later.

#include <cstdint>

#include "calot/base/vec.h"

namespace calot::haptics {

struct PassivityParameters {
    double capacity_J = 0.05;                 ///< chosen: 2.5 times what 3.3 N store in coupling and organ
    double hand_acceleration_m_per_s2 = 5.0;  ///< a; chosen: surgeons' hands rarely go beyond
    double start_J = 20e-6;                   ///< chosen: too little to notice, it lifts 2 g by 1 mm
    double safety = 2.0;                      ///< of predicted outflow: velocities are estimates
};

class PassivityControl {
  public:
    explicit PassivityControl(const PassivityParameters& parameters = {}) : parameters_(parameters) {}

    /// The device moved by `moved_m` under the force that limit() or hold() gave last.
    void observe(const Vec3& moved_m);
    /// The most of `wanted_N` that may act for the coming `dt_s`.
    Vec3 limit(const Vec3& wanted_N, const Vec3& velocity_m_per_s, double dt_s, double mass_kg);
    /// No force acts from now on.
    void release() { force_N_ = wanted_N_ = Vec3(0.0); }

    double tank_J() const { return tank_J_; }
    double absorbed_J() const { return absorbed_J_; }              ///< by the virtual world from the hand, net
    double least_absorbed_J() const { return least_absorbed_J_; }  ///< so far; below 0: energy was generated
    double withheld_J() const { return withheld_J_; }              ///< what the controller kept from the hand
    std::int64_t limited() const { return limited_; }              ///< steps in which it acted

  private:
    PassivityParameters parameters_;
    Vec3 force_N_{0.0}, wanted_N_{0.0};
    Vec3 held_sum_N_{0.0}, held_steps_{0.0};  ///< per axis, since it last moved
    double tank_J_ = 0.0, absorbed_J_ = 0.0, least_absorbed_J_ = 0.0, withheld_J_ = 0.0;
    std::int64_t limited_ = 0;
};

}  // namespace calot::haptics

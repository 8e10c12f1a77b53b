#pragma once
// How an instrument moves: path, movements, smoothness.

#include <cstdint>
#include <span>
#include <vector>

#include "calot/base/vec.h"

namespace calot::training {

/// Spectral arc length of a speed profile (Balasubramanian et al. 2015): the arc length of the normalised magnitude
/// spectrum |V(f)| / |V(0)| over f from 0 to the last frequency within 10 Hz where it reaches 0.05, both axes scaled to
/// [0, 1], negated. Near -1.4 for a single bell-shaped reach, the more negative the more broken up. Not a number for
/// fewer than 3 samples or a profile of zeros.
double spectral_arc_length(std::span<const float> speed, double samples_per_s);

/// Watches one instrument's tip, tick by tick.
class MovementWatch {
  public:
    static constexpr int kTicksPerSample = 10;       ///< of the speed profile: 100 Hz at ticks of 1 ms
    static constexpr double kMoving_m_per_s = 5e-3;  ///< faster is moving
    static constexpr double kLeastMovement_s = 0.3;

    explicit MovementWatch(double tick_s);
    /// Once a tick, `tick` counting from 1.
    void after_tick(const Vec3& tip_m, std::int64_t tick);

    double path_m() const { return path_m_; }
    /// Over the movements so far; costs a Fourier transform each.
    double smoothness() const;
    int movements() const;

  private:
    template <class F>
    void for_each_movement(const F& visit) const;  ///< visit(span of speeds)

    double tick_s_;
    double path_m_ = 0.0;
    bool started_ = false;
    Vec3 last_m_{0.0};                           ///< at the last tick
    Vec3 sample_m_{0.0}, sample_before_m_{0.0};  ///< at the last two samples
    int samples_ = 0;
    std::vector<float> speed_m_per_s_;
};

}  // namespace calot::training

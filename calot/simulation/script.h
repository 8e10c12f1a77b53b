#pragma once
// A script of instrument poses against time: what the hands and the foot do in a run without a person.

#include <vector>

#include "calot/base/vec.h"
#include "calot/tissue/input.h"

namespace calot::simulation {

/// The hook's reference point (middle of its foot) and the roll about its shaft at one moment.
struct Keyframe {
    double time_s = 0.0;
    Vec3 tip_m{0.0};
    double roll_rad = 0.0;
};

/// The pedal is down from `from_s` (included) to `to_s` (excluded).
struct Burst {
    double from_s = 0.0;
    double to_s = 0.0;
    double power_W = 30.0;
    tissue::GeneratorMode mode = tissue::GeneratorMode::cut;
    bool wiped = false;  ///< the hook is wiped clean just before
};

/// Between keyframes the tip moves on a monotone cubic (Fritsch & Carlson 1980) per coordinate: smooth, never past a
/// keyframe, at rest where two keyframes agree. Before the first and after the last it stays there.
class Script {
  public:
    Script() = default;
    /// Requires strictly increasing keyframe times, at least one keyframe, and bursts that do not overlap.
    Script(const Vec3& trocar_m, std::vector<Keyframe> keyframes, std::vector<Burst> bursts);

    tissue::Input at(double time_s) const;

    const Vec3& trocar_m() const { return trocar_m_; }
    const std::vector<Keyframe>& keyframes() const { return keyframes_; }
    const std::vector<Burst>& bursts() const { return bursts_; }

  private:
    Vec3 trocar_m_{0.0};
    std::vector<Keyframe> keyframes_;
    std::vector<Burst> bursts_;
    std::vector<glm::dvec4> slopes_;  ///< of (tip, roll) at the keyframes, per second
};

}  // namespace calot::simulation

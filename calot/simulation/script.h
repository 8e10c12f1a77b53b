#pragma once
// A script of instrument poses against time: what the hands and the foot do in a run without a person.

#include <vector>

#include "calot/base/vec.h"
#include "calot/simulation/track.h"
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

/// The grasper's tip, the roll about its shaft and how far its jaws are open at one moment.
struct GrasperKeyframe {
    double time_s = 0.0;
    Vec3 tip_m{0.0};
    double roll_rad = 0.0;
    double jaw = 1.0;  ///< 0 closed ... 1 wide open
};

/// Between keyframes the tips move on monotone cubics (track.h); before the first and after the last they rest.
class Script {
  public:
    Script() = default;
    /// Requires strictly increasing keyframe times, at least one keyframe, and bursts that do not overlap.
    Script(const Vec3& trocar_m, std::vector<Keyframe> keyframes, std::vector<Burst> bursts);
    /// Brings a grasper into the field. Requires strictly increasing times; none: there is no grasper.
    void set_grasper(const Vec3& trocar_m, std::vector<GrasperKeyframe> keyframes);

    tissue::Input at(double time_s) const;

    const Vec3& trocar_m() const { return trocar_m_; }
    const std::vector<Keyframe>& keyframes() const { return keyframes_; }
    const std::vector<Burst>& bursts() const { return bursts_; }
    const Vec3& grasper_trocar_m() const { return grasper_trocar_m_; }
    const std::vector<GrasperKeyframe>& grasper_keyframes() const { return grasper_keyframes_; }

  private:
    Vec3 trocar_m_{0.0}, grasper_trocar_m_{0.0};
    std::vector<Keyframe> keyframes_;
    std::vector<Burst> bursts_;
    std::vector<GrasperKeyframe> grasper_keyframes_;
    Track<4> hook_;     ///< tip, roll
    Track<5> grasper_;  ///< tip, roll, jaw
};

}  // namespace calot::simulation

#pragma once
// Steam and smoke from what boiled off (docs/physics.md section 9): buoyant particles, seen, not felt.

#include <cstdint>
#include <vector>

#include "calot/base/vec.h"
#include "calot/tissue/exchange.h"
#include "calot/tissue/state.h"

namespace calot::effects {

struct SmokeParticle {
    Vec3f position_m{0.0f};
    Vec3f velocity_m_per_s{0.0f};
    float radius_m = 0.0f;
    float steam = 0.0f;   ///< optical mass of white steam [kg]
    float smoke = 0.0f;   ///< optical mass of grey smoke [kg]
    float age_s = 0.0f;
    std::uint32_t seed = 0;
};

struct SmokeParameters {
    double suction_per_s = 0.6;          ///< share of all smoke drawn off a second
    double buoyancy_m_per_s2 = 0.6;
    std::size_t max_particles = 2048;
};

/// Deterministic: a pure function of the gas events, their places and the ticks.
class Smoke {
  public:
    explicit Smoke(const SmokeParameters& parameters = {});
    /// Collects this tick's Exchange::gas; `world_m` gives the place of each event. Every 10 ticks particles move.
    void step(const tissue::Exchange& exchange, const std::vector<Vec3f>& world_m, std::int64_t tick, double tick_s);
    const std::vector<SmokeParticle>& particles() const { return particles_; }
    double emitted_kg() const { return emitted_kg_; }

  private:
    SmokeParameters parameters_;
    std::vector<SmokeParticle> particles_;
    double emitted_kg_ = 0.0;
};

}  // namespace calot::effects

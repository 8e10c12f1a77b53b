#pragma once
// Steam and smoke from what boiled off (docs/physics.md section 9): buoyant particles, seen, not felt.
//
// A particle is a puff of gas with a Gaussian profile; radius_m is its standard deviation, so that its optical depth is
//     tau(b) = K m / (2 pi r^2) exp(-b^2 / (2 r^2)),     transmitted light = exp(-tau),
// at a distance b of the line of sight from its centre. See optical_depth for K.

#include <cstdint>
#include <vector>

#include "calot/base/archive.h"
#include "calot/base/vec.h"
#include "calot/tissue/exchange.h"
#include "calot/tissue/state.h"

namespace calot::effects {

struct SmokeParticle {
    Vec3f position_m{0.0f};
    Vec3f velocity_m_per_s{0.0f};
    float radius_m = 0.0f;
    float steam = 0.0f;  ///< mass of white steam [kg], vapour included
    float smoke = 0.0f;  ///< mass of grey smoke [kg], clear gases included
    float age_s = 0.0f;
    float lift_m_per_s2 = 0.0f;  ///< buoyancy, fades as the puff cools
    std::uint32_t seed = 0;
};

/// Mass extinction of all that a hexel gave off, K [m^2/kg]. Smoke of pyrolysis: 4400 m^2 per kg of aerosol
/// (Mulholland, SFPE Handbook), of which a twentieth of the gasified tissue becomes. Steam: fog droplets of 10 um have
/// 300 m^2/kg, a tenth of the vapour is taken to be fog in dry warm carbon dioxide (both shares chosen by comparing
/// pictures with laparoscopic video, where the field stays in sight through short bursts).
inline constexpr float kSmokeExtinction_m2_per_kg = 220.0f;
inline constexpr float kSteamExtinction_m2_per_kg = 30.0f;

/// Optical depth through the middle of a puff; the two shares say how grey it is.
struct OpticalDepth {
    float steam = 0.0f;
    float smoke = 0.0f;
};
OpticalDepth optical_depth(const SmokeParticle& particle);

struct SmokeParameters {
    double suction_per_s = 1.5;      ///< share of all smoke drawn off a second
    double buoyancy_m_per_s2 = 0.6;  ///< of steam at 100 C as it leaves the tissue
    std::size_t max_particles = 2048;
    Vec3 up{0.0, 0.0, 1.0};  ///< the patient lies on the back: up is anterior
};

/// Deterministic: a pure function of the gas events, their places and the ticks.
class Smoke {
  public:
    explicit Smoke(const SmokeParameters& parameters = {});
    /// Collects this tick's Exchange::gas; `world_m` gives the place of each event. Every particle moves each tenth
    /// tick, a tenth of them in each. `suction`: the surgeon draws smoke off.
    void step(const tissue::Exchange& exchange, const std::vector<Vec3f>& world_m, std::int64_t tick, double tick_s,
              bool suction = false);
    const std::vector<SmokeParticle>& particles() const { return particles_; }

    /// All of it, for a checkpoint. Throws std::runtime_error when more than its size is to be read.
    void archive(Archive& archive);

    // Where the mass is: emitted = pending + in particles + drawn off + faded.
    double emitted_kg() const { return emitted_kg_; }
    double pending_kg() const { return pending_.steam_kg + pending_.smoke_kg; }  ///< not yet enough for a puff
    double particles_kg() const;
    double drawn_off_kg() const { return drawn_off_kg_; }  ///< by suction
    double faded_kg() const { return faded_kg_; }          ///< fog that evaporated, puffs too old or too thin to see

  private:
    struct Pending {
        double steam_kg = 0.0, smoke_kg = 0.0;
        Vec3 moment_kgm{0.0};   ///< mass times place
        double heat_kgK = 0.0;  ///< mass times temperature
    };

    void collect(const tissue::Exchange& exchange, const std::vector<Vec3f>& world_m);
    void emit(double mass_kg);
    struct Stride;  ///< what all particles that move in a tick share
    void move(SmokeParticle& particle, const Stride& stride, const Vec3f& air);  ///< air: its velocity there

    SmokeParameters parameters_;
    std::vector<SmokeParticle> particles_;
    Pending pending_;
    double emitted_kg_ = 0.0, drawn_off_kg_ = 0.0, faded_kg_ = 0.0;
    std::uint32_t next_seed_ = 0;
};

}  // namespace calot::effects

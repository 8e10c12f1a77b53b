#pragma once
// What each activation of the pedal did: energy, what it removed, and how far heat spread beside it. An observer: it
// reads a running simulation and changes nothing.

#include <array>
#include <cstdint>
#include <vector>

#include "calot/simulation/simulation.h"

namespace calot::simulation {

/// How far heat is told to have spread: peak temperatures, and irreversible damage (Omega >= 1).
inline constexpr std::array<double, 3> kSpreadTemperatures_K{318.15, 323.15, 333.15};
inline constexpr std::size_t kSpreadLevels = kSpreadTemperatures_K.size() + 1;
inline constexpr std::array<const char*, kSpreadLevels> kSpreadNames{"45C", "50C", "60C", "damage"};

struct Activation {
    double start_s = 0.0;  ///< pedal down
    double stop_s = 0.0;   ///< and up
    tissue::GeneratorMode mode = tissue::GeneratorMode::cut;
    double power_setting_W = 0.0;
    double energy_J = 0.0;  ///< delivered while it was down
    std::int64_t hexels_removed = 0;
    bool from_cut = false;  ///< spread is measured from the edge of what was removed; else from where metal touched
    /// Farthest tissue that reached each level in this activation (kSpreadNames), from that edge [m]; whole hexels.
    std::array<double, kSpreadLevels> spread_m{};
    double tip_temperature_K = 0.0;  ///< of the wire when the pedal was released
};

/// Temperatures go on rising beside a cut for a while after the pedal is up: spread is measured a second later, or when
/// the pedal goes down again, or at the end of the run. Tissue counts for the activation whose cut is nearest to it:
/// what an earlier one heated elsewhere may still be warming.
class ActivationWatch {
  public:
    explicit ActivationWatch(const tissue::Model& model);
    /// After every tick, with the input that it had.
    void look(const Simulation& run, const tissue::Input& input);
    /// At the end of the run.
    void finish(const Simulation& run);
    const std::vector<Activation>& activations() const { return activations_; }

  private:
    void begin(const Simulation& run, const tissue::Input& input);
    void release(const Simulation& run);
    void measure(const Simulation& run);

    std::vector<Activation> activations_;
    Array<float> peak_before_K_, damage_before_;          ///< when the pedal went down
    BitArray touched_, removed_;                          ///< since then, by metal; by fire or with what fell
    BitArray gone_;                                       ///< removed before
    double energy_before_J_ = 0.0, last_energy_J_ = 0.0;  ///< when it went down; a tick ago
    bool down_ = false, pending_ = false;  ///< pedal is down; the last activation has still to be measured
};

}  // namespace calot::simulation

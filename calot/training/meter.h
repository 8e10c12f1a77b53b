#pragma once
// Measures a session from ground truth, tick by tick: what the window, `calot simulate --task` and `calot score` share.
//
// Per tick it adds a few numbers; duct and artery are looked at every kTicksPerLook ticks (a few thousand hexels),
// organs near energised metal every fourth. All of it depends on tick numbers, State and Input alone, so that a replay
// gives the same score to the last bit.

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "calot/simulation/simulation.h"
#include "calot/training/events.h"
#include "calot/training/metrics.h"
#include "calot/training/movement.h"
#include "calot/training/structures.h"

namespace calot::training {

/// A place that the tip should come to.
struct Target {
    Vec3 position_m{0.0};
    double radius_m = 2e-3;
};

/// A point of the curves in a debrief, twice a second.
struct TrackPoint {
    float time_s = 0.0f;
    float force_peak_N = 0.0f;                 ///< since the point before
    float power_W = 0.0f;                      ///< mean since the point before
    std::array<float, 2> exposed{}, peak_K{};  ///< duct, artery
};

class Meter {
  public:
    static constexpr std::int64_t kTicksPerPoint = 500;
    static constexpr std::int64_t kTicksPerLook = 16;
    static constexpr std::array<double, 5> kExposureSteps{0.1, 0.25, 0.5, 0.75, 0.9};

    /// Of a simulation at tick 0.
    explicit Meter(const simulation::Simulation& run, std::vector<Target> targets = {});

    /// Once a tick, after Simulation::tick(input).
    void after_tick(const simulation::Simulation& run, const tissue::Input& input);

    /// What is known so far. What cannot be known (of structures that the scene has
    /// not, or before anything moved) has no entry. Without `smoothness` it is quick (for
    /// end conditions and displays); with it, movements are analysed.
    Metrics metrics(bool smoothness = true) const;
    const std::vector<Event>& events() const { return events_; }
    const std::vector<TrackPoint>& track() const { return track_; }
    /// For what others find out (goal reached, limit broken).
    void add_event(const Event& event);
    const std::vector<Target>& targets() const { return targets_; }
    bool touched(std::size_t target) const { return touched_[target]; }

    /// What it knows at this tick, as bytes; restore() takes them into a Meter of the same scene and targets, with the
    /// inputs up to then (movements follow from those). Throws std::runtime_error when they do not fit.
    std::string save() const;
    void restore(const std::string& bytes, std::span<const tissue::Input> inputs);

  private:
    void watch_pedal(const simulation::Simulation& run, const tissue::Input& input);
    void watch_contact(const simulation::Simulation& run, const tissue::Input& input);
    void watch_organs(const simulation::Simulation& run, const tissue::Input& input);
    void watch_removal(const simulation::Simulation& run);
    void watch_targets(const tissue::Input& input);
    void look(const simulation::Simulation& run, std::size_t which);
    void heat(const simulation::Simulation& run);
    void add_point(const simulation::Simulation& run);
    void move(const tissue::Input& input, std::int64_t tick);
    void archive(Archive& archive);

    // --- What the scene is: the same for every run of it.
    double tick_s_;
    double hexel_volume_m3_;
    Vec3 trocar_m_;
    tissue::MaterialIndex fat_;
    std::array<Structure, 2> structures_;  ///< duct, artery
    std::vector<std::int64_t> liver_hexels_;
    BitArray between_;
    std::int64_t between_count_ = 0;
    std::vector<std::size_t> dangerous_organs_;  ///< indices into Model::organs
    std::vector<Target> targets_;

    // --- What has happened: archived.
    /// Sums that are plain numbers; times in ticks.
    struct Sums {
        std::int64_t ticks = 0;
        std::int64_t fat_removed = 0, between_removed = 0;
        std::int64_t activations = 0, pedal = 0, pedal_contact = 0, pedal_traction = 0, pedal_longest = 0,
                     pedal_now = 0;
        std::int64_t contact = 0, gentle = 0, organ_touch = 0, hot_touch = 0;
        std::int64_t liver_injured = 0;
        double energy_J = 0.0, energy_at_start_J = 0.0, energy_at_point_J = 0.0, force_since_point_N = 0.0;
        double force_peak_N = 0.0, pull_peak_N = 0.0, liver_peak_K = 0.0;
        std::array<double, 2> heat_J{}, most_A_per_m2{};
        std::array<std::int64_t, 2> burnt_at{-1, -1};
        std::array<std::int32_t, 2> exposure_steps{};
        std::array<std::int64_t, 2> touched_at{-1, -1};
        std::array<bool, 2> injured{};
        bool at_organ = false, in_contact = false;
        std::array<char, 4> unused{};  ///< instead of padding, whose bytes would differ from run to run
        std::array<StructureState, 2> state{};
    } sums_;
    MovementWatch hook_, grasper_;
    bool grasper_used_ = false;
    std::vector<std::uint8_t> touched_;
    std::vector<Event> events_;
    std::vector<TrackPoint> track_;
};

}  // namespace calot::training

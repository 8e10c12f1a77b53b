#pragma once
// timeline.csv: what happened, every 10 ms.

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "calot/simulation/simulation.h"

namespace calot::app {

/// One row; the header's names are those of the members.
struct TimelineRow {
    double time_s = 0.0;
    Vec3 tip_m{0.0};
    Vec3 force_N{0.0};
    bool pedal = false;
    double power_setting_W = 0.0;
    tissue::GeneratorState generator;
    double max_temperature_K = 0.0;  ///< of present tissue, now
    std::int64_t hexels_burnt = 0, hexels_fallen = 0, links_severed = 0;
    double volume_removed_m3 = 0.0;
    double emitted_kg = 0.0;  ///< steam and smoke
    tissue::EnergyBudget energy_J;
    tissue::TipState tip;
    tissue::FieldState field;
    tissue::StrayCurrent stray;
    double stored_J = 0.0;
};

/// Hottest present hexel [K].
double max_temperature_K(const simulation::Simulation& run);

/// A tissue that current may run through: its index and name.
struct Conductor {
    std::size_t material = 0;
    std::string name;
};
/// Tissues that the model holds hexels of, as far as State::stray counts them.
std::vector<Conductor> conductors(const tissue::Model& model);

TimelineRow make_row(const simulation::Simulation& run, const tissue::Input& input);

class Timeline {
  public:
    /// Empty path: rows are only kept for plots. A column with the power in each of `conductors`.
    Timeline(const std::string& path, std::vector<Conductor> conductors);
    void add(const TimelineRow& row);
    /// Throws std::system_error when the disk is full.
    void flush();
    /// At most a few thousand rows, evenly over the run so far.
    const std::vector<TimelineRow>& rows() const { return kept_; }

  private:
    [[noreturn]] void fail() const;
    std::string path_;
    std::vector<Conductor> conductors_;
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
    std::vector<TimelineRow> kept_;
    std::size_t seen_ = 0, stride_ = 1;
};

}  // namespace calot::app

#pragma once
// Runs a simulation and writes what happens: shared by `simulate` and `replay`.

#include <array>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "calot/scene/scene.h"
#include "calot/simulation/activations.h"
#include "calot/simulation/recording.h"
#include "calot/simulation/simulation.h"
#include "calot/training/result.h"
#include "commands.h"
#include "frames.h"
#include "injuries.h"
#include "statistics.h"
#include "timeline.h"

namespace calot::app {

struct RunRecord;

struct RunPlan {
    scene::Scene scene;
    std::shared_ptr<const simulation::Setup> setup;
    std::int64_t ticks = 0;  ///< of the end
    std::function<tissue::Input(std::int64_t tick, double time_s)> input;
    /// Where the run begins, if not at the start, and the recording of what came before. Called once.
    std::function<std::unique_ptr<simulation::Simulation>()> reach;
    const simulation::Recording* before = nullptr;
    /// Before the first tick.
    std::function<void(const simulation::Simulation& run)> begin;
    /// After every tick; false ends the run.
    std::function<bool(const simulation::Simulation& run, const tissue::Input& input)> observe;
    /// At the end, before anything is told: may add to the record.
    std::function<void(RunRecord& record)> conclude;
    OutputChoice output;
};

/// What a run was, for summary and report.
struct RunRecord {
    std::string scene;
    std::uint64_t seed = 0;
    int threads = 0;
    std::string backend;  ///< who computed, at the end
    std::int64_t ticks = 0;
    double duration_s = 0.0;
    bool interrupted = false, stopped_by_observer = false;
    tissue::Status status;
    std::int64_t phyxels_initial = 0, phyxels_removed = 0, hexels_initial = 0;
    double max_temperature_K = 0.0;
    Quantiles force_N;  ///< of ticks with contact
    double energy_imbalance = 0.0;
    TimelineRow last;
    std::vector<Conductor> conductors;
    std::size_t surface_vertices = 0, surface_triangles = 0;
    bool surface_closed = false;
    double surface_volume_m3 = 0.0;
    std::vector<Injury> injuries;
    std::vector<simulation::Activation> activations;  ///< of the pedal
    std::shared_ptr<const training::Result> scored;  ///< of runs with a task
    std::uint64_t state_hash = 0;
    double wall_s = 0.0;        ///< all, with pictures and files
    double wall_ticks_s = 0.0;  ///< ticks alone
    Quantiles tick_us;
    std::array<Quantiles, simulation::kStages> stages_us;
    std::vector<TimelineRow> rows;
    std::vector<Still> stills;
    std::string video, renderer;
    std::vector<std::string> notes;
    std::vector<std::string> files;  ///< written, relative to the output directory
    std::string directory;           ///< final output directory, empty: none

    int exit_code() const;
};

/// Throws InputError before anything is written when the output directory cannot be used; std::system_error when a
/// write fails later (what was written stays under the temporary name, which the message tells).
RunRecord perform(const RunPlan& plan);

/// What to tell people at the end.
void print_outcome(const RunRecord& record);

}  // namespace calot::app

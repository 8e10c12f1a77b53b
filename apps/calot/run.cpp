#include "run.h"

#include <chrono>
#include <cstdio>
#include <optional>
#include <thread>

#include <fmt/format.h>

#include "calot/base/parallel.h"
#include "calot/base/units.h"
#include "calot/viewer/picture.h"
#include "interrupt.h"
#include "output_directory.h"
#include "progress.h"
#include "report.h"
#include "summary.h"
#include "surface_series.h"

namespace calot::app {

namespace {

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

constexpr std::int64_t kTicksPerRow = 10;    ///< of the timeline
constexpr std::int64_t kTicksPerLook = 100;  ///< at injuries
constexpr std::int64_t kTicksPerFlush = 1000;

/// Everything that writes while the run goes on.
class Outputs {
  public:
    Outputs(const RunPlan& plan, const simulation::Simulation& run, double duration_s)
        : directory_(plan.output.directory, plan.output.force),
          recording_(directory_.path("recording.calot"), CALOT_VERSION, run.setup().scene_text, run.state()),
          series_(directory_.partial().string(), plan.output.export_every_s),
          frames_({plan.output.frames, plan.scene.picture, run.time_s(), duration_s, directory_.partial().string()}) {
        if (plan.before != nullptr) recording_.adopt(*plan.before, run.state().tick);
        if (plan.output.frames != FrameKind::none) picture_.emplace(run.setup());
    }

    /// Surfaces and pictures that are due now.
    void look(const simulation::Simulation& run, const tissue::Input& input) {
        if (series_.due(run.time_s())) series_.write(run);
        if (!frames_.due(run.time_s())) return;
        auto view = frames_.take();
        picture_->fill(run, input, *view);
        frames_.submit(std::move(view));
    }
    void record(const tissue::Input& input, const simulation::Simulation& run) {
        if (recording_.hashes_at(run.figures().tick))
            recording_.add(input, run.state());
        else
            recording_.add(input);
    }

    void finish(const simulation::Simulation& run, RunRecord& record) {
        recording_.finish(run.state());
        if (series_.size() > 0 && !series_.due(run.time_s()) && plan_end_missing(run)) series_.write(run);
        frames_.finish();
        record.stills = frames_.stills();
        record.video = frames_.video();
        record.renderer = frames_.renderer();
        for (const std::string& note : frames_.notes()) record.notes.push_back(note);
        record.files = {"report.html", "summary.json", "timeline.csv", "recording.calot"};
        if (!record.video.empty()) record.files.push_back(record.video);
        if (!record.stills.empty()) record.files.push_back("frames/");
        if (series_.size() > 0) record.files.push_back("surface.pvd");
    }
    OutputDirectory& directory() { return directory_; }

  private:
    bool plan_end_missing(const simulation::Simulation& run) const {
        return series_.last_time_s() < run.time_s() - 0.5e-3;
    }

    OutputDirectory directory_;
    simulation::RecordingWriter recording_;
    SurfaceSeries series_;
    std::optional<viewer::Picture> picture_;
    Frames frames_;  // last: its thread must be gone before what it draws
};

void describe_end(const simulation::Simulation& run, RunRecord& record) {
    const tissue::State& state = run.state();
    const surface::Mesh& mesh = run.surface().rest_mesh();
    record.status = state.status;
    record.ticks = state.tick;
    record.duration_s = run.time_s();
    record.phyxels_removed = record.phyxels_initial - state.phyxel_present.count();
    record.energy_imbalance = run.energy_imbalance();
    record.surface_vertices = mesh.position_m.size();
    record.surface_triangles = mesh.triangles();
    record.surface_closed = surface::check(mesh).closed;
    record.surface_volume_m3 = surface::volume_m3(mesh);
    record.state_hash = tissue::hash(state);
    for (float peak : state.peak_temperature_K)
        record.max_temperature_K = std::max(record.max_temperature_K, static_cast<double>(peak));
}

}  // namespace

int RunRecord::exit_code() const {
    if (interrupted) return kInterrupted;
    return status.ok ? kDone : kFailed;
}

RunRecord perform(const RunPlan& plan) {
    catch_interrupts();
    const auto start = Clock::now();
    RunRecord record;
    record.threads = plan.output.threads > 0 ? plan.output.threads
                                             : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    const ThreadLimit limit(record.threads);
    record.scene = plan.setup->name;
    record.seed = plan.setup->seed;

    const std::unique_ptr<simulation::Simulation> begun =
        plan.reach ? plan.reach() : std::make_unique<simulation::Simulation>(plan.setup);
    simulation::Simulation& run = *begun;
    const double duration_s = static_cast<double>(plan.ticks) * run.model().tick_s;
    record.phyxels_initial = run.state().phyxel_present.count();
    record.hexels_initial = run.state().hexel_present.count();
    InjuryWatch watch(run.model(), run.state());
    simulation::ActivationWatch activations(run.model());
    if (plan.begin) plan.begin(run);
    std::optional<Outputs> outputs;
    if (!plan.output.directory.empty()) outputs.emplace(plan, run, duration_s);
    try {
        record.conductors = conductors(run.model());
        Timeline timeline(outputs ? outputs->directory().path("timeline.csv") : "", record.conductors);
        Progress progress(plan.output.progress, duration_s);
        tissue::Input input = plan.input(run.figures().tick, run.time_s());
        for (std::int64_t tick = run.figures().tick; tick < plan.ticks && !record.interrupted && !record.stopped_by_observer; ++tick) {
            input = plan.input(tick, run.time_s());
            if (outputs) outputs->look(run, input);
            if (tick % kTicksPerRow == 0) timeline.add(make_row(run, input));
            const auto before = Clock::now();
            const bool ok = run.tick(input);
            const double tick_s = seconds_since(before);
            record.tick_us.add(tick_s * 1e6);
            record.wall_ticks_s += tick_s;
            for (std::size_t k = 0; k < record.stages_us.size(); ++k)
                record.stages_us[k].add(static_cast<double>(run.stage_us()[k]));
            const double force_N = glm::length(run.figures().hook_force_N);
            if (force_N > 0.0) record.force_N.add(force_N);
            activations.look(run, input);
            if (outputs) outputs->record(input, run);
            if (plan.observe && !plan.observe(run, input)) record.stopped_by_observer = true;
            if (tick % kTicksPerLook == 0) watch.look(run.model(), run.state(), run.time_s());
            if (tick % kTicksPerFlush == 0) timeline.flush();
            progress.update(run.time_s());
            record.interrupted = interrupted();
            if (!ok) break;
        }
        progress.finish();
        record.backend = run.backend().name();
        for (const std::string& notice : run.notices()) record.notes.push_back(notice);
        watch.look(run.model(), run.state(), run.time_s());
        record.injuries = watch.injuries();
        activations.finish(run);
        record.activations = activations.activations();
        record.last = make_row(run, input);
        timeline.add(record.last);
        timeline.flush();
        record.rows = timeline.rows();
        describe_end(run, record);
        if (plan.conclude) plan.conclude(record);
        if (outputs) {
            outputs->look(run, input);
            outputs->finish(run, record);
            record.wall_s = seconds_since(start);
            record.directory = plan.output.directory;
            write_file(outputs->directory().path("summary.json"), summary_json(record));
            write_file(outputs->directory().path("report.html"),
                       report_html(record, plan, outputs->directory().partial().string()));
            outputs->directory().commit();
        }
    } catch (const std::exception&) {
        if (outputs)
            fmt::print(stderr, "calot: what was written so far is in {}\n", outputs->directory().partial().string());
        throw;
    }
    record.wall_s = seconds_since(start);
    return record;
}

void print_outcome(const RunRecord& record) {
    if (!record.status.ok)
        fmt::print(stderr, "calot: the simulation stopped at tick {}: {} is not finite at cell {}\n",
                   record.status.tick, record.status.field, record.status.cell);
    if (record.interrupted)
        fmt::print(stderr, "calot: interrupted after {:.2f} s of simulated time\n", record.duration_s);
    for (const std::string& note : record.notes) fmt::print(stderr, "calot: note: {}\n", note);
    fmt::print("{:.2f} s simulated in {:.1f} s (a tick of 1 ms took {:.3f} ms at the median, {:.3f} ms at 99 %)\n",
               record.duration_s, record.wall_s, record.tick_us.at(0.5) * 1e-3, record.tick_us.at(0.99) * 1e-3);
    fmt::print(
        "removed {} of {} hexels ({:.3f} ml), hottest {:.0f} C, force at most {:.2f} N, energy imbalance {:.1e}\n",
        record.last.hexels_burnt + record.last.hexels_fallen, record.hexels_initial,
        record.last.volume_removed_m3 * 1e6, celsius_from_kelvin(record.max_temperature_K), record.force_N.max(),
        record.energy_imbalance);
    for (const Injury& injury : record.injuries)
        fmt::print("injured: {} ({} hexels burnt away, {} damaged, first at {:.2f} s)\n", injury.structure,
                   injury.hexels_removed, injury.hexels_damaged, injury.first_time_s);
    if (record.directory.empty()) return;
    fmt::print("\nlook at {}/report.html\n", record.directory);
    std::string rest;
    for (const std::string& file : record.files)
        if (file != "report.html") rest += (rest.empty() ? "" : ", ") + file;
    fmt::print("also there: {}\n", rest);
}

}  // namespace calot::app

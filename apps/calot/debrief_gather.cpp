// Gathers what a debrief shows.

#include <algorithm>
#include <filesystem>

#include "calot/base/error.h"
#include "debrief.h"
#include "progress.h"

namespace calot::app {

namespace {

constexpr int kWidth = 560, kHeight = 420;

std::vector<std::pair<double, double>> pedal_spans(const simulation::Recording& recording, double tick_s) {
    std::vector<std::pair<double, double>> spans;
    bool down = false;
    for (std::size_t k = 0; k < recording.inputs.size(); ++k) {
        const bool pedal = recording.inputs[k].pedal;
        if (pedal && !down) spans.emplace_back(static_cast<double>(k) * tick_s, 0.0);
        if (pedal) spans.back().second = static_cast<double>(k + 1) * tick_s;
        down = pedal;
    }
    return spans;
}

/// Evenly spread ticks, the last one among them.
std::vector<std::int64_t> spread_ticks(std::int64_t ticks, int count, std::int64_t grid) {
    std::vector<std::int64_t> chosen;
    for (int k = 0; k < count; ++k) {
        const std::int64_t tick = (ticks - 1) * k / std::max(1, count - 1) / grid * grid;
        if (chosen.empty() || tick > chosen.back()) chosen.push_back(tick);
    }
    return chosen;
}

/// The chosen ones of many, evenly.
std::vector<std::int64_t> thin(const std::vector<std::int64_t>& ticks, int count) {
    const std::size_t stride = ticks.size() / static_cast<std::size_t>(std::max(1, count)) + 1;
    std::vector<std::int64_t> chosen;
    for (std::size_t k = 0; k < ticks.size(); k += stride) chosen.push_back(ticks[k]);
    return chosen;
}

class Gathering {
  public:
    Gathering(DebriefContent& content, int frames, ProgressKind progress)
        : content_(content), recording_(simulation::read_recording(content.subject.recording)), frames_(frames) {
        const DebriefSubject& subject = content_.subject;
        if (recording_.inputs.empty())
            throw InputError(subject.recording, 0, 0, "the recording holds no inputs",
                             "the session was over before it began");
        content_.setup = std::make_shared<simulation::Setup>(
            build_setup(scene::parse(recording_.scene_text, subject.recording + " (its scene)", ".")));
        ticks_ = static_cast<std::int64_t>(recording_.inputs.size());
        content_.duration_s = static_cast<double>(ticks_) * content_.setup->model.tick_s;
        content_.complete = recording_.complete;
        content_.pedal_s = pedal_spans(recording_, content_.setup->model.tick_s);
        progress_.emplace(progress, content_.duration_s);
        if (frames > 0) start_pictures();
    }

    void gather() {
        const std::string file =
            (std::filesystem::path(content_.subject.recording).parent_path() / "checkpoints.calot").string();
        const training::CheckpointReader checkpoints(file);
        const std::vector<std::int64_t> stored = checkpoints.ticks();
        const bool dense =
            static_cast<std::int64_t>(stored.size() + 3) * training::Recorder::kTicksPerCheckpoint >= ticks_;
        if (dense && !stored.empty())
            from_checkpoints(checkpoints);
        else
            from_start();
        progress_->finish();
    }

  private:
    void start_pictures() {
        try {
            pictures_ = std::make_unique<DebriefPictures>(*content_.setup, kWidth, kHeight);
        } catch (const std::runtime_error& error) {
            content_.no_pictures = error.what();
        }
    }
    const tissue::Input& input(std::int64_t tick) const { return recording_.inputs[static_cast<std::size_t>(tick)]; }
    void draw(const simulation::Simulation& run, std::int64_t tick) {
        if (pictures_) content_.frames.push_back(pictures_->frame(run, input(std::min(tick, ticks_ - 1))));
    }

    void from_checkpoints(const training::CheckpointReader& checkpoints) {
        const training::Task* task = content_.subject.task ? &*content_.subject.task : nullptr;
        if (pictures_) {
            simulation::Simulation first(content_.setup);
            const tissue::State initial = first.state();
            first.tick(input(0));  // places the hook
            draw(first, 0);
            for (std::int64_t tick : thin(checkpoints.ticks(), frames_)) {
                if (tick >= ticks_) break;
                tissue::State state = initial;
                training::Aside aside;
                checkpoints.read(tick, state, aside);
                simulation::Simulation run(content_.setup, std::move(state));
                Archive effects(std::move(aside.effects));
                run.archive_effects(effects);
                run.tick(input(tick));
                draw(run, tick);
                progress_->update(run.time_s());
            }
        }
        training::Moment end = training::reach(content_.subject.recording, ticks_, task, content_.setup);
        if (pictures_ && end.run->capsules().empty()) end.run->tick(input(ticks_ - 1));
        conclude(*end.run, *end.meter);
    }

    void from_start() {
        simulation::Simulation run(content_.setup);
        const std::optional<training::Task>& task = content_.subject.task;
        training::Meter meter(run,
                              task ? training::place_targets(*task, run.setup()) : std::vector<training::Target>{});
        std::optional<training::TaskWatch> watch;
        if (task) watch.emplace(*task);
        const std::vector<std::int64_t> chosen = spread_ticks(ticks_, frames_, 1);
        std::size_t next = 0;
        for (std::int64_t tick = 0; tick < ticks_; ++tick) {
            const bool ok = run.tick(input(tick));
            meter.after_tick(run, input(tick));
            if (watch) watch->after_tick(meter, run.state().tick, run.time_s());
            if (next < chosen.size() && tick >= chosen[next]) {
                draw(run, tick);
                ++next;
            }
            progress_->update(run.time_s());
            if (!ok) break;
        }
        conclude(run, meter);
    }

    void conclude(const simulation::Simulation& run, const training::Meter& meter) {
        content_.result = training::conclude(content_.subject.task.value_or(training::Task{}), meter);
        content_.track = meter.track();
        if (pictures_) content_.maps = pictures_->maps(run);
    }

    DebriefContent& content_;
    simulation::Recording recording_;
    int frames_;
    std::int64_t ticks_ = 0;
    std::optional<Progress> progress_;
    std::unique_ptr<DebriefPictures> pictures_;
};

}  // namespace

DebriefContent gather_debrief(const DebriefSubject& subject, int frames, ProgressKind progress) {
    DebriefContent content;
    content.subject = subject;
    Gathering(content, frames, progress).gather();
    return content;
}

}  // namespace calot::app

#include "calot/training/session.h"

#include <algorithm>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>

#include "calot/base/error.h"
#include "calot/scene/scene.h"

namespace calot::training {

namespace {

constexpr std::int64_t kTicksPerFigures = 100;

void write_text(const std::string& path, const std::string& text) {
    std::ofstream stream(path, std::ios::binary);
    stream << text;
    stream.flush();
    if (!stream)
        throw InputError(path, 0, 0, "cannot write this file", "choose a folder that can be written to with --data");
}

std::vector<Target> targets_of(const Task* task, const simulation::Setup& setup) {
    return task != nullptr ? place_targets(*task, setup) : std::vector<Target>{};
}

std::string beside(const std::string& recording, const char* file) {
    return (std::filesystem::path(recording).parent_path() / file).string();
}

/// The latest checkpoint at or before the tick, taken up; or the start.
void take_checkpoint(const CheckpointReader& checkpoints, std::int64_t tick, Moment& moment) {
    const std::int64_t at = checkpoints.last_before(tick);
    if (at <= 0) return;
    tissue::State state = moment.run->state();
    Aside aside;
    checkpoints.read(at, state, aside);
    moment.run = std::make_unique<simulation::Simulation>(moment.setup, std::move(state));
    try {
        Archive effects(std::move(aside.effects));
        moment.run->archive_effects(effects);
        moment.meter->restore(aside.measured, std::span(moment.recording->inputs).first(static_cast<std::size_t>(at)));
    } catch (const std::runtime_error&) {
        // Measured for another task: measure from the start instead.
        moment.run = std::make_unique<simulation::Simulation>(moment.setup);
        moment.meter = std::make_unique<Meter>(*moment.run, moment.meter->targets());
    }
}

}  // namespace

Moment reach(const std::string& recording, std::int64_t tick, const Task* task,
             std::shared_ptr<const simulation::Setup> setup) {
    Moment moment;
    moment.recording = std::make_unique<simulation::Recording>(simulation::read_recording(recording));
    const auto ticks = static_cast<std::int64_t>(moment.recording->inputs.size());
    if (tick < 0 || tick > ticks)
        throw InputError(recording, 0, 0,
                         fmt::format("the recording has no moment {:.3f} s", static_cast<double>(tick) * 1e-3),
                         fmt::format("it ends at {:.3f} s", static_cast<double>(ticks) * 1e-3));
    moment.setup = setup ? std::move(setup)
                         : std::make_shared<const simulation::Setup>(scene::build(
                               scene::parse(moment.recording->scene_text, recording + " (its scene)", ".")));
    moment.run = std::make_unique<simulation::Simulation>(moment.setup);
    moment.meter = std::make_unique<Meter>(*moment.run, targets_of(task, *moment.setup));
    moment.checkpoints = beside(recording, "checkpoints.calot");
    moment.tick = tick;
    take_checkpoint(CheckpointReader(moment.checkpoints), tick, moment);
    std::optional<TaskWatch> watch;
    if (task != nullptr) watch.emplace(*task).restore(moment.meter->events());
    while (moment.run->figures().tick < tick) {
        const tissue::Input& input = moment.recording->inputs[static_cast<std::size_t>(moment.run->figures().tick)];
        if (!moment.run->tick(input))
            throw InputError(recording, 0, 0, "the simulation stops before that moment", "choose an earlier one");
        moment.meter->after_tick(*moment.run, input);
        if (watch) watch->after_tick(*moment.meter, moment.run->figures().tick, moment.run->time_s());
    }
    return moment;
}

std::optional<Task> task_of(const Store& store, std::int64_t session) {
    const std::string path = store.path(session, "task.toml");
    if (!std::filesystem::exists(path)) return std::nullopt;
    return load_task(path);
}

Moment reach(Store& store, std::int64_t session, std::int64_t tick, std::shared_ptr<const simulation::Setup> setup) {
    store.session(session);
    const std::optional<Task> task = task_of(store, session);
    Moment moment = reach(store.path(session, "recording.calot"), tick, task ? &*task : nullptr, std::move(setup));
    moment.session = session;
    return moment;
}

void LiveSession::enter(const SessionStart& start, const simulation::Setup& setup) {
    row_.trainee = start.trainee;
    row_.scene = setup.name;
    row_.seed = setup.seed;
    row_.task = start.task ? start.task->name : "";
    row_.program_version = start.program_version;
    task_ = start.task;
    row_.id = store_.begin(row_, lock_);
    if (task_) {
        write_text(store_.path(row_.id, "task.toml"), task_->text);
        watch_.emplace(*task_);
        watch_->restore(meter_->events());
    }
}

LiveSession::LiveSession(Store& store, const SessionStart& start, const simulation::Simulation& run)
    : store_(store),
      meter_(std::make_unique<Meter>(run, targets_of(start.task ? &*start.task : nullptr, run.setup()))) {
    enter(start, run.setup());
    recorder_ = std::make_unique<Recorder>(folder(), start.program_version, run.setup().scene_text, run.state(),
                                           Recorder::Prefix{});
}

LiveSession::LiveSession(Store& store, const SessionStart& start, Moment& from)
    : store_(store), meter_(std::move(from.meter)) {
    row_.parent = from.session;
    row_.parent_tick = from.tick;
    enter(start, *from.setup);
    const simulation::Simulation fresh(from.setup);  // its state is the one that checkpoints are told against
    recorder_ = std::make_unique<Recorder>(folder(), start.program_version, from.setup->scene_text, fresh.state(),
                                           Recorder::Prefix{from.recording.get(), from.checkpoints, from.tick});
}

LiveSession::~LiveSession() = default;

void LiveSession::after_tick(const simulation::Simulation& run, const tissue::Input& input) {
    meter_->after_tick(run, input);
    const std::int64_t tick = run.figures().tick;
    if (watch_) {
        watch_->after_tick(*meter_, tick, run.time_s());
        if (tick % kTicksPerFigures == 0) {
            const Metrics now = meter_->metrics(false);
            for (std::size_t k = 0; k < std::min(task_->end.size(), LiveFigures::kMostGoals); ++k) {
                const auto found = now.find(task_->end[k].metric);
                if (found != now.end()) figures_.goals[k] = found->second;
            }
            const Score current = score(*task_, now);
            figures_.points = current.points;
            figures_.limits_broken = static_cast<int>(current.broken.size());
            figures_.completed = watch_->completed();
            figures_.ended = watch_->ended();
        }
    }
    recorder_->after_tick(run, input, [this, &run] {
        Archive effects;
        const_cast<simulation::Simulation&>(run).archive_effects(effects);  // writing changes nothing
        return Aside{meter_->save(), effects.bytes()};
    });
}

SessionRow LiveSession::finish(const simulation::Simulation& run) {
    recorder_->finish(run.state());
    row_.status = SessionStatus::finished;
    row_.duration_s = run.time_s();
    row_.metrics = meter_->metrics();
    if (task_) {
        result_ = conclude(*task_, *meter_);
        row_.points = result_->score.points;
        row_.completed = result_->score.completed;
        write_text(store_.path(row_.id, "score.json"), to_json(*result_));
    }
    store_.finish(row_);
    return store_.session(row_.id);
}

namespace {

/// Duration from the recording, what was measured from the last checkpoint.
void recover_one(Store& store, std::int64_t id) {
    const auto lock = SessionLock::take(store.path(id, "lock"));
    if (!lock) return;  // somebody else is at it
    SessionRow row = store.session(id);
    if (row.status != SessionStatus::running) return;
    row.status = SessionStatus::recovered;
    try {
        const std::string path = store.path(id, "recording.calot");
        const simulation::Recording recording = simulation::read_recording(path);
        row.duration_s = static_cast<double>(recording.inputs.size()) * 1e-3;
        const std::int64_t last = CheckpointReader(store.path(id, "checkpoints.calot")).last_before(1ll << 60);
        const std::optional<Task> task = task_of(store, id);
        if (last > 0) {
            const Moment moment = reach(path, last, task ? &*task : nullptr);
            row.metrics = moment.meter->metrics();
            if (task) {
                const Score points = score(*task, row.metrics);
                row.points = points.points;
                row.completed = points.completed;
            }
        }
    } catch (const InputError&) {
        // Killed before there was anything to read: it is entered as what it is, a session of no length.
    }
    store.finish(row);
}

}  // namespace

std::vector<std::int64_t> recover(Store& store) {
    const std::vector<std::int64_t> found = store.abandoned();
    for (std::int64_t id : found) recover_one(store, id);
    return found;
}

}  // namespace calot::training

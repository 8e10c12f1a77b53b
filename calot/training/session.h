#pragma once
// A session: a trainee, a patient, a task, from the first tick to the debrief. The window and the scripted runs of
// `calot simulate --session` share it.
//
//     Store store(default_data_directory());
//     LiveSession session(store, {.task = task, .trainee = "A"}, run);       // Simulation at tick 0
//     ... run.tick(input); session.after_tick(run, input); ...               // physics thread
//     SessionRow row = session.finish(run);
//
// To go on from any moment of a session: Moment m = reach(...); LiveSession next(store, start, std::move(m)).

#include <array>
#include <atomic>
#include <memory>
#include <optional>
#include <string>

#include "calot/training/recorder.h"
#include "calot/training/result.h"
#include "calot/training/store.h"

namespace calot::training {

struct SessionStart {
    std::optional<Task> task;  ///< none: free practice
    std::string trainee;       ///< a label; may be empty
    std::string program_version;
};

/// A moment of an earlier run, reached again: what a session continues from.
struct Moment {
    std::shared_ptr<const simulation::Setup> setup;
    std::unique_ptr<simulation::Simulation> run;  ///< at the moment, to the last bit as it was
    std::unique_ptr<Meter> meter;                 ///< what had been measured by then
    std::unique_ptr<simulation::Recording> recording;
    std::string checkpoints;  ///< path, may not exist
    std::int64_t tick = 0;
    std::optional<std::int64_t> session;  ///< that it belongs to
};

/// Reaches tick `tick` of a recording: from the nearest checkpoint before, or from the start. `task` (may be null) says
/// what the meter measures. `setup`: of the recording's scene if there is one already; null: built anew. Throws
/// InputError when the recording is shorter.
Moment reach(const std::string& recording, std::int64_t tick, const Task* task,
             std::shared_ptr<const simulation::Setup> setup = nullptr);
/// The same for a stored session, in its own task.
Moment reach(Store& store, std::int64_t session, std::int64_t tick,
             std::shared_ptr<const simulation::Setup> setup = nullptr);

/// Task of a stored session; none for free practice.
std::optional<Task> task_of(Store& store, std::int64_t session);

/// Values for a display, written by the physics thread, read by any other.
struct LiveFigures {
    static constexpr std::size_t kMostGoals = 8;
    std::array<std::atomic<double>, kMostGoals> goals{};  ///< values of Task::end, in order
    std::atomic<double> points{0.0};
    std::atomic<int> limits_broken{0};
    std::atomic<bool> completed{false}, ended{false};
};

class LiveSession {
  public:
    /// `run` at tick 0. Throws InputError when the store cannot be written.
    LiveSession(Store& store, const SessionStart& start, const simulation::Simulation& run);
    /// Continues from a moment, whose simulation stays the caller's and may have been taken out of it.
    LiveSession(Store& store, const SessionStart& start, Moment& from);
    /// Without finish() the session stays as it would after a crash: to be recovered.
    ~LiveSession();

    /// Once a tick, after Simulation::tick(input). Takes no lock and waits for nothing.
    void after_tick(const simulation::Simulation& run, const tissue::Input& input);
    bool ended() const { return figures_.ended.load(); }
    const LiveFigures& figures() const { return figures_; }
    const Meter& meter() const { return *meter_; }  ///< for the physics thread, or once it is done
    const std::optional<Task>& task() const { return task_; }
    std::int64_t id() const { return row_.id; }
    std::string folder() const { return store_.session_folder(row_.id); }
    /// For people: what went wrong with the files, "" while all is well.
    std::string trouble() const { return recorder_->trouble(); }

    /// Ends the recording and enters the outcome into the store.
    SessionRow finish(const simulation::Simulation& run);
    /// After finish(), where there is a task.
    const std::optional<Result>& result() const { return result_; }

  private:
    void enter(const SessionStart& start, const simulation::Setup& setup);

    Store& store_;
    SessionRow row_;
    SessionLock lock_;
    std::optional<Task> task_;
    std::unique_ptr<Meter> meter_;
    std::optional<TaskWatch> watch_;
    std::unique_ptr<Recorder> recorder_;
    std::optional<Result> result_;
    LiveFigures figures_;
};

/// Closes sessions whose program is gone: their recordings stay, cut off; what had been measured by the last checkpoint
/// is entered. Returns their numbers.
std::vector<std::int64_t> recover(Store& store);

}  // namespace calot::training

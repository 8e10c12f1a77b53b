#include "training_exercises.h"

#include <filesystem>

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <unistd.h>

#include "calot/base/error.h"
#include "calot/training/questionnaire.h"
#include "calot/training/session.h"
#include "scored.h"

extern char** environ;

namespace calot::app {

namespace {

/// Writes a session's debrief in a program of its own: drawing its pictures takes seconds, and the window goes on.
void write_debrief_beside(const training::Store& store, std::int64_t session) {
    const std::string id = fmt::format("{}", session);
    std::vector<std::string> words{"calot", "debrief", id, "--data", store.directory(), "--quiet"};
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);
    pid_t child = 0;
    ::posix_spawn(&child, "/proc/self/exe", &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
}

/// What is worth coming back to, from what happened.
std::vector<viewer::Mark> marks_of(const std::vector<training::Event>& events) {
    using Kind = viewer::Mark::Kind;
    std::vector<viewer::Mark> marks;
    const auto add = [&](const training::Event& event, Kind kind, const char* text, const std::string& subject) {
        marks.push_back({kind, event.time_s, text, subject});
    };
    for (const training::Event& event : events) {
        const std::string structure = "structure." + event.structure;
        switch (event.kind) {
            case training::EventKind::activation_start:
            case training::EventKind::activation_end:
                break;  // the timeline has the pedal
            case training::EventKind::touch:
                add(event, Kind::touch, event.value > 0.0 ? "mark.touch_energised" : "mark.touch", structure);
                break;
            case training::EventKind::organ_touch:
                add(event, Kind::harm, "mark.organ_touch", structure);
                break;
            case training::EventKind::exposed:
                add(event, Kind::progress, event.value >= 0.5 ? "mark.exposed_half" : "mark.exposed", structure);
                break;
            case training::EventKind::injured:
                add(event, Kind::harm, "mark.injured", structure);
                break;
            case training::EventKind::burnt:
                add(event, Kind::harm, "mark.burnt", structure);
                break;
            case training::EventKind::target:
                add(event, Kind::progress, "mark.target", fmt::format("{:.0f}", event.value));
                break;
            case training::EventKind::completed:
                add(event, Kind::progress, "mark.completed", "");
                break;
            case training::EventKind::limit:
                add(event, Kind::harm, "mark.limit", event.structure);
                break;
        }
    }
    return marks;
}

class TrainingAttempt : public viewer::Attempt {
  public:
    TrainingAttempt(std::shared_ptr<training::Store> store, training::SessionStart start)
        : store_(std::move(store)), start_(std::move(start)) {}
    /// Goes on from a moment, whose simulation was taken out.
    TrainingAttempt(std::shared_ptr<training::Store> store, training::SessionStart start, training::Moment from)
        : store_(std::move(store)), start_(std::move(start)), from_(std::move(from)) {}

    void begin(const simulation::Simulation& run) override {
        if (from_)
            live_.emplace(*store_, start_, *from_);
        else
            live_.emplace(*store_, start_, run);
        from_.reset();
    }
    void after_tick(const simulation::Simulation& run, const tissue::Input& input) override {
        live_->after_tick(run, input);
    }
    void end(const simulation::Simulation& run) override {
        try {
            row_ = live_->finish(run);
        } catch (const std::exception& error) {
            trouble_ = error.what();
        }
    }
    bool done() const override { return live_ && live_->ended(); }
    std::vector<viewer::HudLine> hud() override;
    viewer::Debrief debrief() override;

  private:
    std::shared_ptr<training::Store> store_;
    training::SessionStart start_;
    std::optional<training::Moment> from_;
    std::optional<training::LiveSession> live_;
    std::optional<training::SessionRow> row_;
    std::string trouble_;
    bool asked_ = false;
};

std::vector<viewer::HudLine> TrainingAttempt::hud() {
    std::vector<viewer::HudLine> lines;
    if (!live_) return lines;
    using Mood = viewer::HudLine::Mood;
    if (start_.task) {
        const training::LiveFigures& figures = live_->figures();
        const std::vector<training::Bound>& goals = start_.task->end;
        for (std::size_t k = 0; k < std::min(goals.size(), training::LiveFigures::kMostGoals); ++k) {
            const training::Metric& metric = *training::find_metric(goals[k].metric);
            const double value = figures.goals[k];
            const bool met = goals[k].met({{goals[k].metric, value}});
            const double goal = goals[k].at_least ? *goals[k].at_least : *goals[k].at_most;
            lines.push_back(
                {metric.title, fmt::format("{} / {}", training::shown(metric, value), training::shown(metric, goal)),
                 met ? Mood::good : Mood::plain, "", goals[k].at_least && goal > 0.0 ? value / goal : -1.0});
        }
        const int broken = figures.limits_broken;
        if (broken > 0) lines.push_back({"hud.limits_broken", fmt::format("{}", broken), Mood::bad});
    }
    const std::string trouble = live_->trouble();
    if (!trouble.empty()) lines.push_back({"hud.recording", trouble, Mood::bad});
    return lines;
}

viewer::Past past_of(const std::shared_ptr<training::Store>& store, const training::SessionStart& start,
                     std::int64_t session, std::vector<viewer::Mark> marks) {
    viewer::Past past;
    past.recording = store->path(session, "recording.calot");
    past.marks = std::move(marks);
    past.resume = [store, start, session](std::int64_t tick, std::shared_ptr<const simulation::Setup> setup) {
        training::Moment moment = training::reach(*store, session, tick, std::move(setup));
        std::unique_ptr<simulation::Simulation> run = std::move(moment.run);
        return std::pair(std::move(run), std::shared_ptr<viewer::Attempt>(
                                             std::make_shared<TrainingAttempt>(store, start, std::move(moment))));
    };
    return past;
}

viewer::Questionnaire questionnaire_for(const std::shared_ptr<training::Store>& store, std::int64_t session) {
    viewer::Questionnaire questionnaire;
    for (const training::Question& question : training::questions()) questionnaire.statements.push_back(question.text);
    for (const char* word : training::scale()) questionnaire.scale.push_back(word);
    questionnaire.store = [store, session](const std::vector<std::optional<int>>& answers, const std::string& remark) {
        store->answer(session, answers, remark);
    };
    return questionnaire;
}

viewer::Debrief TrainingAttempt::debrief() {
    viewer::Debrief debrief;
    using Mood = viewer::HudLine::Mood;
    if (!row_) {
        debrief.title = "debrief.not_stored";
        debrief.lines.push_back({"", trouble_, Mood::bad});
        return debrief;
    }
    debrief.title = start_.task ? start_.task->title : std::string("exercise.free");
    if (live_->result()) {
        const training::Score& score = live_->result()->score;
        debrief.outcome = {score.completed ? "debrief.completed" : "debrief.not_completed",
                           fmt::format("{:.0f} / 100", score.points),
                           !score.broken.empty() ? Mood::bad
                           : score.completed     ? Mood::good
                                                 : Mood::plain};
        for (const training::BrokenLimit& limit : score.broken)
            debrief.lines.push_back({limit.message, fmt::format("\u2264 {:.0f} / 100", limit.cap), Mood::bad});
        for (const training::ScorePart& part : score.parts)
            if (part.known)
                debrief.lines.push_back({training::find_metric(part.metric)->title,
                                         fmt::format("{:.0f} / {:.0f}", part.points, part.weight),
                                         part.points >= 0.75 * part.weight ? Mood::good : Mood::plain,
                                         training::shown(*training::find_metric(part.metric), part.value)});
    }
    if (!asked_) write_debrief_beside(*store_, row_->id);
    asked_ = true;
    debrief.report = store_->path(row_->id, "debrief.html");
    debrief.past = past_of(store_, start_, row_->id, marks_of(live_->meter().events()));
    debrief.questionnaire = questionnaire_for(store_, row_->id);
    return debrief;
}

/// The newest session that was cut off; older ones are closed as they are when a program next looks at the store.
std::optional<viewer::CutOff> find_cut_off(const std::shared_ptr<training::Store>& store, const std::string& trainee) {
    const std::vector<std::int64_t> found = store->abandoned();
    if (found.empty()) return std::nullopt;
    const training::SessionRow row = store->session(found.back());
    viewer::CutOff cut_off;
    training::SessionStart start{training::task_of(*store, row.id), row.trainee.empty() ? trainee : row.trainee,
                                 CALOT_VERSION};
    cut_off.exercise = row.task.empty() ? "free" : row.task;
    cut_off.title = start.task ? start.task->title : std::string("exercise.free");
    cut_off.started_utc = row.started_utc;
    cut_off.past = past_of(store, start, row.id, {});
    cut_off.past.find_marks = [store, id = row.id, recording = cut_off.past.recording] {
        const auto ticks = static_cast<std::int64_t>(simulation::read_recording(recording).inputs.size());
        return marks_of(training::reach(*store, id, ticks).meter->events());
    };
    // Closing it takes a run from its last checkpoint on: that is not for the window to wait for.
    cut_off.close = [store, id = row.id] { write_debrief_beside(*store, id); };
    return cut_off;
}

}  // namespace

std::vector<viewer::Exercise> training_exercises(const std::string& data, const std::string& trainee,
                                                 std::string& trouble, std::optional<viewer::CutOff>& cut_off) {
    std::shared_ptr<training::Store> store;
    try {
        store = std::make_shared<training::Store>(data.empty() ? training::default_data_directory() : data);
    } catch (const InputError& error) {
        trouble = error.describe();
    }
    try {
        if (store) cut_off = find_cut_off(store, trainee);
    } catch (const std::exception&) {
        // What cannot be told of it here is told by `calot sessions`.
    }
    const auto attempt = [store, trainee](std::optional<training::Task> task) {
        return [store, trainee, task](const simulation::Setup&) -> std::shared_ptr<viewer::Attempt> {
            if (!store) return nullptr;
            return std::make_shared<TrainingAttempt>(store, training::SessionStart{task, trainee, CALOT_VERSION});
        };
    };
    std::vector<viewer::Exercise> exercises{viewer::free_practice()};
    exercises.front().attempt = attempt(std::nullopt);
    for (const std::string& path : training::list_tasks(task_folders())) {
        const training::Task task = training::load_task(path);
        viewer::Exercise exercise;
        exercise.id = task.name;
        exercise.name = task.title;
        exercise.about = task.goal;
        exercise.assignments = task.assignments;
        exercise.hints = task.hints;
        for (const training::Patient& patient : task.patients)
            exercise.own_patients.push_back({patient.seed, patient.difficulty, patient.name, {}});
        exercise.attempt = attempt(task);
        exercises.push_back(std::move(exercise));
    }
    return exercises;
}

}  // namespace calot::app

#include "training_exercises.h"

#include <filesystem>

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <unistd.h>

#include "calot/base/error.h"
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

class TrainingAttempt : public viewer::Attempt {
  public:
    TrainingAttempt(std::shared_ptr<training::Store> store, training::SessionStart start)
        : store_(std::move(store)), start_(std::move(start)) {}

    void begin(const simulation::Simulation& run) override { live_.emplace(*store_, start_, run); }
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

    std::vector<viewer::HudLine> hud() override {
        std::vector<viewer::HudLine> lines;
        if (!live_ || !start_.task) return lines;
        using Mood = viewer::HudLine::Mood;
        const training::LiveFigures& figures = live_->figures();
        const std::vector<training::Bound>& goals = start_.task->end;
        for (std::size_t k = 0; k < std::min(goals.size(), training::LiveFigures::kMostGoals); ++k) {
            const training::Metric& metric = *training::find_metric(goals[k].metric);
            const double value = figures.goals[k];
            const bool met = goals[k].met({{goals[k].metric, value}});
            lines.push_back(
                {metric.title,
                 fmt::format("{} / {}", training::shown(metric, value),
                             training::shown(metric, goals[k].at_least ? *goals[k].at_least : *goals[k].at_most)),
                 met ? Mood::good : Mood::plain});
        }
        const int broken = figures.limits_broken;
        if (broken > 0) lines.push_back({"Limits broken", fmt::format("{}", broken), Mood::bad});
        const std::string trouble = live_->trouble();
        if (!trouble.empty()) lines.push_back({"Recording", trouble, Mood::bad});
        return lines;
    }

    viewer::Debrief debrief() override {
        viewer::Debrief debrief;
        using Mood = viewer::HudLine::Mood;
        if (!row_) {
            debrief.title = "The session could not be stored";
            debrief.lines.push_back({"", trouble_, Mood::bad});
            return debrief;
        }
        debrief.title = live_->result() ? fmt::format("{}: {:.0f} of 100 points", start_.task->title, *row_->points)
                                        : std::string("Free practice");
        if (live_->result()) {
            const training::Score& score = live_->result()->score;
            for (const training::BrokenLimit& limit : score.broken)
                debrief.lines.push_back({limit.message, fmt::format("at most {:.0f}", limit.cap), Mood::bad});
            for (const training::ScorePart& part : score.parts)
                if (part.known)
                    debrief.lines.push_back({training::find_metric(part.metric)->title,
                                             fmt::format("{:.0f} of {:.0f}", part.points, part.weight),
                                             part.points >= 0.75 * part.weight ? Mood::good : Mood::plain});
        }
        if (!asked_) write_debrief_beside(*store_, row_->id);
        asked_ = true;
        debrief.report = store_->path(row_->id, "debrief.html");
        return debrief;
    }

  private:
    std::shared_ptr<training::Store> store_;
    training::SessionStart start_;
    std::optional<training::LiveSession> live_;
    std::optional<training::SessionRow> row_;
    std::string trouble_;
    bool asked_ = false;
};

}  // namespace

std::vector<viewer::Exercise> training_exercises(const std::string& data, const std::string& trainee,
                                                 std::string& trouble) {
    std::shared_ptr<training::Store> store;
    try {
        store = std::make_shared<training::Store>(data.empty() ? training::default_data_directory() : data);
    } catch (const InputError& error) {
        trouble = error.describe();
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
        exercise.attempt = attempt(task);
        exercises.push_back(std::move(exercise));
    }
    return exercises;
}

}  // namespace calot::app

#include "scored.h"

#include <fmt/format.h>

namespace calot::app {

training::Task choose_task(const std::string& name) {
    return training::load_task(training::find_task(name, task_folders()));
}

void score_against(const training::Task& task, RunPlan& plan, bool to_the_end) {
    struct Measuring {
        explicit Measuring(const training::Task& chosen) : task(chosen), watch(task) {}
        training::Task task;
        training::TaskWatch watch;
        std::unique_ptr<training::Meter> meter;
    };
    const auto measuring = std::make_shared<Measuring>(task);
    plan.begin = [measuring](const simulation::Simulation& run) {
        measuring->meter =
            std::make_unique<training::Meter>(run, training::place_targets(measuring->task, run.setup()));
    };
    plan.observe = [measuring, to_the_end](const simulation::Simulation& run, const tissue::Input& input) {
        measuring->meter->after_tick(run, input);
        measuring->watch.after_tick(*measuring->meter, run.figures().tick, run.time_s());
        return to_the_end || !measuring->watch.ended();
    };
    plan.conclude = [measuring](RunRecord& record) {
        record.scored = std::make_shared<training::Result>(training::conclude(measuring->task, *measuring->meter));
    };
}

void print_score(const training::Result& result) {
    const training::Score& score = result.score;
    fmt::print("\n{}: {:.0f} of 100 points{}\n", result.task.title, score.points,
               score.completed ? ", goal reached" : "");
    for (const training::BrokenLimit& limit : score.broken)
        fmt::print("  limit broken: {} (at most {:.0f} points)\n", limit.message, limit.cap);
    for (const training::ScorePart& part : score.parts) {
        const training::Metric& metric = *training::find_metric(part.metric);
        fmt::print("  {:>5.1f} of {:<5.1f} {:<42} {}\n", part.points, part.weight, metric.title,
                   part.known ? training::shown(metric, part.value) : "not in this scene");
    }
    const training::ScorePart* most = nullptr;
    for (const training::ScorePart& part : score.parts)
        if (part.known && !part.tip.empty() && (!most || part.weight - part.points > most->weight - most->points))
            most = &part;
    if (most && most->weight - most->points > 0.5)
        fmt::print("  most to gain ({:.0f} points): {}\n", most->weight - most->points, most->tip);
}

}  // namespace calot::app

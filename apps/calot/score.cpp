// `calot score` and `calot tasks`.

#include <filesystem>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "calot/base/error.h"
#include "calot/simulation/recording.h"
#include "commands.h"
#include "scored.h"

namespace calot::app {

int score(const ScoreOptions& options) {
    const simulation::Recording recording = simulation::read_recording(options.recording);
    if (recording.inputs.empty())
        throw InputError(options.recording, 0, 0, "the recording holds no inputs",
                         "it was cut off within its first second");
    training::Task task;
    const std::filesystem::path beside = std::filesystem::path(options.recording).parent_path() / "task.toml";
    if (!options.task.empty())
        task = choose_task(options.task);
    else if (std::filesystem::exists(beside))
        task = training::load_task(beside.string());
    else
        throw InputError("score against which task?", "--task NAME; `calot tasks` lists them");

    RunPlan plan;
    plan.scene = scene::parse(recording.scene_text, options.recording + " (its scene)", ".");
    plan.setup = std::make_shared<simulation::Setup>(build_setup(plan.scene));
    plan.output.progress = options.json ? ProgressKind::none : ProgressKind::automatic;
    plan.output.threads = options.threads;
    plan.ticks = static_cast<std::int64_t>(recording.inputs.size());
    plan.input = [&recording](std::int64_t tick, double) { return recording.inputs[static_cast<std::size_t>(tick)]; };
    score_against(task, plan, true);
    const RunRecord record = perform(plan);
    if (options.json)
        fmt::print("{}", training::to_json(*record.scored));
    else
        print_score(*record.scored);
    return record.exit_code();
}

int tasks(const TasksOptions& options) {
    if (options.metrics) {
        for (const training::Metric& metric : training::metric_table()) {
            fmt::print("{}  {}{}\n    = {}\n", metric.name, metric.title,
                       *metric.unit ? fmt::format(" [{}]", metric.unit) : "", metric.formula);
            if (*metric.source) fmt::print("    {}\n", metric.source);
        }
        return kDone;
    }
    for (const std::string& path : training::list_tasks(task_folders())) {
        const training::Task task = training::load_task(path);
        fmt::print("{:<16}{}\n{:<16}{}\n{:<16}scene {}\n", task.name, task.title, "", task.goal, "", task.scene);
        for (const training::Patient& patient : task.patients)
            fmt::print("{:<16}patient {} (seed {}, {})\n", "", patient.name, patient.seed,
                       patient.difficulty == 1   ? "easy"
                       : patient.difficulty == 2 ? "medium"
                                                 : "hard");
        fmt::print("\n");
    }
    fmt::print(
        "`calot simulate SCENE --task NAME` scores a script, `calot score RECORDING --task NAME` a recording.\n");
    return kDone;
}

}  // namespace calot::app

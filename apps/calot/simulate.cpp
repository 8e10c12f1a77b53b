#include <cmath>
#include <filesystem>

#include <fmt/format.h>

#include "commands.h"
#include "run.h"
#include "scored.h"

namespace calot::app {

int simulate(const SimulateOptions& options) {
    if (options.session) {
        SessionOptions stored;
        stored.scene = options.scene;
        stored.task = options.task;
        stored.trainee = options.trainee;
        stored.data = options.data;
        stored.frames = options.output.frames == FrameKind::none ? 0 : stored.frames;
        stored.threads = options.output.threads;
        stored.progress = options.output.progress;
        stored.backend = options.backend;
        return session(stored);
    }
    RunPlan plan;
    plan.scene = load_scene(options.scene);
    plan.output = options.output;
    if (plan.output.directory.empty())
        plan.output.directory =
            (std::filesystem::path("out") / std::filesystem::path(options.scene.path).stem()).string();
    auto setup = std::make_shared<simulation::Setup>(build_setup(plan.scene));
    use_backend(options.backend, *setup);
    plan.setup = setup;
    plan.ticks = std::max<std::int64_t>(1, std::llround(setup->duration_s / setup->model.tick_s));
    plan.input = [setup](std::int64_t, double time_s) { return setup->script.at(time_s); };
    if (!options.task.empty()) score_against(choose_task(options.task), plan, false);
    const RunRecord record = perform(plan);
    if (options.output.progress != ProgressKind::none) print_outcome(record);
    if (options.output.progress != ProgressKind::none && record.scored) print_score(*record.scored);
    return record.exit_code();
}

}  // namespace calot::app

#include <cmath>
#include <filesystem>

#include <fmt/format.h>

#include "commands.h"
#include "run.h"

namespace calot::app {

int simulate(const SimulateOptions& options) {
    RunPlan plan;
    plan.scene = load_scene(options.scene);
    plan.output = options.output;
    if (plan.output.directory.empty())
        plan.output.directory =
            (std::filesystem::path("out") / std::filesystem::path(options.scene.path).stem()).string();
    auto setup = std::make_shared<simulation::Setup>(build_setup(plan.scene));
    plan.setup = setup;
    plan.ticks = std::max<std::int64_t>(1, std::llround(setup->duration_s / setup->model.tick_s));
    plan.input = [setup](std::int64_t, double time_s) { return setup->script.at(time_s); };
    const RunRecord record = perform(plan);
    if (options.output.progress != ProgressKind::none) print_outcome(record);
    return record.exit_code();
}

}  // namespace calot::app

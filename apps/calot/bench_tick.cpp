// Whole ticks: the standard scene and its fine version, and scenes that try to make a tick long.

#include <chrono>
#include <cmath>

#include <fmt/format.h>

#include "bench_bodies.h"
#include "bench_gpu.h"
#include "bench_suites.h"
#include "bench_tick_watch.h"
#include "calot/base/parallel.h"

namespace calot::app {

namespace {

struct TickScene {
    std::string scene, title;
    std::function<std::shared_ptr<simulation::Setup>()> make;
    int threads = 1;
    double seconds = 30.0;
    double target_p99_us = 0.0;
    double weight = 10.0;
};

void run_scene(const TickScene& scene, const BenchPlan& plan, BenchResults& results, const Jobs::Report& report) {
    const ThreadLimit limit(scene.threads);
    const auto setup = scene.make();
    if (plan.device) gpu::use_backend({plan.device, ""}, *setup);
    simulation::Simulation run(setup);
    TickResult result;
    result.scene = scene.scene;
    result.title = scene.title;
    result.threads = scene.threads;
    result.target_p99_us = scene.target_p99_us;
    result.phyxels = run.state().phyxel_present.count();
    result.hexels = run.figures().hexel_present.count();
    const auto ticks =
        static_cast<std::int64_t>(std::lround(std::min(scene.seconds, setup->duration_s) / setup->model.tick_s));
    TickWatch watch(ticks);
    for (std::int64_t tick = 0; tick < ticks; ++tick) {
        if (!watch.tick(run, setup->script.at(run.time_s()))) break;
        // Looking at the clock and at the terminal stays between ticks.
        if (tick % 64 == 0 && !report(static_cast<double>(tick) / static_cast<double>(ticks) / plan.passes)) break;
    }
    watch.begin_passes();
    result.passes = plan.passes;
    for (int pass = 1; pass < plan.passes; ++pass) {
        simulation::Simulation same(setup);
        for (std::size_t tick = 0; tick < watch.ticks(); ++tick) {
            const tissue::Input input = setup->script.at(same.time_s());
            const auto start = std::chrono::steady_clock::now();
            same.tick(input);
            watch.again(tick,
                        std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start).count());
            if (tick % 64 == 0 &&
                !report((pass + static_cast<double>(tick) / static_cast<double>(ticks)) / plan.passes))
                break;
        }
    }
    watch.finish(run, result);
    for (const std::string& notice : run.notices()) results.notes.push_back(notice);
    if (plan.device)
        results.device.costs.push_back(cost_of_ticks(setup, ticks, scene.title, report));  // with its clocks on
    if (!run.figures().status.ok)
        results.notes.push_back(fmt::format("{} stopped at tick {}: {} is not finite", scene.scene,
                                            run.figures().status.tick, run.figures().status.field));
    results.tick.push_back(std::move(result));
}

/// A furrow across the whole block in one stroke, 34 mm long: it opens behind the hook.
constexpr const char* kLongCut = R"(
[[script.key]]
t = 0.0
offset_mm = [-19, 0, 3]
[[script.key]]
t = 0.3
offset_mm = [-18, 0, -1.5]
[[script.key]]
t = 6.0
offset_mm = [17, 0, -3.5]
[[script.key]]
t = 6.4
offset_mm = [17, 0, 6]
[[script.burst]]
from = 0.3
to = 6.0
power_W = 120
)";

/// As fast as tissue can go: full power while the foot sweeps sideways.
constexpr const char* kFastBurn = R"(
[electric]
voltage_limit_V = 2000
[[script.key]]
t = 0.0
offset_mm = [0, -12, 2]
[[script.key]]
t = 0.2
offset_mm = [0, -12, -1.5]
[[script.key]]
t = 3.0
offset_mm = [0, 12, -2.5]
[[script.key]]
t = 6.0
offset_mm = [6, -12, -4]
[[script.burst]]
from = 0.2
to = 6.0
power_W = 120
)";

/// Deep and quick, cold: large contact forces, then all at once none.
constexpr const char* kPunch = R"(
[[script.key]]
t = 0.0
offset_mm = [0, 0, 4]
[[script.key]]
t = 0.5
offset_mm = [0, 0, -10]
[[script.key]]
t = 0.6
offset_mm = [0, 0, 8]
[[script.key]]
t = 1.1
offset_mm = [4, 0, -10]
[[script.key]]
t = 1.6
offset_mm = [-8, 0, -9]
[[script.key]]
t = 2.0
offset_mm = [-8, 0, 8]
)";

/// Takes hold of the surface, lifts it by half the block's height and drags it aside, until it slips or tears.
constexpr const char* kGrasp = R"(
[[script.grasper]]
t = 0.0
offset_mm = [0, 0, 6]
jaw = 1.0
[[script.grasper]]
t = 0.5
offset_mm = [0, 0, -2]
jaw = 1.0
[[script.grasper]]
t = 0.8
offset_mm = [0, 0, -2]
jaw = 0.0
[[script.grasper]]
t = 1.8
offset_mm = [0, 0, 10]
jaw = 0.0
[[script.grasper]]
t = 2.8
offset_mm = [14, 8, 8]
jaw = 0.0
[[script.key]]
t = 0.0
offset_mm = [-14, 0, 20]
)";

TickScene shipped(const std::string& file, const std::string& title, int threads, double seconds, double target_us,
                  double weight) {
    return {file,    title,   [file] { return std::make_shared<simulation::Setup>(scene::build(shipped_scene(file))); },
            threads, seconds, target_us,
            weight};
}
TickScene written(const std::string& name, const std::string& title, const char* script, double seconds) {
    return {name, title, [name, script] { return block_scene(name, script); }, 1, seconds, 0.0, seconds * 0.5};
}

}  // namespace

void add_ticks(const BenchPlan& plan, Jobs& jobs, BenchResults& results) {
    std::vector<TickScene> scenes;
    const double s = plan.simulated_s;
    constexpr double kStandard_us = 350.0, kFine_us = 1000.0;  // p99; on one core and on two
    scenes.push_back(shipped("calot.toml", "standard scene", 1, s, kStandard_us, 0.4 * s));
    if (!plan.quick && plan.threads > 1)
        scenes.push_back(shipped("calot.toml", "standard scene", plan.threads, s, 0.0, 0.3 * s));
    if (!plan.quick)
        scenes.push_back(
            shipped("calot-fine.toml", "fine scene", plan.threads, s, plan.threads == 2 ? kFine_us : 0.0, 2.0 * s));
    scenes.push_back(written("long cut", "a cut across a block in one stroke", kLongCut, std::min(s, 6.5)));
    if (!plan.quick) {
        scenes.push_back(written("fast burn", "a block burnt as fast as it goes", kFastBurn, 6.0));
        scenes.push_back(written("punch", "deep, quick pressing without current", kPunch, 2.2));
        scenes.push_back(written("grasp", "a grasp that lifts and drags tissue", kGrasp, 3.0));
    }
    for (const TickScene& scene : scenes)
        jobs.add(fmt::format("{}, {} thread{}", scene.title, scene.threads, scene.threads == 1 ? "" : "s"),
                 plan.device ? 20.0 * scene.weight : scene.weight,
                 [scene, plan, &results](const Jobs::Report& report) { run_scene(scene, plan, results, report); });
}

}  // namespace calot::app

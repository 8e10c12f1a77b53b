// The tables and figures of Pan et al. 2019, measured here, with what the paper printed beside them.

#include <array>
#include <cmath>

#include <fmt/format.h>

#include "bench_bodies.h"
#include "bench_html.h"
#include "bench_pictures.h"
#include "bench_statistics.h"
#include "bench_suites.h"
#include "calot/base/parallel.h"
#include "calot/viewer/picture.h"

namespace calot::app {

namespace {

constexpr int kPictureWidth = 480, kPictureHeight = 360;

// ---- Table 1: one step of deformation

struct Table1Row {
    std::int64_t phyxels;
    double published_ms, rival_ms;  ///< on a GTX 1050 Ti; of the implementation on a CPU that the paper compares with
};
constexpr std::array<Table1Row, 4> kTable1{
    {{1593, 1.88, 19.3}, {2447, 2.01, 45.6}, {3041, 2.62, 57.8}, {4510, 3.07, 88.4}}};

void table_1(const Table1Row& row, const BenchPlan& plan, BenchResults& results, const Jobs::Report& report) {
    const KernelResult step = measure(deformation_step(row.phyxels, 1, 0.0, true), 0.5 * plan.per_kernel_s(), report);
    const double ours_ms = 1e-3 * step.us;
    results.paper.push_back({"Table 1", step.size, "deformation step", ours_ms, row.published_ms});
    results.paper.push_back({"Table 1", step.size, "deformation step, the paper's CPU rival", ours_ms, row.rival_ms});
    results.paper.push_back(
        {"Table 1", step.size, "deformation step, our scalar reference", 1e-3 * step.reference_us, 0.0});
}

// ---- Table 2 and Fig. 15: stages while burning, and what 100 hexels leave, at four densities

struct Density {
    const char* scene;
    std::int64_t hexels;
    double published_loop_ms;  ///< of everything together, about 40 Hz
};
constexpr std::array<Density, 4> kDensities{{{"paper-3041.toml", 3'041, 0.0},
                                             {"paper-20291.toml", 20'291, 0.0},
                                             {"calot.toml", 147'233, 25.0},
                                             {"calot-fine.toml", 1'178'091, 0.0}}};
constexpr std::int64_t kBurntHexels = 100;

/// The script again and again: large hexels take long to burn.
tissue::Input looped(const simulation::Setup& setup, double time_s) {
    return setup.script.at(std::fmod(time_s, setup.duration_s));
}

/// Means over ticks with current: some stages work on every few ticks only.
void add_rows(const Density& density, std::int64_t hexels, const std::array<double, simulation::kStages>& sum_us,
              std::int64_t ticks, BenchResults& results) {
    if (ticks == 0) return;
    double all_us = 0.0;
    for (std::size_t k = 0; k < sum_us.size(); ++k) {
        const double us = sum_us[k] / static_cast<double>(ticks);
        all_us += us;
        results.paper.push_back({"Table 2", hexels, simulation::kStageNames[k], 1e-3 * us, 0.0});
    }
    results.paper.push_back({"Table 2", hexels, "whole loop", 1e-3 * all_us, density.published_loop_ms});
}

void table_2(const Density& density, const BenchPlan& plan, BenchResults& results, const Jobs::Report& report) {
    const ThreadLimit limit(plan.threads);
    const auto setup = scene_of_hexels(density.scene, density.hexels);
    simulation::Simulation run(setup);
    const std::int64_t hexels = run.state().hexel_present.count(), phyxels = run.state().phyxel_present.count();
    const double timed_s = plan.quick ? 1.6 : 6.0;
    std::array<double, simulation::kStages> sum_us{};
    std::int64_t ticks = 0;
    while (run.time_s() < timed_s) {
        const tissue::Input input = setup->script.at(run.time_s());
        if (!run.tick(input)) break;
        if (input.pedal) {
            ++ticks;
            for (std::size_t k = 0; k < sum_us.size(); ++k) sum_us[k] += static_cast<double>(run.work().stage_us[k]);
        }
        if (run.state().tick % 64 == 0 && !report(run.time_s() / timed_s)) return;
    }
    add_rows(density, hexels, sum_us, ticks, results);
    results.notes.push_back(fmt::format("Table 2: {} hexels on {} phyxels stand for the paper's {} hexels on 3,041",
                                        grouped_number(hexels), grouped_number(phyxels),
                                        grouped_number(density.hexels)));
}

/// The same until 100 hexels are gone, for the picture.
void figure_15(const Density& density, const BenchPlan& plan, BenchResults& results, const Jobs::Report& report) {
    const ThreadLimit limit(plan.threads);
    const auto setup = scene_of_hexels(density.scene, density.hexels);
    simulation::Simulation run(setup);
    const std::int64_t hexels = run.state().hexel_present.count();
    constexpr double kMost_s = 150.0;
    tissue::Input input;
    while (run.time_s() < kMost_s && run.state().hexels_burnt < kBurntHexels) {
        input = looped(*setup, run.time_s());
        if (!run.tick(input)) break;
        if (run.state().tick % 64 == 0 &&
            !report(static_cast<double>(run.state().hexels_burnt) / static_cast<double>(kBurntHexels)))
            return;
    }
    if (!run.state().status.ok)
        results.notes.push_back(fmt::format("Fig. 15: with {} hexels the run stopped at {:.2f} s: {} is not finite",
                                            grouped_number(hexels), run.time_s(), run.state().status.field));
    Camera camera(kPictureWidth, kPictureHeight);
    viewer::Picture picture(*setup);
    render::View view;
    // The hook out of the way: what is left is to be seen.
    picture.fill(run, input, view);
    view.instrument.clear();
    view.energised = false;
    view.smoke.clear();
    const double volume_mm3 = static_cast<double>(run.state().hexels_burnt) * run.model().hexel_volume_m3() * 1e9;
    camera.take(view, "Fig. 15",
                fmt::format("{} hexels; {} of them burnt ({:.2f} mm³) after {:.1f} s", grouped_number(hexels),
                            run.state().hexels_burnt, volume_mm3, run.time_s()),
                results.pictures);
    if (!camera.trouble().empty()) results.notes.push_back(camera.trouble());
}

// ---- Fig. 16: pressing and releasing

void figure_16(double depth_mm, BenchResults& results, const Jobs::Report& report) {
    const auto setup = block_scene("press", fmt::format(R"(
[[script.key]]
t = 0.0
offset_mm = [0, 0, 4]
[[script.key]]
t = 1.4
offset_mm = [0, 0, {0}]
[[script.key]]
t = 2.0
offset_mm = [0, 0, {0}]
[[script.key]]
t = 3.4
offset_mm = [0, 0, 4]
)",
                                                        0.5 - depth_mm));
    simulation::Simulation run(setup);
    PressCurve curve;
    curve.name = fmt::format("{:g} mm", depth_mm);
    while (run.time_s() < 3.4) {
        const tissue::Input input = setup->script.at(run.time_s());
        if (!run.tick(input)) break;
        if (run.state().tick % 10 != 0) continue;
        const double depth = 0.5 - input.hook.position_m.z * 1e3;  // of the wire's lower side
        curve.points.push_back({run.time_s(), depth, glm::length(run.state().hook_force_N)});
        if (!report(run.time_s() / 3.4)) return;
    }
    results.press.push_back(std::move(curve));
}

// ---- Figs. 13 and 14: the same stroke without physics

constexpr double kStroke_s = 5.3;  ///< two layers over the duct

void stroke_with_physics(BenchResults& results, const Jobs::Report& report) {
    const auto setup = std::make_shared<simulation::Setup>(scene::build(shipped_scene("calot.toml")));
    simulation::Simulation run(setup);
    tissue::Input input;
    while (run.time_s() < kStroke_s) {
        input = setup->script.at(run.time_s());
        if (!run.tick(input)) break;
        if (run.state().tick % 64 == 0 && !report(run.time_s() / kStroke_s)) return;
    }
    Camera camera(kPictureWidth, kPictureHeight);
    viewer::Picture picture(*setup);
    render::View view;
    picture.fill(run, input, view);
    camera.take(view, "Figs. 13 and 14",
                fmt::format("Calot: tissue gives way, dries, browns, and {} hexels boiled off where current flowed",
                            run.state().hexels_burnt + run.state().hexels_fallen),
                results.pictures);
}

void stroke_without_physics(const char* scene, const char* caption, BenchResults& results, const Jobs::Report& report) {
    const auto setup = std::make_shared<simulation::Setup>(scene::build(shipped_scene(scene)));
    Eraser eraser(setup);
    for (double t = 0.0; t < kStroke_s; t += setup->model.tick_s) eraser.pass(setup->script.at(t));
    if (!report(0.5)) return;
    Camera camera(kPictureWidth, kPictureHeight);
    render::View view;
    eraser.fill(view);
    camera.take(view, "Figs. 13 and 14", fmt::format(fmt::runtime(caption), eraser.removed()), results.pictures);
}

}  // namespace

void add_paper(const BenchPlan& plan, Jobs& jobs, BenchResults& results) {
    for (const Table1Row& row : kTable1)
        jobs.add(fmt::format("Table 1, {} phyxels", row.phyxels), 1.2,
                 [row, plan, &results](const Jobs::Report& report) { table_1(row, plan, results, report); });
    const std::size_t densities = plan.quick ? 2 : kDensities.size();
    for (std::size_t k = 0; k < densities; ++k) {
        const Density density = kDensities[k];
        jobs.add(fmt::format("Table 2, {} hexels", density.hexels), k < 3 ? 5.0 : 15.0,
                 [density, plan, &results](const Jobs::Report& report) { table_2(density, plan, results, report); });
    }
    for (std::size_t k = plan.quick ? 2 : 0; k < (plan.quick ? 3 : kDensities.size()); ++k) {
        const Density density = kDensities[k];
        jobs.add(fmt::format("Fig. 15, {} hexels", density.hexels), k < 3 ? 5.0 : 15.0,
                 [density, plan, &results](const Jobs::Report& report) { figure_15(density, plan, results, report); });
    }
    for (const double depth_mm : plan.quick ? std::vector<double>{5.0} : std::vector<double>{4.0, 7.0, 10.0})
        jobs.add(fmt::format("Fig. 16, {:g} mm", depth_mm), 2.0,
                 [depth_mm, &results](const Jobs::Report& report) { figure_16(depth_mm, results, report); });
    if (plan.quick) return;
    jobs.add("Figs. 13 and 14, with physics", 3.0,
             [&results](const Jobs::Report& report) { stroke_with_physics(results, report); });
    jobs.add("Figs. 13 and 14, geometric eraser", 2.0, [&results](const Jobs::Report& report) {
        stroke_without_physics("calot.toml",
                               "A geometric eraser: whatever the metal passes is gone, {} hexels; nothing else changes",
                               results, report);
    });
    jobs.add("Figs. 13 and 14, coarse carving", 2.0, [&results](const Jobs::Report& report) {
        stroke_without_physics("paper-3041.toml",
                               "Coarse volumetric carving: voxels as large as phyxels, {} of them gone", results,
                               report);
    });
}

}  // namespace calot::app

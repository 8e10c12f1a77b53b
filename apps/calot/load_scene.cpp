#include <cstdio>
#include <filesystem>

#include <fmt/format.h>

#include "calot/anatomy/mesh_shape.h"
#include "calot/base/error.h"
#include "commands.h"

namespace calot::app {

namespace {

/// Draws the faults of a refused mesh into the working directory. Returns the picture's name, "" without.
std::string draw_faults(const anatomy::MeshReport& report) {
    if (!report.mesh || report.places.empty()) return "";
    const std::string name = std::filesystem::path(report.path).stem().string() + "-faults.png";
    try {
        anatomy::write_fault_picture(name, report);
    } catch (const InputError&) {
        return "";  // nowhere to write: the message alone must do
    }
    return name;
}

}  // namespace

scene::Scene load_scene(const SceneChoice& choice) {
    scene::Scene scene = scene::load(choice.path);
    for (const std::string& assignment : choice.assignments) scene::override_value(scene, assignment);
    if (choice.duration_s) scene.duration_s = *choice.duration_s;
    if (choice.seed) scene.seed = *choice.seed;
    scene::check(scene);
    for (const scene::Warning& warning : scene.warnings)
        fmt::print(stderr, "calot: warning: {}:{}:{}: {}\n", warning.place.file, warning.place.line,
                   warning.place.column, warning.text);
    return scene;
}

simulation::Setup build_setup(const scene::Scene& scene) {
    std::vector<anatomy::MeshReport> reports;
    try {
        simulation::Setup setup = scene::build(scene, &reports);
        for (const anatomy::MeshReport& report : reports)
            for (const std::string& note : report.notes) fmt::print(stderr, "calot: note: {}: {}\n", report.path, note);
        return setup;
    } catch (const InputError& error) {
        const bool of_mesh = !reports.empty() && std::string(error.what()).rfind("mesh " + reports.back().path, 0) == 0;
        const std::string picture = of_mesh ? draw_faults(reports.back()) : "";
        if (picture.empty()) throw;
        throw InputError(error.file, error.line, error.column, error.what(),
                         fmt::format("{}{}{} shows where", error.hint, error.hint.empty() ? "" : "; ", picture));
    }
}

void use_backend(const gpu::BackendWish& wish, simulation::Setup& setup) {
    if (wish.kind == gpu::BackendKind::cpu) return;
    const gpu::BackendChoice choice = gpu::choose_backend(wish, gpu::devices(), setup.model.hexel_initial.count());
    gpu::use_backend(choice, setup);
    setup.tell = [](const std::string& notice) { fmt::print(stderr, "calot: note: {}\n", notice); };
    fmt::print(stderr, "calot: backend: {}\n", choice.why);
}

}  // namespace calot::app

// From a scene to what a simulation starts from.

#include <cmath>

#include <fmt/format.h>

#include "calot/scene/keys.h"
#include "calot/scene/problems.h"
#include "calot/scene/suggest.h"

namespace calot::scene {

namespace {

/// Position of an anchor, or a problem that lists this patient's landmarks.
Vec3 locate(const Anchor& anchor, const anatomy::Anatomy& anatomy, const std::string& what, const Scene& scene,
            Problems& problems) {
    if (anchor.landmark.empty()) return anchor.offset_m;
    const auto found = anatomy.landmarks_m.find(anchor.landmark);
    if (found != anatomy.landmarks_m.end()) return found->second + anchor.offset_m;
    std::vector<std::string> names;
    for (const auto& [name, position] : anatomy.landmarks_m) names.push_back(name);
    const std::string near = closest(anchor.landmark, names);
    const Place place = anchor.place.line > 0 ? anchor.place : Place{scene.file, 0, 0};
    problems.add(place, fmt::format("{} names the unknown landmark \"{}\"", what, anchor.landmark),
                 (near.empty() ? "" : fmt::format("did you mean \"{}\"? ", near)) + "this anatomy has " + join(names));
    return Vec3(0.0);
}

/// Refuses lattices that would fill the machine, before anything is reserved.
void check_memory(const Scene& scene, const anatomy::Anatomy& anatomy) {
    Box box{Vec3(1e9), Vec3(-1e9)};
    for (const auto& tissue : anatomy.tissues) {
        const Box bounds = tissue.shape->bounds_m();
        box.low = glm::min(box.low, glm::max(bounds.low, anatomy.field.low));
        box.high = glm::max(box.high, glm::min(bounds.high, anatomy.field.high));
    }
    const double spacing = scene.sampling.hexel_spacing_m * scene.sampling.hexels_per_edge;
    const Vec3 cells = glm::max(glm::ceil((box.high - box.low) / spacing), Vec3(0.0)) + 3.0;
    const double phyxels = cells.x * cells.y * cells.z;
    const double hexels = phyxels * std::pow(scene.sampling.hexels_per_edge, 3);
    const double bytes =
        hexels < 1e15
            ? static_cast<double>(memory_bytes(static_cast<std::int64_t>(hexels), static_cast<std::int64_t>(phyxels)))
            : 1e18;
    if (bytes > scene.max_memory_GB * 1e9)
        throw InputError(
            scene.file, 0, 0,
            fmt::format(
                "the scene would divide {:.3g} x {:.3g} x {:.3g} mm into {:.3g} hexels and take about {:.3g} GB",
                (box.high.x - box.low.x) * 1e3, (box.high.y - box.low.y) * 1e3, (box.high.z - box.low.z) * 1e3, hexels,
                bytes / 1e9),
            fmt::format("make sampling.hexel_spacing_mm larger than {:g}, or raise run.max_memory_GB above {:g}",
                        scene.sampling.hexel_spacing_m * 1e3, scene.max_memory_GB));
}

void set_parameters(const Scene& scene, tissue::Model& model) {
    model.deformation = scene.deformation;
    model.electric = scene.electric;
    model.thermal = scene.thermal;
    model.contact = scene.contact;
    tissue::prepare_time_step(model);
    if (model.deformation.substeps > 1000)
        throw InputError(
            scene.file, 0, 0,
            fmt::format("the softest tissue needs {} time steps a millisecond", model.deformation.substeps),
            "use a larger sampling.hexel_spacing_mm, or softer or heavier materials");
}

}  // namespace

std::int64_t memory_bytes(std::int64_t hexel_cells, std::int64_t phyxel_cells) {
    return 64 * hexel_cells + 400 * phyxel_cells;
}

simulation::Setup build(const Scene& scene, std::vector<anatomy::MeshReport>* reports) {
    check(scene);
    simulation::Setup setup;
    setup.name = scene.name;
    setup.scene_text = text(scene);
    setup.seed = scene.seed;
    setup.duration_s = scene.duration_s;
    setup.hook = scene.hook;
    setup.smoke = scene.smoke;
    setup.anatomy = build_anatomy(scene, reports);
    check_memory(scene, setup.anatomy);

    Problems problems;
    const Vec3 trocar_m = locate(scene.trocar, setup.anatomy, "[hook] trocar", scene, problems);
    setup.camera.eye_m = locate(scene.camera_eye, setup.anatomy, "[camera] eye", scene, problems);
    setup.camera.target_m = locate(scene.camera_target, setup.anatomy, "[camera] target", scene, problems);
    setup.camera.field_of_view_deg = scene.field_of_view_deg;
    const Vec3 return_m = scene.electric.return_placed
                              ? locate(scene.return_electrode, setup.anatomy, "[electric] return_at", scene, problems)
                              : Vec3(0.0);
    std::vector<simulation::Keyframe> keyframes;
    for (const ScriptKey& key : scene.script) {
        const Vec3 tip_m = locate(key.tip, setup.anatomy, "the script", scene, problems);
        if (glm::distance(tip_m, trocar_m) < 0.02)
            problems.add(key.tip.place, fmt::format("at {:g} s the hook is within 20 mm of its trocar", key.time_s),
                         "move the key, or [hook] trocar_offset_mm");
        keyframes.push_back({key.time_s, tip_m, key.roll_rad});
    }
    problems.throw_if_any();
    std::vector<simulation::Burst> bursts;
    for (const ScriptBurst& entry : scene.bursts) bursts.push_back(entry.burst);
    setup.script = simulation::Script(trocar_m, std::move(keyframes), std::move(bursts));

    try {
        setup.model = tissue::sample(setup.anatomy, scene.sampling, scene.materials);
    } catch (const InputError& error) {
        throw InputError(error.file.empty() ? scene.file : error.file, error.line, error.column, error.what(),
                         error.hint);
    }
    set_parameters(scene, setup.model);
    setup.model.electric.return_m = return_m;
    return setup;
}

}  // namespace calot::scene

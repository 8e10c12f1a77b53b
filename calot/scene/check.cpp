// What no single key can say.

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

#include "calot/scene/problems.h"
#include "calot/scene/suggest.h"

namespace calot::scene {

namespace {

template <class Keys>
void check_times(const Keys& keys, const char* what, Problems& problems) {
    for (std::size_t k = 1; k < keys.size(); ++k) {
        const double before_s = keys[k - 1].time_s, time_s = keys[k].time_s;
        if (!(time_s > before_s))
            problems.add(keys[k].tip.place,
                         fmt::format("{} at {:g} s comes after the one at {:g} s", what, time_s, before_s),
                         "times must increase from key to key");
        else if (time_s - before_s < 1e-3)
            problems.add(keys[k].tip.place, fmt::format("{}s less than a tick (0.001 s) apart", what), "leave one out");
    }
}

void check_script(const Scene& scene, Problems& problems) {
    const Place whole{scene.file, 0, 0};
    if (scene.script.empty())
        problems.add(whole, "the script has no [[script.key]]", "give at least one, so that the hook is somewhere");
    check_times(scene.script, "script key", problems);
    check_times(scene.grasper_script, "grasper key", problems);
    std::vector<std::size_t> order(scene.bursts.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return scene.bursts[a].burst.from_s < scene.bursts[b].burst.from_s;
    });
    for (std::size_t k = 0; k < order.size(); ++k) {
        const ScriptBurst& entry = scene.bursts[order[k]];
        if (!(entry.burst.to_s > entry.burst.from_s))
            problems.add(entry.place, fmt::format("burst from {:g} s to {:g} s", entry.burst.from_s, entry.burst.to_s),
                         "a burst must end after it begins");
        if (k > 0 && entry.burst.from_s < scene.bursts[order[k - 1]].burst.to_s)
            problems.add(entry.place,
                         fmt::format("burst from {:g} s begins before the one from {:g} s has ended",
                                     entry.burst.from_s, scene.bursts[order[k - 1]].burst.from_s),
                         "one foot, one pedal: bursts must not overlap");
    }
}

void check_material(const Scene& scene, const std::string& material, const Place& place, Problems& problems) {
    if (tissue::find_material(scene.materials, material) != tissue::kNoMaterial) return;
    std::vector<std::string> names;
    for (std::size_t k = 1; k < scene.materials.size(); ++k) names.push_back(scene.materials[k].name);
    const std::string near = closest(material, names);
    problems.add(place, fmt::format("unknown material \"{}\"", material),
                 near.empty() ? "materials: " + join(names) : fmt::format("did you mean \"{}\"?", near));
}

void check_anatomy(const Scene& scene, Problems& problems) {
    const Place whole{scene.file, 0, 0};
    const double hexel = scene.sampling.hexel_spacing_m;
    if (scene.kind == AnatomyKind::block) {
        check_material(scene, scene.block.material, whole, problems);
        const Vec3& size = scene.block.size_m;
        if (std::min({size.x, size.y, size.z}) < hexel)
            problems.add(whole,
                         fmt::format("the block ({:g} x {:g} x {:g} mm) is thinner than a hexel ({:g} mm)",
                                     size.x * 1e3, size.y * 1e3, size.z * 1e3, hexel * 1e3),
                         "make it larger, or sampling.hexel_spacing_mm smaller");
    }
    if (scene.kind == AnatomyKind::meshes) {
        bool tissue = false;
        for (const MeshEntry& mesh : scene.meshes) {
            tissue |= mesh.role == "tissue";
            if (mesh.file.empty()) problems.add(mesh.place, "the mesh has no file", "give its path in quotes");
            check_material(scene, mesh.material, mesh.place, problems);
        }
        if (!tissue)
            problems.add(whole, "anatomy.kind is \"meshes\", but no [[mesh]] has the role \"tissue\"",
                         "add one: file = \"organ.stl\"");
    } else if (!scene.meshes.empty()) {
        problems.add(scene.meshes.front().place, "there is a [[mesh]], but anatomy.kind is not \"meshes\"",
                     "set kind = \"meshes\" in [anatomy], or leave the mesh out");
    }
}

}  // namespace

void check(const Scene& scene) {
    Problems problems;
    const Place whole{scene.file, 0, 0};
    const int m = scene.sampling.hexels_per_edge;
    if (m != 1 && m != 2 && m != 4)
        problems.add(whole, fmt::format("sampling.hexels_per_edge is {}", m), "use 1, 2 or 4");
    if (tissue::Model::frame_ticks % scene.thermal.refresh_ticks != 0)
        problems.add(whole, fmt::format("thermal.refresh_ticks is {}", scene.thermal.refresh_ticks),
                     "use 1, 2, 4 or 8");
    if (scene.hook.insulated_heel_m > scene.hook.heel_length_m)
        problems.add(whole, "hook.insulated_heel_mm is longer than the heel", "at most hook.heel_length_mm");
    if (scene.hook.wire_diameter_m > scene.hook.shaft_diameter_m)
        problems.add(whole, "hook.wire_diameter_mm is larger than the shaft's", "at most hook.shaft_diameter_mm");
    if (scene.picture.width % 2 || scene.picture.height % 2)
        problems.add(whole, fmt::format("a picture of {} x {} pixels", scene.picture.width, scene.picture.height),
                     "width and height must be even, for video");
    check_anatomy(scene, problems);
    check_script(scene, problems);
    problems.throw_if_any();
}

}  // namespace calot::scene

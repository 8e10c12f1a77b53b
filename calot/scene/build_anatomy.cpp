// From a scene to its anatomy.

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include "calot/anatomy/cached.h"
#include "calot/anatomy/mesh_shape.h"
#include "calot/base/error.h"
#include "calot/scene/mesh_file.h"
#include "calot/scene/scene.h"

namespace calot::scene {

namespace {

/// Rigid organs are asked for distances in every tick, so they are sampled once.
constexpr double kOrganSpacing_m = 0.6e-3;

[[noreturn]] void fail(const MeshEntry& entry, const std::string& message, const std::string& hint) {
    throw InputError(entry.place.file, entry.place.line, entry.place.column, message, hint);
}

anatomy::ShapePtr load(const MeshEntry& entry, std::vector<anatomy::MeshReport>& reports) {
    if (!entry.content.empty() && entry.content != content_of_file(entry.file))
        fail(entry, fmt::format("the mesh {} is not the one that this scene was made with", entry.file),
             "put the old file back, or leave 'content' out");
    reports.emplace_back();
    try {
        return anatomy::load_mesh({entry.file, entry.unit_m, 1.0, entry.rotation_rad, entry.translation_m},
                                  &reports.back());
    } catch (const InputError& error) {
        const std::string line = error.line > 0 ? fmt::format(":{}", error.line) : std::string();
        fail(entry, fmt::format("mesh {}{}: {}", error.file, line, error.what()), error.hint);
    }
}

/// The foremost point of the tissue over the middle of its box: where an instrument comes from.
Vec3 top_of(const anatomy::Anatomy& anatomy) {
    const Box& field = anatomy.field;
    const Vec3 middle = 0.5 * (field.low + field.high);
    const double step = 1e-4;
    for (double z = field.high.z; z > field.low.z; z -= step)
        for (const auto& tissue : anatomy.tissues)
            if (tissue.shape->distance_m(Vec3(middle.x, middle.y, z)) < 0.0) return Vec3(middle.x, middle.y, z);
    return Vec3(middle.x, middle.y, field.high.z);
}

/// A coarse bound of the time that `top_of` takes is the field's height; absurd sizes are refused first.
void check_size(const Scene& scene, const Box& field) {
    const Vec3 size = field.high - field.low;
    const double largest = std::max({size.x, size.y, size.z});
    if (largest > 1.0)
        throw InputError(scene.file, 0, 0, fmt::format("the tissue of the meshes is {:.3g} m large", largest),
                         "check unit_mm: 1 for millimetres, 1000 for metres");
    if (largest < 1e-3)
        throw InputError(scene.file, 0, 0,
                         fmt::format("the tissue of the meshes is only {:.3g} mm large", largest * 1e3),
                         "check unit_mm: 1 for millimetres, 1000 for metres");
}

anatomy::Anatomy make_meshes(const Scene& scene, std::vector<anatomy::MeshReport>& reports) {
    anatomy::Anatomy anatomy;
    anatomy.field = Box{Vec3(1e9), Vec3(-1e9)};
    for (const MeshEntry& entry : scene.meshes) {
        const std::string name = entry.name.empty() ? std::filesystem::path(entry.file).stem().string() : entry.name;
        const anatomy::ShapePtr shape = load(entry, reports);
        const Box bounds = shape->bounds_m();
        anatomy.landmarks_m[name] = 0.5 * (bounds.low + bounds.high);
        anatomy.facts[name + "_volume_ml"] = reports.back().volume_m3 * 1e6;
        if (entry.role == "tissue") {
            anatomy.tissues.push_back({name, entry.material, shape});
            anatomy.field.low = glm::min(anatomy.field.low, bounds.low);
            anatomy.field.high = glm::max(anatomy.field.high, bounds.high);
        } else {
            check_size(scene, bounds);
            anatomy.organs.push_back(
                {name, entry.material, entry.role == "organ", anatomy::make_cached(shape, kOrganSpacing_m)});
        }
    }
    check_size(scene, anatomy.field);
    anatomy.landmarks_m["centre"] = 0.5 * (anatomy.field.low + anatomy.field.high);
    anatomy.landmarks_m["top"] = top_of(anatomy);
    anatomy.landmarks_m["trocar"] = anatomy.landmarks_m["top"] + Vec3(0.0, -0.08, 0.14);
    return anatomy;
}

}  // namespace

anatomy::Anatomy build_anatomy(const Scene& scene, std::vector<anatomy::MeshReport>* reports) {
    switch (scene.kind) {
        case AnatomyKind::block:
            return anatomy::make_block(scene.block);
        case AnatomyKind::calots_triangle: {
            anatomy::TriangleParameters parameters = scene.triangle;
            parameters.seed = scene.seed;
            return anatomy::make_calots_triangle(parameters);
        }
        case AnatomyKind::meshes:
            break;
    }
    std::vector<anatomy::MeshReport> own;
    return make_meshes(scene, reports ? *reports : own);
}

}  // namespace calot::scene

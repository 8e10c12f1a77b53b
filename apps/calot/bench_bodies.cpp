#include "bench_bodies.h"

#include <cmath>
#include <filesystem>

#include <fmt/format.h>

#include "calot/anatomy/shapes.h"
#include "calot/base/error.h"
#include "calot/tissue/sampling.h"

namespace calot::app {

anatomy::Anatomy exact_block(std::int64_t cells, double cell_m, double height) {
    const auto width =
        static_cast<std::int64_t>(std::max(1.0, std::round(std::cbrt(static_cast<double>(cells) / height))));
    const std::int64_t layers = cells / (width * width), rows = cells % (width * width) / width, rest = cells % width;
    auto box = [&](std::int64_t x, std::int64_t y, std::int64_t z, std::int64_t x1, std::int64_t y1, std::int64_t z1) {
        return anatomy::make_box(cell_m * Vec3(x, y, z), cell_m * Vec3(x1, y1, z1));
    };
    std::vector<anatomy::ShapePtr> parts;
    if (layers > 0) parts.push_back(box(0, 0, 0, width, width, layers));
    if (rows > 0) parts.push_back(box(0, 0, layers, width, rows, layers + 1));
    if (rest > 0) parts.push_back(box(0, rows, layers, rest, rows + 1, layers + 1));
    const auto whole = anatomy::make_union(std::move(parts));
    // Bounds in whole phyxels keep the lattice aligned with the face that is held.
    const auto round_up = [](std::int64_t n) { return static_cast<double>((n + 3) / 4 * 4); };
    const Box bounds{Vec3(0.0), cell_m * Vec3(round_up(width), round_up(width), round_up(layers + 1))};
    anatomy::Anatomy anatomy;
    anatomy.tissues.push_back(
        {"block", "fat", anatomy::make_shape([whole](const Vec3& p) { return whole->distance_m(p); }, bounds)});
    const double thick = 0.02;
    anatomy.organs.push_back(
        {"slab", "liver", true,
         anatomy::make_box(Vec3(-thick), Vec3(bounds.high.x + thick, bounds.high.y + thick, 0.0))});
    anatomy.field = bounds;
    return anatomy;
}

tissue::Model phyxel_block(std::int64_t phyxels) {
    return tissue::sample(exact_block(phyxels, 2.4e-3), {.hexel_spacing_m = 0.6e-3, .hexels_per_edge = 4});
}

tissue::Model hexel_block(std::int64_t hexels) {
    return tissue::sample(exact_block(hexels, 0.6e-3, 0.5625), {.hexel_spacing_m = 0.6e-3, .hexels_per_edge = 4});
}

scene::Scene shipped_scene(const std::string& name) {
    namespace fs = std::filesystem;
    for (const fs::path& directory : {fs::path("scenes"), fs::path(CALOT_SCENES)})
        if (fs::exists(directory / name)) return scene::load((directory / name).string());
    throw InputError(fmt::format("the scene {} is neither in scenes/ nor in {}", name, CALOT_SCENES),
                     "run calot bench from Calot's own directory");
}

std::shared_ptr<simulation::Setup> scene_of_hexels(const std::string& name, std::int64_t hexels) {
    scene::Scene scene = shipped_scene(name);
    std::shared_ptr<simulation::Setup> best;
    std::int64_t best_error = 0;
    // The count falls with the cube of the spacing, nearly.
    for (int attempt = 0; attempt < 6; ++attempt) {
        auto setup = std::make_shared<simulation::Setup>(scene::build(scene));
        const std::int64_t count = setup->model.hexel_initial.count(), error = std::abs(count - hexels);
        if (!best || error < best_error) best = setup, best_error = error;
        if (1000 * error <= hexels) break;
        scene.sampling.hexel_spacing_m *= std::cbrt(static_cast<double>(count) / static_cast<double>(hexels));
    }
    return best;
}

std::shared_ptr<simulation::Setup> block_scene(const std::string& name, const std::string& script) {
    const std::string text = fmt::format(R"(
[scene]
name = "{}"
[anatomy]
kind = "block"
[block]
size_mm = [38.4, 38.4, 21.6]
[run]
duration_s = 60.0
{}
)",
                                         name, script);
    return std::make_shared<simulation::Setup>(scene::build(scene::parse(text, name, ".")));
}

}  // namespace calot::app

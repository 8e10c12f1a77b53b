#include "bench_pictures.h"

#include <cstdio>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>
#include <unistd.h>

#include "bench_base64.h"
#include "calot/instruments/hook.h"
#include "calot/render/scene_view.h"

namespace calot::app {

Camera::Camera(int width, int height) {
    try {
        context_ = std::make_unique<render::OffscreenContext>();
        renderer_ = std::make_unique<render::Renderer>(width, height, render::Quality::medium);
    } catch (const std::exception& error) {
        trouble_ = fmt::format("no pictures: {}", error.what());
        renderer_.reset();
    }
}

void Camera::take(render::View& view, const std::string& figure, const std::string& caption,
                  std::vector<Picture64>& pictures) {
    if (!renderer_) return;
    // Closer than the surgeon's eye, as the pictures are small.
    constexpr double kCloser = 0.6;
    view.camera.eye_m = view.camera.target_m + kCloser * (view.camera.eye_m - view.camera.target_m);
    renderer_->draw(view);
    const std::filesystem::path file =
        std::filesystem::temp_directory_path() / fmt::format("calot-bench-{}.png", ::getpid());
    render::write_png(file.string(), renderer_->read());
    std::ifstream stream(file, std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
    std::filesystem::remove(file);
    pictures.push_back({figure, caption, base64(bytes)});
}

Eraser::Eraser(std::shared_ptr<const simulation::Setup> setup)
    : setup_(std::move(setup)),
      state_(tissue::State::make(setup_->model)),
      surface_(setup_->model),
      organs_(render::organ_meshes(setup_->model)) {
    capsules_.reserve(8);
}

void Eraser::pass(const tissue::Input& input) {
    const tissue::Model& model = setup_->model;
    instruments::place_hook(setup_->hook, input.hook, input.hook, model.tick_s, capsules_);
    for (const tissue::Capsule& capsule : capsules_) {
        if (!capsule.bare) continue;
        const Vec3 low = glm::min(capsule.a_m, capsule.b_m) - capsule.radius_m,
                   high = glm::max(capsule.a_m, capsule.b_m) + capsule.radius_m;
        const Int3 first = glm::max(model.hexels.cell_at(low), Int3(0)),
                   last = glm::min(model.hexels.cell_at(high), model.hexels.size - 1);
        const Vec3 axis = capsule.b_m - capsule.a_m;
        for (int z = first.z; z <= last.z; ++z)
            for (int y = first.y; y <= last.y; ++y)
                for (int x = first.x; x <= last.x; ++x) {
                    const std::int64_t hexel = model.hexels.index(x, y, z);
                    if (!state_.hexel_present.test(hexel)) continue;
                    // A voxel is touched when the metal reaches into its box.
                    const Vec3 centre = model.hexels.centre_m(hexel);
                    const double along = glm::clamp(
                        glm::dot(centre - capsule.a_m, axis) / std::max(glm::dot(axis, axis), 1e-30), 0.0, 1.0);
                    const Vec3 away = glm::max(
                        glm::abs(capsule.a_m + along * axis - centre) - 0.5 * model.hexels.spacing_m, Vec3(0.0));
                    if (glm::length(away) > capsule.radius_m) continue;
                    state_.hexel_present.clear(hexel);
                    ++removed_;
                }
    }
    time_s_ += model.tick_s;
}

void Eraser::fill(render::View& view) {
    surface_.rebuild(setup_->model, state_);
    const surface::Mesh& mesh = surface_.smooth_mesh();
    view.camera.eye_m = setup_->camera.eye_m;
    view.camera.target_m = setup_->camera.target_m;
    view.camera.field_of_view_deg = setup_->camera.field_of_view_deg;
    view.time_s = time_s_;
    render::fill_tissue(setup_->model, state_, {},
                        {mesh.position_m, mesh.normal, surface_.owner(), mesh.position_m, {}}, view.tissue);
    view.tissue_index = mesh.index;
    ++view.tissue_index_version;
    view.organs = &organs_;
    view.instrument = capsules_;
}

}  // namespace calot::app

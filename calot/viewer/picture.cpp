#include "calot/viewer/picture.h"

#include <algorithm>

#include "calot/render/scene_view.h"

namespace calot::viewer {

Picture::Picture(const simulation::Setup& setup) : organs_(render::organ_meshes(setup.model)) {
    camera_.eye_m = setup.camera.eye_m;
    camera_.target_m = setup.camera.target_m;
    camera_.field_of_view_deg = setup.camera.field_of_view_deg;
}

void Picture::fill(const simulation::Simulation& run, const tissue::Input& input, render::View& view) {
    begin(run, input, view);
    go_on(run, rest_m_.size(), view);
}

void Picture::begin(const simulation::Simulation& run, const tissue::Input& input, render::View& view) {
    const surface::Mesh& mesh = run.surface().smooth_mesh();
    run.world_surface(world_);
    rest_m_ = mesh.position_m;
    rest_normal_ = mesh.normal;
    owner_.assign(run.surface().owner().begin(), run.surface().owner().end());
    view.tissue.resize(rest_m_.size());
    done_ = 0;
    view.camera = camera_;
    view.time_s = run.time_s();
    if (view.tissue_index_version != run.surface().version() || view.tissue_index.empty()) {
        view.tissue_index = mesh.index;
        view.tissue_index_version = run.surface().version();
    }
    view.organs = &organs_;
    view.instrument = run.capsules();
    view.energised = input.pedal;
    view.smoke = run.smoke().particles();
    view.drops = run.bleeding().drops();
}

bool Picture::go_on(const simulation::Simulation& run, std::size_t count, render::View& view) {
    const std::size_t end = std::min(rest_m_.size(), done_ + count);
    render::fill_tissue(
        run.model(), run.state(), run.work().thermal.temperature_K,
        {rest_m_, rest_normal_, owner_, world_.position_m, world_.deformation_gradient, run.bleeding().film_m()},
        done_, end, view.tissue);
    done_ = end;
    return done_ == rest_m_.size();
}

}  // namespace calot::viewer

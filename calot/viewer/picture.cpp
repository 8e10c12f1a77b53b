#include "calot/viewer/picture.h"

#include "calot/render/scene_view.h"

namespace calot::viewer {

Picture::Picture(const simulation::Setup& setup) : organs_(render::organ_meshes(setup.model)) {
    camera_.eye_m = setup.camera.eye_m;
    camera_.target_m = setup.camera.target_m;
    camera_.field_of_view_deg = setup.camera.field_of_view_deg;
}

void Picture::fill(const simulation::Simulation& run, const tissue::Input& input, render::View& view) {
    const surface::Mesh& mesh = run.surface().smooth_mesh();
    run.world_surface(world_);
    view.camera = camera_;
    view.time_s = run.time_s();
    render::fill_tissue(run.model(), run.state(), run.work().thermal.temperature_K,
                        {mesh.position_m, mesh.normal, run.surface().owner(), world_.position_m,
                         world_.deformation_gradient, run.work().bleeding.film_m()},
                        view.tissue);
    if (view.tissue_index_version != run.surface().version() || view.tissue_index.empty()) {
        view.tissue_index = mesh.index;
        view.tissue_index_version = run.surface().version();
    }
    view.organs = &organs_;
    view.instrument = run.capsules();
    view.energised = input.pedal;
    view.smoke = run.work().smoke.particles();
    view.drops = run.work().bleeding.drops();
}

}  // namespace calot::viewer

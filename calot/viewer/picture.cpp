#include "calot/viewer/picture.h"

#include <algorithm>

#include "calot/base/array.h"
#include "calot/render/scene_view.h"

namespace calot::viewer {

void Placer::place(Moment& moment, render::View& view) {
    if (moment.placed) return;
    moment.placed = true;
    const tissue::Model& model = *moment.model;
    const bool stays = moment.surface_version == surface_version_;
    if (!stays) {
        moment.rest.index.swap(view.tissue_index);
        surface::smooth(moment.rest, static_cast<float>(model.hexels.spacing_m), {}, smooth_, smoothing_);
        moment.rest.index.swap(view.tissue_index);
    }
    const std::size_t count = smooth_.position_m.size();
    world_.position_m.resize(count);
    world_.deformation_gradient.resize(count);
    // While the surface changes from picture to picture, keeping weights does not pay.
    if (!stays || moment.pose.links_severed != links_severed_) {
        surface_version_ = moment.surface_version;
        links_severed_ = moment.pose.links_severed;
        kept_ = false;
        deformation::embed_points(model, moment.pose, smooth_.position_m, moment.owner, world_.position_m,
                                  world_.deformation_gradient);
    } else {
        if (!kept_) points_.rebuild(model, moment.pose, smooth_.position_m, moment.owner);
        kept_ = true;
        points_.move(model, moment.pose, world_.position_m, world_.deformation_gradient);
    }
    render::place_tissue(smooth_.position_m, smooth_.normal, world_.position_m, world_.deformation_gradient,
                         view.tissue);
}

Picture::Picture(const simulation::Setup& setup) : organs_(render::organ_meshes(setup.model)) {
    camera_.eye_m = setup.camera.eye_m;
    camera_.target_m = setup.camera.target_m;
    camera_.field_of_view_deg = setup.camera.field_of_view_deg;
}

void Picture::fill(const simulation::Simulation& run, const tissue::Input& input, render::View& view) {
    begin(run, input, moment_, view);
    go_on(run, view.tissue.size(), moment_, view);
    placer_.place(moment_, view);
}

void Picture::begin(const simulation::Simulation& run, const tissue::Input& input, Moment& moment, render::View& view) {
    const surface::Surface& surface = run.surface();
    const bool stays = view.tissue_index_version == surface.version() && moment.surface_version == surface.version();
    moment.model = &run.model();
    moment.placed = run.moves_surface_itself();
    if (moment.placed) {  // a device has the displacements
        const surface::Mesh& mesh = surface.smooth_mesh();
        run.world_surface(world_);
        moment.rest.position_m = mesh.position_m;
        moment.rest.normal = mesh.normal;
        moment.owner = surface.owner();
        if (!stays) view.tissue_index = mesh.index;
    } else {
        if (!stays) {
            surface.copy_rest_mesh(moment.rest, moment.owner);
            moment.rest.index.swap(view.tissue_index);
        }
        moment.pose.copy(run.state(), run.work().deformation);
    }
    moment.surface_version = view.tissue_index_version = surface.version();
    resize_with_room(view.tissue, moment.owner.size());
    done_ = 0;
    view.camera = camera_;
    view.time_s = run.time_s();
    view.organs = &organs_;
    view.instrument = run.capsules();
    view.energised = input.pedal;
    view.smoke = run.smoke().particles();
    view.drops = run.bleeding().drops();
}

bool Picture::go_on(const simulation::Simulation& run, std::size_t count, const Moment& moment, render::View& view) {
    const std::size_t end = std::min(moment.owner.size(), done_ + count);
    render::SurfaceVertices vertices{
        moment.rest.position_m, moment.rest.normal, moment.owner, moment.rest.position_m, {}, run.bleeding().film_m()};
    if (moment.placed) {
        vertices.world_m = world_.position_m;
        vertices.deformation_gradient = world_.deformation_gradient;
    }
    render::fill_tissue(run.model(), run.state(), run.work().thermal.temperature_K, vertices, done_, end, view.tissue);
    done_ = end;
    return done_ == moment.owner.size();
}

}  // namespace calot::viewer

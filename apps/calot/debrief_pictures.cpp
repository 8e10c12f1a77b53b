#include "debrief_pictures.h"

#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

#include "calot/render/scene_view.h"
#include "calot/surface/surface.h"

namespace calot::app {

namespace {

constexpr int kFrameQuality = 78, kMapQuality = 88;
/// The second angle: round the field by so much, from the patient's left and a little from below.
constexpr double kAround_deg = 50.0, kDown_deg = 12.0;

render::Camera from_the_side(const render::Camera& front) {
    render::Camera side = front;
    const Vec3 away = front.eye_m - front.target_m;
    const glm::dmat4 turn = glm::rotate(glm::dmat4(1.0), glm::radians(kAround_deg), Vec3(0.0, 1.0, 0.0)) *
                            glm::rotate(glm::dmat4(1.0), glm::radians(kDown_deg), Vec3(1.0, 0.0, 0.0));
    side.eye_m = front.target_m + Vec3(turn * glm::dvec4(away, 0.0));
    return side;
}

}  // namespace

DebriefPictures::DebriefPictures(const simulation::Setup& setup, int width, int height)
    : renderer_(width, height, render::Quality::medium), picture_(setup) {
    front_.eye_m = setup.camera.eye_m;
    front_.target_m = setup.camera.target_m;
    front_.field_of_view_deg = setup.camera.field_of_view_deg;
    side_ = from_the_side(front_);
}

std::string DebriefPictures::draw(const render::View& view, int quality) {
    renderer_.draw(view);
    return render::jpeg(renderer_.read(), quality);
}

DebriefFrame DebriefPictures::frame(const simulation::Simulation& run, const tissue::Input& input) {
    DebriefFrame frame;
    frame.time_s = run.time_s();
    picture_.fill(run, input, view_);
    view_.smoke.clear();  // a replay is there to see
    view_.camera = front_;
    frame.front = draw(view_, kFrameQuality);
    view_.camera = side_;
    frame.side = draw(view_, kFrameQuality);
    return frame;
}

/// Duct and artery as they were at the start, coloured by what became of them: burnt hexels count as injured.
void DebriefPictures::fill_bare(const simulation::Simulation& run, render::View& view) {
    const tissue::Model& model = run.model();
    tissue::State bare = tissue::State::make(model);
    bare.peak_temperature_K = run.state().peak_temperature_K;
    bare.damage = run.state().damage;
    const tissue::MaterialIndex duct = tissue::find_material(model.materials, "cystic_duct"),
                                artery = tissue::find_material(model.materials, "cystic_artery");
    for (std::int64_t h = model.hexels.first; h < model.hexels.last; ++h) {
        const auto cell = static_cast<std::size_t>(h);
        const tissue::MaterialIndex material = model.hexel_material[cell];
        const bool kept = material != tissue::kNoMaterial && (material == duct || material == artery);
        if (bare.hexel_present.test(h) && !kept) bare.hexel_present.clear(h);
        if (kept && !run.state().hexel_present.test(h)) bare.damage[cell] = 20.0f;
    }
    surface::Surface surface(model);
    surface.rebuild(model, bare);
    const surface::Mesh& mesh = surface.smooth_mesh();
    render::fill_tissue(model, bare, {}, {mesh.position_m, mesh.normal, surface.owner(), mesh.position_m, {}},
                        view.tissue);
    view.tissue_index = mesh.index;
    view.tissue_index_version = 0;  // uploaded anew
}

std::vector<DebriefMap> DebriefPictures::maps(const simulation::Simulation& run) {
    const bool vessels = tissue::find_material(run.model().materials, "cystic_duct") != tissue::kNoMaterial;
    std::vector<DebriefMap> maps;
    render::View view;
    tissue::Input idle;
    picture_.fill(run, idle, view);
    view.camera = front_;
    view.smoke.clear();
    view.instrument.clear();
    view.energised = false;
    auto add = [&](render::Paint paint, const char* title, const char* caption) {
        view.paint = paint;
        maps.push_back({title, caption, paint == render::Paint::injury, draw(view, kMapQuality)});
    };
    add(render::Paint::peak_temperature, "Heat, as seen", "The hottest that each place of the surface has been.");
    add(render::Paint::injury, "Injury, as seen", "Tissue of the surface that heat has killed.");
    if (!vessels) return maps;
    fill_bare(run, view);
    if (view.tissue_index.empty()) return maps;
    add(render::Paint::peak_temperature, "Heat, beneath the fat", "Duct and artery as if all fat were gone.");
    add(render::Paint::injury, "Injury, beneath the fat", "What nobody saw during the operation.");
    return maps;
}

}  // namespace calot::app

#include "render/demo_scene.h"

#include <algorithm>
#include <cmath>

#include "calot/anatomy/anatomy.h"
#include "calot/anatomy/shapes.h"
#include "calot/base/random.h"
#include "calot/render/scene_view.h"
#include "calot/tissue/sampling.h"

namespace calot::render::demo {

namespace {

using anatomy::make_shape;

double smooth_min(double a, double b, double k) {
    const double h = std::clamp(0.5 + 0.5 * (b - a) / k, 0.0, 1.0);
    return b + (a - b) * h - k * h * (1.0 - h);
}

double segment(const Vec3& p, const Vec3& a, const Vec3& b) {
    const Vec3 e = b - a;
    const double t = std::clamp(glm::dot(p - a, e) / glm::dot(e, e), 0.0, 1.0);
    return glm::length(p - a - t * e);
}

/// Tube along a gently bent line of three points.
double tube(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c, double radius) {
    double d = 1e9;
    Vec3 last = a;
    for (int k = 1; k <= 12; ++k) {
        const double t = k / 12.0;
        const Vec3 at = (1 - t) * (1 - t) * a + 2 * t * (1 - t) * b + t * t * c;
        d = std::min(d, segment(p, last, at));
        last = at;
    }
    return d - radius;
}

double fat(const Vec3& p) {
    // A cushion with rolling lobes.
    const double bumps = 0.0009 * std::sin(520 * p.x + 90 * p.y) * std::sin(480 * p.y - 60 * p.x) +
                         0.0005 * std::sin(1100 * p.x + 1.0) * std::sin(1000 * p.y + 2.0);
    const Vec3 q(p.x / 0.021, p.y / 0.016, (p.z + 0.010) / 0.010);
    return (glm::length(q) - 1.0) * 0.010 - bumps;
}

double duct(const Vec3& p) {
    return tube(p, {-0.019, 0.007, -0.001}, {-0.004, -0.002, 0.003}, {0.019, -0.010, -0.007}, 0.0019);
}
double artery(const Vec3& p) {
    return tube(p, {-0.016, 0.012, -0.004}, {0.002, 0.010, 0.003}, {0.021, 0.003, -0.007}, 0.0012);
}

anatomy::Anatomy make_anatomy() {
    anatomy::Anatomy a;
    const Box field{{-0.026, -0.02, -0.012}, {0.026, 0.02, 0.006}};
    a.field = field;
    a.tissues.push_back({"fat", "fat", make_shape(fat, field)});
    a.tissues.push_back({"cystic_duct", "cystic_duct", make_shape(duct, field)});
    a.tissues.push_back({"cystic_artery", "cystic_artery", make_shape(artery, field)});
    const Box wide{{-0.09, -0.08, -0.05}, {0.09, 0.09, 0.06}};
    a.organs.push_back({"liver", "liver", true,
                        make_shape(
                            [](const Vec3& p) {
                                const Vec3 q(p.x / 0.075, (p.y - 0.050) / 0.036, (p.z + 0.012) / 0.034);
                                return (glm::length(q) - 1.0) * 0.034 +
                                       0.0008 * std::sin(150 * p.x) * std::sin(130 * p.y + 1.0);
                            },
                            wide)});
    a.organs.push_back(
        {"gallbladder", "gallbladder_wall", true,
         make_shape(
             [](const Vec3& p) {
                 const double body = segment(p, {-0.050, 0.030, 0.018}, {-0.031, 0.013, 0.004}) - 0.0125;
                 const double neck = segment(p, {-0.031, 0.013, 0.004}, {-0.017, 0.006, -0.001}) - 0.0038;
                 return smooth_min(body, neck, 0.006);
             },
             wide)});
    a.organs.push_back(
        {"common_duct", "cystic_duct", true,
         make_shape(
             [](const Vec3& p) {
                 return tube(p, {0.020, 0.030, -0.012}, {0.022, -0.010, -0.006}, {0.014, -0.060, -0.014}, 0.0034);
             },
             wide)});
    a.organs.push_back({"peritoneum", "", true,
                        make_shape(
                            [](const Vec3& p) {
                                return (p.z + 0.013 + 0.002 * std::sin(90 * p.x + 20 * p.y) * std::sin(80 * p.y) -
                                        6.0 * p.x * p.x) *
                                       0.8;
                            },
                            wide)});
    return a;
}

}  // namespace

Scene::Scene(double hexel_spacing_m) {
    tissue::SamplingParameters sampling;
    sampling.hexel_spacing_m = hexel_spacing_m;
    const anatomy::Anatomy field = make_anatomy();
    anatomy::Anatomy sampled = field;
    sampled.organs.clear();  // the peritoneum has no material: only drawn
    model = tissue::sample(sampled, sampling);
    for (const anatomy::Organ& organ : field.organs)
        model.organs.push_back(
            {organ.name, tissue::find_material(model.materials, organ.material), organ.holds_tissue, organ.shape});
    state = tissue::State::make(model);
    temperature_K.assign(static_cast<std::size_t>(model.hexels.cells), 310.15f);
    organs = organ_meshes(model, 1.5e-3);
}

void Scene::burn(const Vec3& centre_m, double radius_m) {
    const Lattice& lattice = model.hexels;
    for (std::int64_t hexel = lattice.first; hexel < lattice.last; ++hexel) {
        if (!state.hexel_present.test(hexel)) continue;
        const Vec3 p = lattice.centre_m(hexel);
        const Vec3 flat(1.0, 1.6, 0.9);
        Random random(5, static_cast<std::uint64_t>(hexel));
        const double r = glm::length((p - centre_m) * flat) - radius_m + random.uniform(-0.3, 0.3) * lattice.spacing_m;
        const auto h = static_cast<std::size_t>(hexel);
        if (r < 0.0) {
            state.hexel_present.clear(hexel);
            ++state.hexels_burnt;
        }
        const auto peak = static_cast<float>(310.15 + 270.0 * std::exp(-std::max(0.0, r) / 0.0011));
        state.peak_temperature_K[h] = std::max(state.peak_temperature_K[h], peak);
        temperature_K[h] = std::max(temperature_K[h], 310.15f + 0.6f * (peak - 310.15f));
        if (peak > 373.0f) state.water_kg_per_m3[h] *= std::max(0.0f, 1.0f - (peak - 373.0f) / 100.0f);
        if (peak > 335.0f) state.damage[h] = 5.0f;
    }
}

View Scene::view() const {
    surface::Surface surface(model);
    surface.rebuild(model, state);
    const surface::Mesh& mesh = surface.smooth_mesh();
    View view;
    fill_tissue(model, state, temperature_K, {mesh.position_m, mesh.normal, surface.owner(), mesh.position_m, {}},
                view.tissue);
    view.tissue_index = mesh.index;
    view.tissue_index_version = 1;
    view.organs = &organs;
    view.organs_version = 1;
    view.camera.eye_m = Vec3(0.0, -0.022, 0.064);
    view.camera.target_m = Vec3(0.0, 0.001, -0.001);
    return view;
}

std::vector<tissue::Capsule> Scene::hook(const Vec3& tip_m) {
    const Vec3 trocar(0.05, 0.02, 0.14);
    const Vec3 along = glm::normalize(trocar - tip_m);
    const Vec3 foot = glm::normalize(glm::cross(along, Vec3(0.8, 1.0, 0.0)));
    std::vector<tissue::Capsule> capsules(4);
    const Vec3 bend = tip_m;
    auto set = [&](std::size_t k, const Vec3& a, const Vec3& b, double radius, bool bare) {
        capsules[k].a_m = a;
        capsules[k].b_m = b;
        capsules[k].radius_m = radius;
        capsules[k].bare = bare;
    };
    set(0, bend, bend + 0.005 * foot, 0.0005, true);
    set(1, bend, bend + 0.005 * along, 0.0005, true);
    set(2, bend + 0.005 * along, bend + 0.010 * along, 0.0005, false);
    set(3, bend + 0.0125 * along, bend + 0.25 * along, 0.0025, false);
    return capsules;
}

}  // namespace calot::render::demo

#include "picture.h"

#include <algorithm>
#include <map>

#include "calot/base/parallel.h"
#include "calot/surface/shape_mesh.h"

namespace calot::app {

namespace {

/// Slots of TissueVertex::look_weights.
enum LookSlot { kFat, kDuct, kArtery, kGallbladder };

/// A material's slot, through the chain of materials that it was derived from.
int look_slot(const scene::Scene& scene, std::string material) {
    static const std::map<std::string, int> slots{{"fat", kFat}, {"cystic_duct", kDuct}, {"cystic_artery", kArtery},
                                                  {"gallbladder_wall", kGallbladder}, {"liver", kGallbladder}};
    for (std::size_t step = 0; step < scene.materials.size(); ++step) {
        const auto found = slots.find(material);
        if (found != slots.end()) return found->second;
        material = scene.material_like[tissue::find_material(scene.materials, material)];
    }
    return kFat;
}

/// An organ's look by its name, else by its material.
render::Look organ_look(const tissue::RigidOrgan& organ, const std::vector<tissue::Material>& materials) {
    using render::Look;
    static const std::map<std::string, Look> looks{
        {"liver", Look::liver},          {"gallbladder", Look::gallbladder}, {"gallbladder_wall", Look::gallbladder},
        {"common_duct", Look::duct},     {"cystic_duct", Look::duct},        {"hepatic_artery", Look::artery},
        {"cystic_artery", Look::artery}, {"peritoneum", Look::peritoneum},   {"duodenum", Look::bowel},
        {"fat", Look::fat}};
    for (const std::string& name : {organ.name, materials[organ.material].name})
        if (const auto found = looks.find(name); found != looks.end()) return found->second;
    return Look::peritoneum;
}

constexpr double kBeyondField_m = 0.08;      ///< organs are drawn this far beyond the tissue
constexpr double kOrganSpacing_m = 0.8e-3;

Box grown(const Box& box, double by) { return {box.low - Vec3(by), box.high + Vec3(by)}; }
Box common(const Box& a, const Box& b) { return {glm::max(a.low, b.low), glm::min(a.high, b.high)}; }

Vec3f unit_or(const Vec3f& v, const Vec3f& otherwise) {
    const float length = glm::length(v);
    return length > 1e-12f ? v / length : otherwise;
}

}  // namespace

Picture::Picture(const scene::Scene& scene, const simulation::Simulation& run) {
    const simulation::Setup& setup = run.setup();
    camera_.eye_m = setup.camera.eye_m;
    camera_.target_m = setup.camera.target_m;
    camera_.field_of_view_deg = setup.camera.field_of_view_deg;
    for (const tissue::Material& material : setup.model.materials) look_of_material_.push_back(look_slot(scene, material.name));
    for (const tissue::RigidOrgan& organ : setup.model.organs) {
        const Box box = common(grown(organ.shape->bounds_m(), 2.0 * kOrganSpacing_m), grown(setup.anatomy.field, kBeyondField_m));
        if (!glm::all(glm::lessThan(box.low, box.high))) continue;
        organs_.push_back({organ_look(organ, setup.model.materials), surface::mesh_of_shape(*organ.shape, box, kOrganSpacing_m)});
    }
    const Lattice& lattice = run.model().hexels;
    initial_ = run.state().hexel_present;
    initially_open_ = BitArray(lattice.cells);
    const std::int64_t neighbours[6] = {lattice.stride.x, -lattice.stride.x, lattice.stride.y, -lattice.stride.y, lattice.stride.z, -lattice.stride.z};
    for (std::int64_t h = lattice.first; h < lattice.last; ++h) {
        if (!initial_.test(h)) continue;
        for (std::int64_t n : neighbours)
            if (!initial_.test(h + n) && !run.model().hexel_held.test(h + n)) initially_open_.set(h);
    }
}

render::TissueVertex Picture::vertex(const simulation::Simulation& run, const Vec3f& rest_m, std::int64_t owner) const {
    const tissue::Model& model = run.model();
    const tissue::State& state = run.state();
    const Lattice& lattice = model.hexels;
    render::TissueVertex v;
    v.rest_m = rest_m;
    v.temperature_K = v.peak_temperature_K = v.dryness = v.damage = v.exposure = 0.0f;
    for (float& w : v.look_weights) w = 0.0f;
    float sum = 0.0f;
    auto add = [&](std::int64_t hexel, float weight) {
        const auto cell = static_cast<std::size_t>(hexel);
        const tissue::Material& material = model.materials[model.hexel_material[cell]];
        const auto water = static_cast<float>(material.density_kg_per_m3 * material.water_mass_fraction);
        sum += weight;
        v.temperature_K += weight * run.work().thermal.temperature_K[cell];
        v.peak_temperature_K += weight * state.peak_temperature_K[cell];
        v.damage += weight * std::min(state.damage[cell], 10.0f);
        if (water > 0.0f) v.dryness += weight * std::clamp(1.0f - state.water_kg_per_m3[cell] / water, 0.0f, 1.0f);
        if (!initially_open_.test(hexel)) v.exposure += weight;
        v.look_weights[look_of_material_[model.hexel_material[cell]]] += weight;
    };
    // Trilinear over the eight hexels about the vertex, as far as they are there: colours then run smoothly.
    const Vec3 place = (Vec3(rest_m) - lattice.origin_m) / lattice.spacing_m;
    const Int3 low = Int3(glm::floor(place));
    const Vec3f t = Vec3f(place - Vec3(low));
    for (int corner = 0; corner < 8; ++corner) {
        const Int3 d(corner & 1, (corner >> 1) & 1, corner >> 2);
        if (!lattice.contains(low + d)) continue;
        const std::int64_t hexel = lattice.index(low + d);
        if (!state.hexel_present.test(hexel)) continue;
        const float weight = (d.x ? t.x : 1.0f - t.x) * (d.y ? t.y : 1.0f - t.y) * (d.z ? t.z : 1.0f - t.z);
        add(hexel, weight + 1e-4f);
    }
    if (sum == 0.0f) add(owner, 1.0f);
    const float scale = 1.0f / sum;
    v.temperature_K *= scale;
    v.peak_temperature_K *= scale;
    v.damage *= scale;
    v.dryness *= scale;
    v.exposure *= scale;
    for (float& w : v.look_weights) w *= scale;
    return v;
}

void Picture::fill(const simulation::Simulation& run, const tissue::Input& input, render::View& view) {
    const surface::Mesh& mesh = run.surface().rest_mesh();
    const std::vector<std::int64_t>& owner = run.surface().owner();
    run.world_surface(world_);
    view.camera = camera_;
    view.time_s = run.time_s();
    view.tissue.resize(mesh.position_m.size());
    parallel_for("picture.vertices", 0, static_cast<std::int64_t>(mesh.position_m.size()), 2048, [&](std::int64_t begin, std::int64_t end) {
        for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k) {
            render::TissueVertex& v = view.tissue[k];
            v = vertex(run, mesh.position_m[k], owner[k]);
            v.world_m = world_.position_m[k];
            // Normals turn by the inverse transpose of F, which is its cofactor matrix up to a positive factor.
            const Mat3f& f = world_.deformation_gradient[k];
            const Mat3f cofactor(glm::cross(f[1], f[2]), glm::cross(f[2], f[0]), glm::cross(f[0], f[1]));
            v.normal = unit_or(cofactor * mesh.normal[k], mesh.normal[k]);
        }
    });
    if (view.tissue_index_version != run.surface().version() || view.tissue_index.empty()) {
        view.tissue_index = mesh.index;
        view.tissue_index_version = run.surface().version();
    }
    view.organs = &organs_;
    view.instrument = run.capsules();
    view.energised = input.pedal;
    view.smoke = run.work().smoke.particles();
}

}  // namespace calot::app

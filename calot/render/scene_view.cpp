#include "calot/render/scene_view.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "calot/base/parallel.h"
#include "calot/surface/shape_mesh.h"

namespace calot::render {

namespace {

/// A film of blood this thick, averaged over the hexels about a vertex (of which a third has a surface), hides what is
/// under it: at 0.1 mm whole blood lets through a tenth of green light.
constexpr float kOpaqueFilm_m = 0.05e-3f;

bool contains(const std::string& text, const char* word) {
    return text.find(word) != std::string::npos;
}

/// Slot of a material among TissueVertex::look_weights.
int weight_slot(const std::string& material) {
    switch (look_of(material)) {
        case Look::duct:
            return 1;
        case Look::artery:
            return 2;
        case Look::gallbladder:
            return 3;
        default:
            return 0;
    }
}

/// What a vertex takes from the hexels around it.
class Attributes {
  public:
    Attributes(const tissue::Model& model, const tissue::State& state, std::span<const float> temperature_K,
               std::span<const float> film_m)
        : model_(model),
          state_(state),
          temperature_K_(temperature_K),
          film_m_(film_m),
          inverse_spacing_(static_cast<float>(1.0 / model.hexels.spacing_m)) {
        std::array<int, 3> strides{model.hexels.stride.x, model.hexels.stride.y, model.hexels.stride.z};
        std::sort(strides.begin(), strides.end());
        middle_stride_ = strides[1];
        slow_stride_ = strides[2];
        for (std::size_t k = 1; k < model.materials.size(); ++k) {
            const tissue::Material& material = model.materials[k];
            slot_[k] = weight_slot(material.name);
            const double water = material.density_kg_per_m3 * material.water_mass_fraction;
            inverse_water_[k] = static_cast<float>(1.0 / std::max(1e-6, water));
        }
    }

    void fill(std::int64_t owner, TissueVertex& vertex) const {
        const Lattice& lattice = model_.hexels;
        const Int3 cell = lattice.coordinates(owner);
        // The vertex from the owner's centre, in cells.
        const Vec3f from_owner = (vertex.rest_m - Vec3f(lattice.centre_m(cell))) * inverse_spacing_;
        average_present(owner, from_owner, vertex);
        vertex.exposure = state_.hexels_burnt + state_.hexels_fallen > 0 ? exposure(cell, owner, from_owner) : 0.0f;
    }

  private:
    /// Kernel (1 - r^2 / R^2)^2 of the distance in cells.
    static float kernel(const Vec3f& d, float reach) {
        const float left = 1.0f - glm::dot(d, d) / (reach * reach);
        return left > 0.0f ? left * left : 0.0f;
    }

    void average_present(std::int64_t owner, const Vec3f& from_owner, TissueVertex& vertex) const {
        const Lattice& lattice = model_.hexels;
        float film = 0.0f;
        float sum = 0.0f, temperature = 0.0f, peak = 0.0f, damage = 0.0f, dryness = 0.0f;
        float weights[4] = {0, 0, 0, 0};
        for (int z = -1; z <= 1; ++z)
            for (int y = -1; y <= 1; ++y)
                for (int x = -1; x <= 1; ++x) {
                    const Int3 d(x, y, z);
                    const std::int64_t hexel = owner + lattice.offset(d);
                    if (!state_.hexel_present.test(hexel)) continue;
                    const float w = kernel(Vec3f(d) - from_owner, 2.2f) + 1e-4f;
                    const auto h = static_cast<std::size_t>(hexel);
                    const std::size_t material = model_.hexel_material[h];
                    sum += w;
                    if (!film_m_.empty()) film += w * film_m_[h];
                    temperature += w * (temperature_K_.empty() ? body_K() : temperature_K_[h]);
                    peak += w * state_.peak_temperature_K[h];
                    damage += w * std::min(state_.damage[h], 20.0f);
                    dryness += w * (1.0f - std::min(1.0f, state_.water_kg_per_m3[h] * inverse_water_[material]));
                    weights[slot_[material]] += w;
                }
        const float share = sum > 0.0f ? 1.0f / sum : 0.0f;
        vertex.temperature_K = sum > 0.0f ? temperature * share : body_K();
        vertex.peak_temperature_K = sum > 0.0f ? peak * share : body_K();
        vertex.damage = damage * share;
        vertex.dryness = dryness * share;
        vertex.blood = std::min(1.0f, film * share / kOpaqueFilm_m);
        for (int k = 0; k < 4; ++k) vertex.look_weights[k] = weights[k] * share;
        if (sum <= 0.0f) vertex.look_weights[0] = 1.0f;
    }

    float exposure(const Int3& cell, std::int64_t owner, const Vec3f& from_owner) const {
        const Lattice& lattice = model_.hexels;
        const bool inside =
            glm::all(glm::greaterThanEqual(cell, Int3(2))) && glm::all(glm::lessThan(cell, lattice.size - 2));
        if (inside && !burnt_nearby(owner)) return 0.0f;
        float burnt = 0.0f, empty = 0.0f;
        for (int z = -2; z <= 2; ++z)
            for (int y = -2; y <= 2; ++y)
                for (int x = -2; x <= 2; ++x) {
                    const Int3 d(x, y, z);
                    const float w = kernel(Vec3f(d) - from_owner, 2.5f);
                    if (w <= 0.0f) continue;
                    const bool known = inside || lattice.contains(cell + d);
                    const std::int64_t hexel = owner + lattice.offset(d);
                    if (known && state_.hexel_present.test(hexel)) continue;
                    empty += w;
                    if (known && model_.hexel_initial.test(hexel)) burnt += w;
                }
        return empty > 0.0f ? burnt / empty : 0.0f;
    }

    /// Whether any cell of the 5^3 around `owner` has burnt: five bits at a time along the fastest axis.
    bool burnt_nearby(std::int64_t owner) const {
        std::uint32_t burnt = 0;
        for (int b = -2; b <= 2; ++b)
            for (int a = -2; a <= 2; ++a) {
                const std::int64_t row = owner + a * middle_stride_ + b * slow_stride_ - 2;
                burnt |= model_.hexel_initial.bits32(row) & ~state_.hexel_present.bits32(row);
            }
        return (burnt & 0x1f) != 0;
    }

    float body_K() const { return static_cast<float>(model_.thermal.body_temperature_K); }

    const tissue::Model& model_;
    const tissue::State& state_;
    std::span<const float> temperature_K_;
    std::span<const float> film_m_;
    float inverse_spacing_;
    std::int64_t middle_stride_, slow_stride_;
    std::array<int, 256> slot_{};
    std::array<float, 256> inverse_water_{};
};

/// n ~ F^-T N = cof(F) N / det F; the cofactor's columns are cross products, so no inverse is needed.
Vec3f turned(const Vec3f& normal, const Mat3f& f) {
    const Vec3f n =
        glm::cross(f[1], f[2]) * normal.x + glm::cross(f[2], f[0]) * normal.y + glm::cross(f[0], f[1]) * normal.z;
    const float length = glm::length(n);
    return length > 1e-12f ? n / length : normal;
}

}  // namespace

void fill_tissue(const tissue::Model& model, const tissue::State& state, std::span<const float> temperature_K,
                 const SurfaceVertices& surface, std::vector<TissueVertex>& vertices) {
    const std::size_t count = surface.rest_m.size();
    assert(surface.rest_normal.size() == count && surface.owner.size() == count && surface.world_m.size() == count);
    assert(surface.deformation_gradient.empty() || surface.deformation_gradient.size() == count);
    vertices.resize(count);
    const Attributes attributes(model, state, temperature_K, surface.film_m);
    parallel_for("render.fill_tissue", 0, static_cast<std::int64_t>(count), 1024,
                 [&](std::int64_t low, std::int64_t high) {
                     for (std::int64_t k = low; k < high; ++k) {
                         const auto v = static_cast<std::size_t>(k);
                         TissueVertex& vertex = vertices[v];
                         vertex.world_m = surface.world_m[v];
                         vertex.rest_m = surface.rest_m[v];
                         vertex.normal = surface.deformation_gradient.empty()
                                             ? surface.rest_normal[v]
                                             : turned(surface.rest_normal[v], surface.deformation_gradient[v]);
                         attributes.fill(surface.owner[v], vertex);
                     }
                 });
}

Look look_of(const std::string& name) {
    if (contains(name, "gallbladder")) return Look::gallbladder;
    if (contains(name, "duct")) return Look::duct;
    if (contains(name, "artery") || contains(name, "arteries") || contains(name, "vessel")) return Look::artery;
    if (contains(name, "liver")) return Look::liver;
    if (contains(name, "bowel") || contains(name, "duodenum") || contains(name, "colon")) return Look::bowel;
    if (contains(name, "fat") || contains(name, "omentum")) return Look::fat;
    return Look::peritoneum;
}

namespace {

/// Thin organs need finer meshes.
double fineness(Look look) {
    switch (look) {
        case Look::duct:
        case Look::artery:
            return 0.5;
        case Look::gallbladder:
            return 0.9;
        default:
            return 1.5;
    }
}

}  // namespace

std::vector<OrganMesh> organ_meshes(const tissue::Model& model, double spacing_m, double reach_m) {
    std::vector<OrganMesh> organs;
    const Vec3 low = model.hexels.origin_m - reach_m;
    const Vec3 high = model.hexels.origin_m + model.hexels.spacing_m * Vec3(model.hexels.size) + reach_m;
    for (const tissue::RigidOrgan& organ : model.organs) {
        OrganMesh mesh;
        // The organ's own name says more than its material (a common duct may be of the cystic duct's material).
        mesh.look = look_of(organ.name);
        if (mesh.look == Look::peritoneum && organ.material != tissue::kNoMaterial &&
            !contains(organ.name, "peritoneum"))
            mesh.look = look_of(model.materials[organ.material].name);
        const double step_m = fineness(mesh.look) * spacing_m;
        const Box bounds = organ.shape->bounds_m();
        const Box box{glm::max(bounds.low - 2.0 * step_m, low), glm::min(bounds.high + 2.0 * step_m, high)};
        if (glm::any(glm::greaterThanEqual(box.low, box.high))) continue;
        mesh.mesh = surface::mesh_of_shape(*organ.shape, box, step_m);
        if (!mesh.mesh.index.empty()) organs.push_back(std::move(mesh));
    }
    return organs;
}

}  // namespace calot::render

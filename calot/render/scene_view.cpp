#include "calot/render/scene_view.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstring>

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

/// Four lanes, which every machine has.
using Four = float __attribute__((vector_size(16)));
Four four(float value) {
    return Four{value, value, value, value};
}
Four load(const float* p) {
    Four v;
    std::memcpy(&v, p, sizeof(v));
    return v;
}
Four smaller(Four a, Four b) {
    return a < b ? a : b;
}
Four greater(Four a, Four b) {
    return a > b ? a : b;
}

/// Of three cells in a row, by their presence bits: 1 where there is a hexel; the bytes of their materials that count.
constexpr std::array<std::array<float, 4>, 8> kThere{
    {{0, 0, 0, 0}, {1, 0, 0, 0}, {0, 1, 0, 0}, {1, 1, 0, 0}, {0, 0, 1, 0}, {1, 0, 1, 0}, {0, 1, 1, 0}, {1, 1, 1, 0}}};
constexpr std::array<std::uint32_t, 8> kBytes{0x000000, 0x0000ff, 0x00ff00, 0x00ffff,
                                              0xff0000, 0xff00ff, 0xffff00, 0xffffff};

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
        std::array<int, 3> axes{0, 1, 2};
        std::sort(axes.begin(), axes.end(),
                  [&](int a, int b) { return model.hexels.stride[a] < model.hexels.stride[b]; });
        fast_ = axes[0];
        middle_ = axes[1];
        slow_ = axes[2];
        middle_stride_ = model.hexels.stride[middle_];
        slow_stride_ = model.hexels.stride[slow_];
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
    // Weights are (1 - r^2 / R^2)^2, r the distance in cells: squares along the axes are added up.

    /// (k - (N - 1) / 2 - from)^2 for k = 0 ... N - 1.
    template <std::size_t N>
    static std::array<float, N> squares(float from) {
        std::array<float, N> out;
        for (std::size_t k = 0; k < N; ++k) {
            const float d = static_cast<float>(k) - static_cast<float>(N / 2) - from;
            out[k] = d * d;
        }
        return out;
    }

    /// The nine rows of three cells around the owner, a row at a time: temperatures and the like lie side by side.
    void average_present(std::int64_t owner, const Vec3f& from_owner, TissueVertex& vertex) const {
        // Four lanes, the last one empty.
        const Four cells = Four{-1.0f, 0.0f, 1.0f, 2.0f} - four(from_owner[fast_]), fast = cells * cells;
        const std::array<float, 3> middle = squares<3>(from_owner[middle_]), slow = squares<3>(from_owner[slow_]);
        const std::uint8_t own = model_.hexel_material[static_cast<std::size_t>(owner)];
        const std::uint32_t all_own = 0x010101u * own;
        const Four one = four(1.0f), none = four(0.0f);
        Four sum = none, temperature = none, peak = none, damage = none, dryness = none, film = none, of_own = none;
        float weights[4] = {0, 0, 0, 0};
        for (std::size_t c = 0; c < 3; ++c)
            for (std::size_t b = 0; b < 3; ++b) {
                const std::int64_t row = owner + (static_cast<std::int64_t>(b) - 1) * middle_stride_ +
                                         (static_cast<std::int64_t>(c) - 1) * slow_stride_ - 1;
                const std::uint32_t present = state_.hexel_present.bits32(row) & 7u;
                if (present == 0) continue;
                const auto h = static_cast<std::size_t>(row);
                const Four left = greater(none, one - (fast + four(middle[b] + slow[c])) * four(1.0f / (2.2f * 2.2f)));
                const Four w = (left * left + four(1e-4f)) * load(kThere[present].data());
                sum += w;
                temperature += w * (temperature_K_.empty() ? four(body_K()) : load(temperature_K_.data() + h));
                peak += w * load(state_.peak_temperature_K.data() + h);
                damage += w * smaller(load(state_.damage.data() + h), four(20.0f));
                if (!film_m_.empty()) film += w * load(film_m_.data() + h);
                const Four water = load(state_.water_kg_per_m3.data() + h);
                std::uint32_t materials;
                std::memcpy(&materials, model_.hexel_material.data() + h, sizeof(materials));
                if (((materials ^ all_own) & kBytes[present]) == 0) {
                    dryness += w * (one - smaller(one, water * four(inverse_water_[own])));
                    of_own += w;
                    continue;
                }
                Four full = one;
                for (int k = 0; k < 3; ++k) {
                    if (w[k] == 0.0f) continue;
                    const std::size_t material = (materials >> (8 * k)) & 0xffu;
                    full[k] = inverse_water_[material];
                    weights[slot_[material]] += w[k];
                }
                dryness += w * (one - smaller(one, water * full));
            }
        const auto total = [](const Four& parts) { return parts[0] + parts[1] + parts[2]; };
        weights[slot_[own]] += total(of_own);
        const float all = total(sum), share = all > 0.0f ? 1.0f / all : 0.0f;
        vertex.temperature_K = all > 0.0f ? total(temperature) * share : body_K();
        vertex.peak_temperature_K = all > 0.0f ? total(peak) * share : body_K();
        vertex.damage = total(damage) * share;
        vertex.dryness = total(dryness) * share;
        vertex.blood = std::min(1.0f, total(film) * share / kOpaqueFilm_m);
        for (int k = 0; k < 4; ++k) vertex.look_weights[k] = weights[k] * share;
        if (all <= 0.0f) vertex.look_weights[0] = 1.0f;
    }

    /// The share of burnt cells among the empty ones of the 5^3 around the owner, by weight.
    float exposure(const Int3& cell, std::int64_t owner, const Vec3f& from_owner) const {
        const Lattice& lattice = model_.hexels;
        const bool inside =
            glm::all(glm::greaterThanEqual(cell, Int3(2))) && glm::all(glm::lessThan(cell, lattice.size - 2));
        if (inside && !burnt_nearby(owner)) return 0.0f;
        const std::array<float, 5> fast = squares<5>(from_owner[fast_]), middle = squares<5>(from_owner[middle_]),
                                   slow = squares<5>(from_owner[slow_]);
        float burnt = 0.0f, empty = 0.0f;
        for (std::size_t c = 0; c < 5; ++c)
            for (std::size_t b = 0; b < 5; ++b) {
                Int3 at = cell;
                at[middle_] += static_cast<int>(b) - 2;
                at[slow_] += static_cast<int>(c) - 2;
                std::uint32_t known = 0x1f;  // beyond the lattice nothing is
                if (!inside) {
                    known = 0;
                    for (int k = 0; k < 5; ++k) {
                        Int3 there = at;
                        there[fast_] += k - 2;
                        known |= (lattice.contains(there) ? 1u : 0u) << k;
                    }
                }
                const std::int64_t row = lattice.index(at) - 2;
                const std::uint32_t initial = known == 0 ? 0u : model_.hexel_initial.bits32(row) & known;
                const std::uint32_t present = known == 0 ? 0u : state_.hexel_present.bits32(row) & known;
                for (std::uint32_t rest = ~present & 0x1fu; rest != 0; rest &= rest - 1) {
                    const int k = __builtin_ctz(rest);
                    const float left =
                        1.0f - (fast[static_cast<std::size_t>(k)] + middle[b] + slow[c]) * (1.0f / (2.5f * 2.5f));
                    if (left <= 0.0f) continue;
                    empty += left * left;
                    if ((initial >> k) & 1u) burnt += left * left;
                }
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
    int fast_, middle_, slow_;  ///< axes, by stride
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
    parallel_for("render.fill_tissue", 0, static_cast<std::int64_t>(count), 4096,
                 [&](std::int64_t low, std::int64_t high) {
                     fill_tissue(model, state, temperature_K, surface, static_cast<std::size_t>(low),
                                 static_cast<std::size_t>(high), vertices);
                 });
}

void fill_tissue(const tissue::Model& model, const tissue::State& state, std::span<const float> temperature_K,
                 const SurfaceVertices& surface, std::size_t low, std::size_t high, std::span<TissueVertex> vertices) {
    const Attributes attributes(model, state, temperature_K, surface.film_m);
    for (std::size_t v = low; v < high; ++v) {
        TissueVertex& vertex = vertices[v];
        vertex.world_m = surface.world_m[v];
        vertex.rest_m = surface.rest_m[v];
        vertex.normal = surface.deformation_gradient.empty()
                            ? surface.rest_normal[v]
                            : turned(surface.rest_normal[v], surface.deformation_gradient[v]);
        attributes.fill(surface.owner[v], vertex);
    }
}

void place_tissue(std::span<const Vec3f> rest_m, std::span<const Vec3f> rest_normal, std::span<const Vec3f> world_m,
                  std::span<const Mat3f> deformation_gradient, std::span<TissueVertex> vertices) {
    for (std::size_t v = 0; v < vertices.size(); ++v) {
        vertices[v].world_m = world_m[v];
        vertices[v].rest_m = rest_m[v];
        vertices[v].normal = turned(rest_normal[v], deformation_gradient[v]);
    }
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

#include "calot/deformation/embedding.h"

#include <cassert>
#include <cstring>

#include "calot/base/parallel.h"
#include "calot/base/random.h"
#include "calot/deformation/carriers.h"

namespace calot::deformation {

namespace {

constexpr std::int64_t kPointsPerChunk = 512;

/// A point's place relative to the centre of its owner's phyxel, in spacings.
Vec3f relative_to(const tissue::Model& model, const Vec3f& rest_m, const Vec3f& centre_m) {
    return (rest_m - centre_m) * static_cast<float>(1.0 / model.phyxels.spacing_m);
}

constexpr std::size_t kPadded = 28;  ///< carriers, for vectors of four

/// Where the carriers of a phyxel are, in spacings from it, axis by axis.
struct Steps {
    alignas(16) std::array<std::array<float, kPadded>, 3> along{};

    Steps() = default;
    explicit Steps(const Carriers& carriers) {
        const auto& links = neighbour_links();
        for (std::size_t n = 0; n < static_cast<std::size_t>(carriers.count); ++n)
            for (std::size_t axis = 0; axis < 3; ++axis)
                along[axis][n] =
                    static_cast<float>(links[static_cast<std::size_t>(carriers.cell[n])].step[static_cast<int>(axis)]);
    }
};

/// Of a point at r from the phyxel, in spacings; the first `count` count.
void raw_weights(const Steps& steps, std::size_t count, const Vec3f& r, std::array<float, kPadded>& weight) {
    const Four x{r.x, r.x, r.x, r.x}, y{r.y, r.y, r.y, r.y}, z{r.z, r.z, r.z, r.z};
    for (std::size_t n = 0; n < count; n += 4) {
        Four step[3];
        for (std::size_t axis = 0; axis < 3; ++axis) std::memcpy(&step[axis], &steps.along[axis][n], sizeof(Four));
        const Four dx = x - step[0], dy = y - step[1], dz = z - step[2];
        const Four w = embedding_kernel(dx * dx + dy * dy + dz * dz);
        std::memcpy(&weight[n], &w, sizeof(Four));
    }
}

}  // namespace

Stencil embedding_stencil(const tissue::Model& model, const tissue::State& state, const Work& work,
                          std::int64_t owner_hexel, const Vec3f& rest_m) {
    const std::int64_t owner = model.phyxel_of(model.hexels.coordinates(owner_hexel));
    const Carriers carriers = find_carriers(model, state, work, owner);
    Stencil stencil;
    if (carriers.count == 0) return stencil;
    std::array<float, kPadded> weight;
    raw_weights(Steps(carriers), static_cast<std::size_t>(carriers.count),
                relative_to(model, rest_m, Vec3f(model.phyxels.centre_m(owner))), weight);
    float total = 0.0f;
    for (std::size_t n = 0; n < static_cast<std::size_t>(carriers.count); ++n) {
        if (weight[n] == 0.0f) continue;
        total += weight[n];
        stencil.phyxel[static_cast<std::size_t>(stencil.count)] = carriers.phyxel[n];
        stencil.weight[static_cast<std::size_t>(stencil.count++)] = weight[n];
    }
    if (stencil.count == 0) {  // far outside the owner's cell: it alone carries the point
        stencil.phyxel[0] = owner;
        stencil.weight[0] = total = 1.0f;
        stencil.count = 1;
    }
    for (std::size_t n = 0; n < static_cast<std::size_t>(stencil.count); ++n) stencil.weight[n] /= total;
    return stencil;
}

namespace {

/// What the points of one phyxel share. A few are kept: surface vertices come in the order of small blocks of space.
struct SharedCarriers {
    std::int64_t phyxel = -1;
    Vec3f centre_m{0.0f};
    Carriers carriers;
    Steps steps;
    CarrierFields fields;
};
constexpr std::size_t kKept = 16;

template <class State, class Work>
void embed(const tissue::Model& model, const State& state, const Work& work, std::span<const Vec3f> rest_m,
           std::span<const std::int64_t> owner, std::span<Vec3f> world_m, std::span<Mat3f> deformation_gradient) {
    assert(owner.size() == rest_m.size() && world_m.size() == rest_m.size());
    assert(deformation_gradient.empty() || deformation_gradient.size() == rest_m.size());
    const auto count = static_cast<std::int64_t>(rest_m.size());
    parallel_for("deformation.embed", 0, count, kPointsPerChunk, [&](std::int64_t low, std::int64_t high) {
        std::array<SharedCarriers, kKept> kept;
        std::array<float, kPadded> weight;
        for (auto p = static_cast<std::size_t>(low); p < static_cast<std::size_t>(high); ++p) {
            const std::int64_t phyxel = model.phyxel_of(model.hexels.coordinates(owner[p]));
            SharedCarriers& shared = kept[mix64(static_cast<std::uint64_t>(phyxel)) % kKept];
            if (shared.phyxel != phyxel) {
                shared.phyxel = phyxel;
                shared.centre_m = Vec3f(model.phyxels.centre_m(phyxel));
                shared.carriers = find_carriers(model, state, work, phyxel);
                shared.steps = Steps(shared.carriers);
                shared.fields.gather(model, state, work, shared.carriers);
            }
            if (shared.carriers.count == 0) {
                world_m[p] = rest_m[p];
                if (!deformation_gradient.empty()) deformation_gradient[p] = Mat3f(1.0f);
                continue;
            }
            raw_weights(shared.steps, static_cast<std::size_t>(shared.carriers.count),
                        relative_to(model, rest_m[p], shared.centre_m), weight);
            const auto f = blend(shared.fields, shared.carriers.count, weight.data());
            world_m[p] = rest_m[p] + displacement_at(f, rest_m[p] - shared.centre_m);
            if (!deformation_gradient.empty()) deformation_gradient[p] = deformation_gradient_of(f);
        }
    });
}

}  // namespace

void embed_points(const tissue::Model& model, const tissue::State& state, const Work& work,
                  std::span<const Vec3f> rest_m, std::span<const std::int64_t> owner, std::span<Vec3f> world_m,
                  std::span<Mat3f> deformation_gradient) {
    embed(model, state, work, rest_m, owner, world_m, deformation_gradient);
}

void embed_points(const tissue::Model& model, const Pose& pose, std::span<const Vec3f> rest_m,
                  std::span<const std::int64_t> owner, std::span<Vec3f> world_m,
                  std::span<Mat3f> deformation_gradient) {
    embed(model, pose, pose, rest_m, owner, world_m, deformation_gradient);
}

void Pose::copy(const tissue::State& state, const Work& work) {
    displacement_m = state.displacement_m;
    gradient = work.gradient;
    phyxel_present = state.phyxel_present;
    link_word = work.link_word;
    neighbour_offset = work.neighbour_offset;
    links_severed = state.links_severed;
}

void embed_points_reference(const tissue::Model& model, const tissue::State& state, const Work& work,
                            std::span<const Vec3f> rest_m, std::span<const std::int64_t> owner,
                            std::span<Vec3f> world_m, std::span<Mat3f> deformation_gradient) {
    for (std::size_t p = 0; p < rest_m.size(); ++p) {
        const Stencil stencil = embedding_stencil(model, state, work, owner[p], rest_m[p]);
        Vec3f u(0.0f);
        Mat3f F(1.0f);
        for (std::size_t n = 0; n < static_cast<std::size_t>(stencil.count); ++n) {
            const auto j = static_cast<std::size_t>(stencil.phyxel[n]);
            const Vec3f r = rest_m[p] - Vec3f(model.phyxels.centre_m(stencil.phyxel[n]));
            for (int row = 0; row < 3; ++row) {
                float value = state.displacement_m[static_cast<std::size_t>(row)][j];
                for (int column = 0; column < 3; ++column) {
                    const float g = work.gradient[static_cast<std::size_t>(3 * row + column)][j];
                    value += g * r[column];
                    F[column][row] += stencil.weight[n] * g;
                }
                u[row] += stencil.weight[n] * value;
            }
        }
        world_m[p] = rest_m[p] + u;
        if (!deformation_gradient.empty()) deformation_gradient[p] = F;
    }
}

}  // namespace calot::deformation

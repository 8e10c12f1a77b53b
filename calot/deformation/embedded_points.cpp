#include "calot/deformation/embedded_points.h"

#include <algorithm>
#include <cassert>

#include "calot/base/parallel.h"
#include "calot/deformation/carriers.h"

namespace calot::deformation {

namespace {

constexpr std::int64_t kBlocksPerChunk = 64;
constexpr std::int64_t kCellsPerChunk = 4096;

/// Orders points by phyxel, then by octant of its cell: points of an octant share most of their carriers.
std::int64_t sorting_key(std::int64_t phyxel, const Vec3f& relative) {
    return 8 * phyxel + (relative.x > 0.0f) + 2 * (relative.y > 0.0f) + 4 * (relative.z > 0.0f);
}

}  // namespace

void EmbeddedPoints::rebuild(const tissue::Model& model, const tissue::State& state, std::span<const Vec3f> rest_m,
                             std::span<const std::int64_t> owner) {
    rebuild_with(model, rest_m, owner, [&](std::int64_t phyxel) { return find_carriers(model, state, phyxel); });
}

void EmbeddedPoints::rebuild(const tissue::Model& model, const Pose& pose, std::span<const Vec3f> rest_m,
                             std::span<const std::int64_t> owner) {
    rebuild_with(model, rest_m, owner, [&](std::int64_t phyxel) { return find_carriers(model, pose, pose, phyxel); });
}

template <class FindCarriers>
void EmbeddedPoints::rebuild_with(const tissue::Model& model, std::span<const Vec3f> rest_m,
                                  std::span<const std::int64_t> owner, const FindCarriers& find) {
    assert(rest_m.size() == owner.size());
    const Lattice& lattice = model.phyxels;
    const auto cells = static_cast<std::size_t>(lattice.cells);
    const auto inverse_spacing = static_cast<float>(1.0 / lattice.spacing_m);
    points_ = rest_m.size();
    if (centre_m_[0].size() != cells) {
        for (int axis = 0; axis < 3; ++axis) {
            centre_m_[static_cast<std::size_t>(axis)].assign(cells, 0.0f);
            offset_m_[static_cast<std::size_t>(axis)].assign(cells, 0.0f);
        }
        for (std::int64_t p = lattice.first; p < lattice.last; ++p)
            for (int axis = 0; axis < 3; ++axis)
                centre_m_[static_cast<std::size_t>(axis)][static_cast<std::size_t>(p)] =
                    static_cast<float>(lattice.centre_m(p)[axis]);
    }
    auto centre_of = [&](std::int64_t phyxel) {
        const auto p = static_cast<std::size_t>(phyxel);
        return Vec3f(centre_m_[0][p], centre_m_[1][p], centre_m_[2][p]);
    };
    order_.resize(points_);
    for (std::size_t k = 0; k < points_; ++k) {
        const std::int64_t phyxel = model.phyxel_of(model.hexels.coordinates(owner[k]));
        order_[k] = {sorting_key(phyxel, rest_m[k] - centre_of(phyxel)), static_cast<std::int64_t>(k)};
    }
    std::sort(order_.begin(), order_.end());

    blocks_.clear();
    carrier_phyxel_.clear();
    weight_.clear();
    const auto& links = neighbour_links();
    Carriers carriers;
    for (std::size_t next = 0; next < points_;) {
        const std::int64_t phyxel = order_[next][0] / 8;
        if (next == 0 || order_[next - 1][0] / 8 != phyxel) carriers = find(phyxel);
        const Vec3f centre = centre_of(phyxel);
        Block block;
        std::array<std::array<float, kLanes>, kNeighbourhood> weight{};
        while (next < points_ && order_[next][0] / 8 == phyxel && block.points < kLanes) {
            const auto lane = static_cast<std::size_t>(block.points++);
            const auto point = static_cast<std::size_t>(order_[next++][1]);
            block.point[lane] = static_cast<std::int32_t>(point);
            for (std::size_t axis = 0; axis < 3; ++axis)
                block.rest_m[axis][lane] = rest_m[point][static_cast<int>(axis)];
            const Vec3f r = (rest_m[point] - centre) * inverse_spacing;
            float total = 0.0f;
            for (std::size_t n = 0; n < static_cast<std::size_t>(carriers.count); ++n) {
                const Vec3f d = r - Vec3f(links[static_cast<std::size_t>(carriers.cell[n])].step);
                total += weight[n][lane] = embedding_kernel(glm::dot(d, d));
            }
            if (total > 0.0f)
                for (auto& w : weight) w[lane] /= total;
            else if (carriers.count > 0)
                weight[0][lane] = 1.0f;
        }
        block.first_carrier = static_cast<std::int32_t>(carrier_phyxel_.size());
        for (std::size_t n = 0; n < static_cast<std::size_t>(carriers.count); ++n) {
            if (std::all_of(weight[n].begin(), weight[n].end(), [](float w) { return w == 0.0f; })) continue;
            carrier_phyxel_.push_back(static_cast<std::int32_t>(carriers.phyxel[n]));
            weight_.insert(weight_.end(), weight[n].begin(), weight[n].end());
            ++block.carriers;
        }
        blocks_.push_back(block);
    }
}

void EmbeddedPoints::move(const tissue::Model& model, const tissue::State& state, const Work& work,
                          std::span<Vec3f> world_m, std::span<Mat3f> deformation_gradient) {
    move_with(model, state.displacement_m, work.gradient, world_m, deformation_gradient);
}

void EmbeddedPoints::move(const tissue::Model& model, const Pose& pose, std::span<Vec3f> world_m,
                          std::span<Mat3f> deformation_gradient) {
    move_with(model, pose.displacement_m, pose.gradient, world_m, deformation_gradient);
}

void EmbeddedPoints::move_with(const tissue::Model& model, const std::array<Array<float>, 3>& displacement_m,
                               const std::array<Array<float>, 9>& gradient, std::span<Vec3f> world_m,
                               std::span<Mat3f> deformation_gradient) {
    assert(world_m.size() == points_ && (deformation_gradient.empty() || deformation_gradient.size() == points_));
    View view;
    view.blocks = blocks_.data();
    view.carrier_phyxel = carrier_phyxel_.data();
    view.weight = weight_.data();
    for (std::size_t e = 0; e < 9; ++e) view.field[3 + e] = gradient[e].data();
    for (std::size_t r = 0; r < 3; ++r) view.field[r] = offset_m_[r].data();
    view.world_m = world_m.data();
    view.deformation_gradient = deformation_gradient.empty() ? nullptr : deformation_gradient.data();

    parallel_for("deformation.embed_fields", model.phyxels.first, model.phyxels.last, kCellsPerChunk,
                 [&](std::int64_t low, std::int64_t high) {
                     const float* x = centre_m_[0].data();
                     const float* y = centre_m_[1].data();
                     const float* z = centre_m_[2].data();
                     for (std::size_t r = 0; r < 3; ++r) {
                         const float* u = displacement_m[r].data();
                         const float* gx = view.field[3 + 3 * r];
                         const float* gy = view.field[4 + 3 * r];
                         const float* gz = view.field[5 + 3 * r];
                         float* a = offset_m_[r].data();
                         for (std::int64_t p = low; p < high; ++p)
                             a[p] = u[p] - (gx[p] * x[p] + gy[p] * y[p] + gz[p] * z[p]);
                     }
                 });
    parallel_for("deformation.embed_blocks", 0, static_cast<std::int64_t>(blocks_.size()), kBlocksPerChunk,
                 [&](std::int64_t low, std::int64_t high) { move_blocks(view, low, high); });
}

}  // namespace calot::deformation

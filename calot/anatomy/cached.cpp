#include "calot/anatomy/cached.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "calot/base/parallel.h"

namespace calot::anatomy {

namespace {

class CachedShape final : public Shape {
  public:
    CachedShape(const Shape& shape, double spacing_m, std::int64_t max_points);
    double distance_m(const Vec3& position_m) const override;
    Box bounds_m() const override { return bounds_; }

  private:
    static constexpr int kBlock = 4;  // points along the edge of a block

    void sample_block(const Shape& shape, const Int3& block);
    float& at(int x, int y, int z) {
        return values_[static_cast<std::size_t>((std::int64_t{z} * size_.y + y) * size_.x + x)];
    }

    Box bounds_;
    Vec3 origin_m_{0.0};
    double spacing_ = 0.0;
    Int3 size_{0};  ///< points: a multiple of kBlock, plus one
    std::vector<float> values_;
};

CachedShape::CachedShape(const Shape& shape, double spacing_m, std::int64_t max_points)
    : bounds_(shape.bounds_m()), spacing_(spacing_m) {
    Int3 blocks;
    for (;; spacing_ *= 1.1) {
        blocks = Int3(glm::ceil((bounds_.high - bounds_.low) / (kBlock * spacing_) + 0.5));
        size_ = kBlock * blocks + 1;
        if (std::int64_t{size_.x} * size_.y * size_.z <= max_points) break;
    }
    origin_m_ = 0.5 * (bounds_.low + bounds_.high) - 0.5 * spacing_ * Vec3(size_ - 1);
    values_.resize(static_cast<std::size_t>(std::int64_t{size_.x} * size_.y * size_.z));
    // Corners of blocks first, then what lies between them, in layers of blocks (each point is written by one layer).
    parallel_for("anatomy.cache_corners", 0, blocks.z + 1, 1, [&](std::int64_t begin, std::int64_t end) {
        for (int z = static_cast<int>(begin); z < end; ++z)
            for (int y = 0; y <= blocks.y; ++y)
                for (int x = 0; x <= blocks.x; ++x)
                    at(kBlock * x, kBlock * y, kBlock * z) =
                        static_cast<float>(shape.distance_m(origin_m_ + kBlock * spacing_ * Vec3(x, y, z)));
    });
    parallel_for("anatomy.cache_blocks", 0, blocks.z + 1, 1, [&](std::int64_t begin, std::int64_t end) {
        for (int z = static_cast<int>(begin); z < end; ++z)
            for (int y = 0; y <= blocks.y; ++y)
                for (int x = 0; x <= blocks.x; ++x) sample_block(shape, {x, y, z});
    });
}

void CachedShape::sample_block(const Shape& shape, const Int3& block) {
    // The block's eight corners; on the far sides of the grid a block has no extent.
    const Int3 low = kBlock * block, high = glm::min(low + kBlock, size_ - 1);
    std::array<float, 8> corner;
    float nearest = 1e9f;
    for (int k = 0; k < 8; ++k) {
        corner[static_cast<std::size_t>(k)] =
            at(k & 1 ? high.x : low.x, k & 2 ? high.y : low.y, k & 4 ? high.z : low.z);
        nearest = std::min(nearest, std::abs(corner[static_cast<std::size_t>(k)]));
    }
    // No point of the block is farther from a corner than half its diagonal: beyond that no surface crosses it. One
    // cell more keeps the coarse values away from the surface.
    const bool far = nearest > (0.5 * std::sqrt(3.0) * kBlock + 1.0) * kDistanceSlack * spacing_;
    for (int z = low.z; z < std::max(high.z, low.z + 1); ++z)
        for (int y = low.y; y < std::max(high.y, low.y + 1); ++y)
            for (int x = low.x; x < std::max(high.x, low.x + 1); ++x) {
                if (x % kBlock == 0 && y % kBlock == 0 && z % kBlock == 0) continue;
                if (!far) {
                    at(x, y, z) = static_cast<float>(shape.distance_m(origin_m_ + spacing_ * Vec3(x, y, z)));
                    continue;
                }
                const Vec3f t = Vec3f(Int3(x, y, z) - low) / static_cast<float>(kBlock);
                auto mix = [](float a, float b, float s) { return a + (b - a) * s; };
                const float near_side = mix(mix(corner[0], corner[1], t.x), mix(corner[2], corner[3], t.x), t.y);
                const float far_side = mix(mix(corner[4], corner[5], t.x), mix(corner[6], corner[7], t.x), t.y);
                at(x, y, z) = mix(near_side, far_side, t.z);
            }
}

double CachedShape::distance_m(const Vec3& position_m) const {
    const Vec3 grid = (position_m - origin_m_) / spacing_;
    const Vec3 held = glm::clamp(grid, Vec3(0.0), Vec3(size_ - 1));
    const Int3 cell = glm::min(Int3(held), size_ - 2);
    const Vec3 t = held - Vec3(cell);
    const float* v = &values_[static_cast<std::size_t>((std::int64_t{cell.z} * size_.y + cell.y) * size_.x + cell.x)];
    const std::int64_t row = size_.x, plane = std::int64_t{size_.x} * size_.y;
    auto mix = [](double a, double b, double s) { return a + (b - a) * s; };
    auto layer = [&](const float* w) { return mix(mix(w[0], w[1], t.x), mix(w[row], w[row + 1], t.x), t.y); };
    const double inside = mix(layer(v), layer(v + plane), t.z);
    // Outside the grid: the grid is convex and holds the solid, so d(p)^2 >= |p - c|^2 + d(c)^2 with c the nearest
    // point of the grid (the angle at c is obtuse for every point of the solid).
    const Vec3 beyond = grid - held;
    const double square = glm::dot(beyond, beyond);
    return square == 0.0 ? inside : std::sqrt(square * spacing_ * spacing_ + inside * inside);
}

}  // namespace

ShapePtr make_cached(const ShapePtr& shape, double spacing_m, std::int64_t max_points) {
    return std::make_shared<CachedShape>(*shape, spacing_m, max_points);
}

}  // namespace calot::anatomy

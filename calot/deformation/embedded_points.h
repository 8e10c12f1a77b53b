#pragma once
// Points embedded again and again: surface vertices, every frame. What depends on rest geometry and links alone (which
// phyxels carry a point, and with which weights) is kept; moving the points is then sums of products only.
//
// Points are kept in blocks of 16 that share an owner's phyxel, and with it their carriers: a block's lanes are its
// points, and the twelve numbers of a carrier (a_j, G_j with u = a_j + G_j X) are the same for all lanes. No gathers.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "calot/base/array.h"
#include "calot/deformation/embedding.h"

namespace calot::deformation {

class EmbeddedPoints {
  public:
    /// For the points and owners of embed_points. To be called again whenever they, or State::links, changed.
    void rebuild(const tissue::Model& model, const tissue::State& state, std::span<const Vec3f> rest_m,
                 std::span<const std::int64_t> owner);
    void rebuild(const tissue::Model& model, const Pose& pose, std::span<const Vec3f> rest_m,
                 std::span<const std::int64_t> owner);

    /// As embed_points does, to rounding; the same bytes for any number of threads.
    void move(const tissue::Model& model, const tissue::State& state, const Work& work, std::span<Vec3f> world_m,
              std::span<Mat3f> deformation_gradient = {});
    void move(const tissue::Model& model, const Pose& pose, std::span<Vec3f> world_m,
              std::span<Mat3f> deformation_gradient = {});

    std::size_t size() const { return points_; }

    static constexpr int kLanes = 16;
    /// Points that share a phyxel; unused lanes at the end repeat nothing and are not written.
    struct Block {
        std::int32_t first_carrier = 0;  ///< into carrier_phyxel_ and, times kLanes, weight_
        std::int16_t carriers = 0;
        std::int16_t points = 0;
        std::array<std::int32_t, kLanes> point{};
        alignas(64) std::array<std::array<float, kLanes>, 3> rest_m{};
    };
    /// What a kernel reads. Fields are planar over phyxel cells.
    struct View {
        const Block* blocks;
        const std::int32_t* carrier_phyxel;
        const float* weight;
        std::array<const float*, 12> field;  ///< a (3), G (9, row-major)
        Vec3f* world_m;
        Mat3f* deformation_gradient;  ///< null = not wanted
    };

  private:
    template <class FindCarriers>
    void rebuild_with(const tissue::Model& model, std::span<const Vec3f> rest_m, std::span<const std::int64_t> owner,
                      const FindCarriers& find);
    void move_with(const tissue::Model& model, const std::array<Array<float>, 3>& displacement_m,
                   const std::array<Array<float>, 9>& gradient, std::span<Vec3f> world_m,
                   std::span<Mat3f> deformation_gradient);

    std::size_t points_ = 0;
    std::vector<Block, AlignedAllocator<Block>> blocks_;
    Array<std::int32_t> carrier_phyxel_;
    Array<float> weight_;
    std::array<Array<float>, 3> centre_m_;            ///< [phyxels.cells] rest positions
    std::array<Array<float>, 3> offset_m_;            ///< [phyxels.cells] a_j = u_j - G_j X_j
    std::vector<std::array<std::int64_t, 2>> order_;  ///< scratch: sorting key and point
};

/// Moves the points of blocks [begin, end).
void move_blocks(const EmbeddedPoints::View& view, std::int64_t begin, std::int64_t end);

}  // namespace calot::deformation

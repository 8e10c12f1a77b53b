#pragma once
// The arithmetic of a block's vertices, many at a time: field values at points, then places and normals on edges.
// Sums and products are separate and roots and quotients are exact, so that every instruction set and the scalar
// reference give the same bytes.

#include <array>
#include <cstdint>

#include "calot/surface/block_grid.h"
#include "calot/surface/field.h"

namespace calot::surface {

inline constexpr std::size_t kBatchPadding = 16;  ///< the widest vector may run past the end

/// Points of one block.
struct PointBatch {
    static constexpr std::size_t kPoints = Window::kEdge * Window::kEdge * Window::kEdge;
    template <class T>
    using Lane = std::array<T, (kPoints + 15) / 16 * 16 + kBatchPadding>;  // whole cache lines
    std::size_t count = 0;
    alignas(64) Lane<float> weight;                ///< Moments::weight
    alignas(64) std::array<Lane<float>, 3> mean;   ///< Moments::mean
    alignas(64) Lane<float> present;               ///< 1 or 0
    alignas(64) std::array<Lane<float>, 3> slope;  ///< Moments::slope
    alignas(64) Lane<float> value;                 ///< out: the field

    void add(const Moments& m, bool is_present) {
        weight[count] = static_cast<float>(m.weight);
        present[count] = is_present ? 1.0f : 0.0f;
        for (int k = 0; k < 3; ++k) {
            mean[static_cast<std::size_t>(k)][count] = static_cast<float>(m.mean[k]);
            slope[static_cast<std::size_t>(k)][count] = static_cast<float>(m.slope[k]);
        }
        ++count;
    }
};

/// Edges along one axis. Components are turned: first along the edge, then the next two axes.
struct EdgeBatch {
    static constexpr std::size_t kEdges = kBlock * kBlock * kBlock;
    using Lane = std::array<float, kEdges + kBatchPadding>;
    std::size_t count = 0;
    alignas(64) Lane lower_value, upper_value;  ///< the field at both ends
    alignas(64) std::array<Lane, 3> lower_slope, upper_slope;
    alignas(64) Lane share;                  ///< out: of the way from the lower end to the upper
    alignas(64) std::array<Lane, 3> normal;  ///< out: unit

    void add(const PointBatch& points, std::size_t lower, std::size_t upper, int axis) {
        lower_value[count] = points.value[lower];
        upper_value[count] = points.value[upper];
        for (int k = 0; k < 3; ++k) {
            const auto from = static_cast<std::size_t>((axis + k) % 3), to = static_cast<std::size_t>(k);
            lower_slope[to][count] = points.slope[from][lower];
            upper_slope[to][count] = points.slope[from][upper];
        }
        ++count;
    }
};

/// Values of all points of the batch (field.h).
void evaluate(PointBatch& points);
void evaluate_reference(PointBatch& points);

/// Places and normals of all edges of the batch. Normals point out of the tissue; along the edge at least not into it,
/// where walls face each other across a gap.
void evaluate(EdgeBatch& edges);
void evaluate_reference(EdgeBatch& edges);

}  // namespace calot::surface

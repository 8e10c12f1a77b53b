#pragma once
// Which points and edges of a block are to be worked out.

#include <array>
#include <cstdint>

#include "calot/surface/block_grid.h"
#include "calot/surface/field.h"
#include "calot/surface/vertex_batch.h"

namespace calot::surface {

/// Points of a block (and the next ones) whose field changed, as bits of rows [9 z + y].
struct ChangedPoints {
    std::array<std::uint32_t, 81> rows{};

    /// The field changes within reach of a removed hexel. `p` counts from the block's lowest point.
    void add(const Int3& p) {
        const Int3 low = glm::max(p - kReach, Int3(0)), high = glm::min(p + kReach, Int3(kBlock));
        if (low.x > high.x) return;
        const std::uint32_t line = (2u << high.x) - (1u << low.x);
        for (int z = low.z; z <= high.z; ++z)
            for (int y = low.y; y <= high.y; ++y) rows[static_cast<std::size_t>(9 * z + y)] |= line;
    }
    /// Of the eight edges along an axis that begin in a row, those with a changed end.
    std::uint32_t edges(int row, int axis) const {
        const auto r = static_cast<std::size_t>(9 * (row >> 3) + (row & 7));
        const std::uint32_t here = rows[r];
        return (here | (axis == 0 ? here >> 1 : axis == 1 ? rows[r + 1] : rows[r + 9])) & 0xffu;
    }
};

/// Edges of a block whose vertices are to be worked out, by axis.
struct EdgeList {
    struct Edge {
        std::uint16_t place;   ///< of the vertex in the block
        std::uint8_t x, y, z;  ///< lower end
    };
    std::array<Edge, EdgeBatch::kEdges> edges;
    std::size_t count = 0;
};

/// Ends of edges, as bits of rows [9 z + y], and where they are in a PointBatch.
struct EndPoints {
    std::array<std::uint32_t, 81> rows{};
    std::array<std::uint16_t, PointBatch::kPoints> place;

    void add(int row, int axis, std::uint32_t line) {
        const auto r = static_cast<std::size_t>(9 * (row >> 3) + (row & 7));
        rows[r] |= axis == 0 ? line | line << 1 : line;
        if (axis == 1) rows[r + 1] |= line;
        if (axis == 2) rows[r + 9] |= line;
    }
    static constexpr std::size_t at(int x, int y, int z) { return static_cast<std::size_t>(9 * (9 * z + y) + x); }
    void evaluate_all(const Window& window, PointBatch& points) {
        points.count = 0;
        std::array<std::uint8_t, 81> filled;
        std::size_t rows_filled = 0;
        std::uint32_t any = 0;
        for (std::size_t row = 0; row < rows.size(); ++row) {
            filled[rows_filled] = static_cast<std::uint8_t>(row);
            rows_filled += rows[row] != 0;
            any |= rows[row];
        }
        for (int x = 0; x < Window::kEdge; ++x) {
            if (((any >> x) & 1u) == 0) continue;
            const Slice slice = slice_of(window, x);
            for (std::size_t k = 0; k < rows_filled; ++k) {
                if (((rows[filled[k]] >> x) & 1u) == 0) continue;
                const int y = filled[k] % 9, z = filled[k] / 9;
                place[at(x, y, z)] = static_cast<std::uint16_t>(points.count);
                points.add(moments_at(slice, y, z), window.test(x, y, z));
            }
        }
        evaluate(points);
    }
};

}  // namespace calot::surface

#pragma once
// One grid of the multigrid hierarchy: a symmetric 7-point matrix on a cube of cells, and the vectors on it.
//
//     (A x)_i = ground_i x_i + sum over six neighbours of g_ij (x_i - x_j)
//
// (Differences, not diagonal_i x_i - sum g_ij x_j: the rounding of the diagonal would act as a ground in every cell,
// and leak 2e-4 of the current in a window of 96^3 cells.)
//
// g[axis][i] couples cell i with the next along the axis; ground couples it with what is fixed (electrode) or far
// (return electrode). Cells that are not unknown have g = ground = 0 all around, hence weight 0: they need no mask.
//
//     index = first + a + row * b + plane * c,  a fastest;  row is a multiple of 16, with padding in front and behind
//
// Cells are worked on in groups of 16 along a; `groups` lists those that hold an unknown, the others are skipped.

#include <array>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <vector>

#include "calot/base/array.h"
#include "calot/base/vec.h"

namespace calot::electric {

inline constexpr std::int64_t kGroup = 16;  ///< cells in a group: the widest vector

/// Groups of a parallel loop's task. A window of 64^3 cells is one task: its loops take tens of microseconds, and
/// starting a second thread costs more than it saves.
inline constexpr std::int64_t kTaskGroups = 16384;

/// A value for every cell of a level.
using Cells = std::span<float>;

/// Memory for vectors of one level. Arrays of half a megabyte would all begin on a page of their own, where loads wait
/// for stores whose addresses end alike; each starts five cache lines further into its page than the one before.
class CellStorage {
  public:
    /// Zeros for each of `vectors`, the first being the `slot`-th of all that are used together.
    void allocate(std::int64_t length, int slot, std::initializer_list<Cells*> vectors);

  private:
    Array<float> memory_;
};

struct Level {
    CellStorage storage;
    int cells = 0;            ///< along each edge of the cube
    int rows = 0;             ///< `cells` rounded up to even, so that 2x2x2 aggregates are whole
    std::int64_t row = 0;     ///< offset along the second axis
    std::int64_t plane = 0;   ///< offset along the third axis
    std::int64_t first = 0;   ///< of cell (0, 0, 0)
    std::int64_t length = 0;  ///< of the arrays

    std::array<Cells, 3> g;
    Cells ground;
    Cells weight;    ///< damping / (ground + sum of g): damped Jacobi. 0 where there is no unknown
    Cells right;     ///< b of A z = b; on the finest level the residual of the outer iteration
    Cells solution;  ///< z
    Cells scratch;   ///< residual, then the smoothed z

    struct Group {
        std::int32_t at;      ///< index of its first cell
        std::int32_t child;   ///< finer level: index of the cell (2a, 2b, 2c)
        std::int32_t parent;  ///< coarser level: index of the cell (a/2, b/2, c/2)
    };
    std::vector<Group> all;     ///< groups there can be, by place; with their relations once in a hierarchy
    std::vector<Group> groups;  ///< reserved for all

    static Level make(int cells);
    Level() = default;
    Level(Level&&) = default;  // not copied: its vectors point into its storage
    Level& operator=(Level&&) = default;
    std::int64_t index(int a, int b, int c) const { return first + a + row * b + plane * c; }
    Int3 coordinates(std::int64_t index) const {
        const auto offset = static_cast<int>(index - first), in_plane = offset % static_cast<int>(plane);
        return {in_plane % static_cast<int>(row), in_plane / static_cast<int>(row), offset / static_cast<int>(plane)};
    }
    std::int64_t group_capacity() const { return row / kGroup * rows * rows; }
    /// Planes of a parallel loop's task that is worth its start.
    std::int64_t task_planes() const { return kTaskGroups * kGroup / plane + 1; }
};

}  // namespace calot::electric

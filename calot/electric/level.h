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
#include <vector>

#include "calot/base/array.h"

namespace calot::electric {

inline constexpr std::int64_t kGroup = 16;  ///< cells in a group: the widest vector

struct Level {
    int cells = 0;            ///< along each edge of the cube
    int rows = 0;             ///< `cells` rounded up to even, so that 2x2x2 aggregates are whole
    std::int64_t row = 0;     ///< offset along the second axis
    std::int64_t plane = 0;   ///< offset along the third axis
    std::int64_t first = 0;   ///< of cell (0, 0, 0)
    std::int64_t length = 0;  ///< of the arrays

    std::array<Array<float>, 3> g;
    Array<float> ground;
    Array<float> weight;    ///< damping / (ground + sum of g): damped Jacobi. 0 where there is no unknown
    Array<float> right;     ///< b of A z = b; on the finest level the residual of the outer iteration
    Array<float> solution;  ///< z
    Array<float> scratch;   ///< residual, then the smoothed z

    struct Group {
        std::int32_t at;      ///< index of its first cell
        std::int32_t child;   ///< finer level: index of the cell (2a, 2b, 2c)
        std::int32_t parent;  ///< coarser level: index of the cell (a/2, b/2, c/2)
    };
    std::vector<Group> groups;  ///< reserved for all

    static Level make(int cells);
    std::int64_t index(int a, int b, int c) const { return first + a + row * b + plane * c; }
    std::int64_t group_capacity() const { return row / kGroup * rows * rows; }
};

}  // namespace calot::electric

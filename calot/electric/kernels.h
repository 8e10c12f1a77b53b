#pragma once
// The loops over a level. Each exists twice with the same bytes as result: plain (kernels_reference.cpp) and wide
// (kernels_simd.cpp). Multiplication and addition stay separate and sums keep 64 partial sums in double, one per place
// in four consecutive groups, so that the instruction set does not show in the result.

#include <cstdint>

#include "calot/electric/level.h"

namespace calot::electric {

/// Damping of Jacobi smoothing.
inline constexpr float kDamping = 0.85f;
/// Coarse corrections are scaled by this: constant aggregates make the coarse grid up to twice too stiff (Braess 1995).
inline constexpr float kCorrection = 1.6f;

/// What an outer iteration works on, beside the finest level's vectors.
struct Krylov {
    CellStorage storage;
    Cells x;  ///< the potential
    Cells p;  ///< search direction
};

/// Partial sums of a dot product: one per place in this many consecutive groups. (Several, so that additions need not
/// wait for one another.)
inline constexpr std::int64_t kSums = 4 * kGroup;

/// Partial sums of heat, one per place in a group.
struct HeatSums {
    double kept[kGroup] = {};
    double rest[kGroup] = {};
};

struct Kernels {
    /// out[k] = conductivity[k] where the bit (first + k) is set in `present` or `held`, else 0.
    void (*gather)(const float* conductivity, const std::uint8_t* present, const std::uint8_t* held, std::int64_t first,
                   std::int64_t count, float* out);
    /// g on faces between cells of conductivity sigma, in S/m: harmonic means. Groups by their first cells.
    void (*faces)(Level& level, const float* sigma, std::int64_t begin, std::int64_t end);
    /// weight from g and ground.
    void (*weights)(Level& level, std::int64_t begin, std::int64_t end);
    /// Galerkin sum of 2x2x2 cells, one plane of the coarse level: g and ground.
    void (*aggregate)(const Level& fine, Level& coarse, int plane);

    // Over level.groups[begin, end):
    /// scratch = A p; returns p . A p.
    double (*apply)(Level& level, const float* p, std::int64_t begin, std::int64_t end);
    /// right -= A x, solution = weight right; returns right . right.
    double (*start)(Level& level, const float* x, std::int64_t begin, std::int64_t end);
    /// x += alpha p, right -= alpha scratch, solution = weight right; returns right . right.
    double (*advance)(Level& level, Krylov& krylov, float alpha, std::int64_t begin, std::int64_t end);
    /// p = scratch + beta p.
    void (*direction)(const Level& level, Krylov& krylov, float beta, std::int64_t begin, std::int64_t end);
    /// scratch = right - A solution.
    void (*residual)(Level& level, std::int64_t begin, std::int64_t end);
    /// scratch = solution + weight (right - A solution); returns right . scratch.
    double (*smooth)(Level& level, std::int64_t begin, std::int64_t end);
    /// coarse right = sum of the fine scratch, coarse solution = weight right. Groups of the coarse level.
    void (*restrict_residual)(const Level& fine, Level& coarse, std::int64_t begin, std::int64_t end);
    /// fine solution += kCorrection * coarse solution. Groups of the fine level.
    void (*correct)(Level& fine, const Level& coarse, std::int64_t begin, std::int64_t end);
    /// out = Joule heat per cell in units of s V^2: sum over faces of (g dphi)^2 / (2 sigma). All groups of [begin,
    /// end).
    void (*heat)(const Level& level, const float* sigma, const float* phi, float* out, std::int64_t begin,
                 std::int64_t end);
    /// heat[k] is kept where the bit (first + k) of `present` is set, else becomes 0; adds both to their sums.
    void (*split)(float* heat, const std::uint8_t* present, std::int64_t first, std::int64_t count, HeatSums& sums);
};

Kernels reference_kernels();
Kernels wide_kernels();  ///< for the instruction set that is the best here and now

}  // namespace calot::electric

#pragma once
// Geometric multigrid by 2x2x2 aggregation, and conjugate gradients preconditioned by one V-cycle of it.
//
// One V-cycle: damped Jacobi from zero, constant-aggregate coarse correction times 1.6, damped Jacobi. Whatever the
// correction factor, the cycle is symmetric positive definite: it is Jacobi's symmetrisation plus a congruence of the
// coarse cycle.

#include <vector>

#include "calot/electric/kernels.h"
#include "calot/electric/level.h"

namespace calot::electric {

struct Multigrid {
    Kernels kernels;
    std::vector<Level> levels;  ///< finest first
    Krylov krylov;

    /// Norms and scalars of the outer iteration.
    double right_norm2 = 0.0;  ///< of the electrode's contribution
    double residual_norm2 = 0.0;
    double rho = 0.0;  ///< r . z
    int iterations = 0;
};

Multigrid make_multigrid(int cells, const Kernels& kernels);

/// From g and ground of the finest level: all matrices, groups and clean vectors.
void build(Multigrid& grid);

/// An entry of the right-hand side: all others are 0.
struct RightEntry {
    std::int32_t cell;
    float value;
};

/// Starts conjugate gradients from krylov.x (or from 0, where that is nearer to the solution).
void begin(Multigrid& grid, const std::vector<RightEntry>& right);

/// At most `count` further iterations; true when |b - A x| <= relative_residual |b|. False as well on breakdown
/// (is_finite then tells).
bool iterate(Multigrid& grid, int count, double relative_residual);
bool is_finite(const Multigrid& grid);

/// scratch = approximately A^-1 right, from right and solution = weight right; returns right . scratch. (For tests.)
double precondition(Multigrid& grid);

}  // namespace calot::electric

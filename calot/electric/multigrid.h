#pragma once
// Conjugate gradients, preconditioned by geometric multigrid with 2x2x2 aggregates.
//
//     z = kAdded weight r + 1.6 P (coarse cycle) P^T r
//
// On the finest level Jacobi and the coarse correction are added: two sweeps over its cells an iteration, where a
// chained V-cycle takes five. It wants 1.6 times the iterations, each of 0.4 times the cost, and comes in finer slices.
// Coarse levels (an eighth of the cells) are a V-cycle: damped Jacobi from zero, correction, damped Jacobi. All is
// symmetric positive definite whatever the factors.
//
// r . z needs no sweep of its own: it is kAdded (r . weight r) + 1.6 (P^T r) . (coarse z).

#include <vector>

#include "calot/electric/kernels.h"
#include "calot/electric/level.h"

namespace calot::electric {

struct Multigrid {
    Kernels kernels;
    std::vector<Level> levels;  ///< finest first; at least two
    Krylov krylov;
    std::vector<Norms> parts;  ///< of the chunks of a loop

    /// Norms and scalars of the outer iteration.
    double right_norm2 = 0.0;  ///< of the electrode's contribution
    Norms norms;               ///< of the present residual
    double rho = 0.0;          ///< r . z of the iteration before
    int iterations = 0;
};

Multigrid make_multigrid(int cells, const Kernels& kernels);

/// An entry of the right-hand side: all others are 0.
struct RightEntry {
    std::int32_t cell;
    float value;
};

/// From g and ground of the finest level, whose groups are listed: its weights.
void build_finest(Multigrid& grid);
/// All coarse matrices and groups.
void build_coarse(Multigrid& grid);

/// Starts from the multiple of krylov.x that is nearest to the solution: alpha = x.b / x.Ax.
void begin(Multigrid& grid, const std::vector<RightEntry>& right);

/// At most `count` further iterations; true when |b - A x| <= relative_residual |b|. False as well on breakdown
/// (is_finite then tells).
bool iterate(Multigrid& grid, int count, double relative_residual);
bool is_finite(const Multigrid& grid);
double relative_residual(const Multigrid& grid);

/// x.b / x.Ax of the present x: scaled by it, the heat of the field equals the current that enters, to the last digit,
/// however far the iteration has come.
double best_scale(const Multigrid& grid, const std::vector<RightEntry>& right);

/// z of the present residual into krylov.p (as a first direction); returns r . z. (For tests.)
double precondition(Multigrid& grid);

}  // namespace calot::electric

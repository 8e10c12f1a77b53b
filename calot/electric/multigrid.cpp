#include "calot/electric/multigrid.h"

#include <algorithm>
#include <cmath>

#include "calot/base/parallel.h"

namespace calot::electric {

namespace {

constexpr std::int64_t kChunk = kTaskGroups;
constexpr int kCoarsest = 2;           ///< cells along an edge where coarsening ends
constexpr int kCoarsestSweeps = 4;     ///< even: each pair ends where it began

std::int64_t size(const Level& level) {
    return static_cast<std::int64_t>(level.groups.size());
}

void restrict_to(const Kernels& kernels, const Level& fine, const Cells values, Level& coarse) {
    parallel_for("electric.restrict", 0, size(coarse), kChunk,
                 [&](std::int64_t b, std::int64_t e) { kernels.restrict_residual(fine, values.data(), coarse, b, e); });
}
void correct(const Kernels& kernels, Level& fine, const Level& coarse) {
    parallel_for("electric.correct", 0, size(fine), kChunk,
                 [&](std::int64_t b, std::int64_t e) { kernels.correct(fine, coarse, b, e); });
}
void residual(const Kernels& kernels, Level& level) {
    parallel_for("electric.residual", 0, size(level), kChunk,
                 [&](std::int64_t b, std::int64_t e) { kernels.residual(level, b, e); });
}
double smooth(const Kernels& kernels, Level& level) {
    return parallel_sum("electric.smooth", 0, size(level), kChunk,
                        [&](std::int64_t b, std::int64_t e) { return kernels.smooth(level, b, e); });
}

/// Lists all groups.
void list_all(Level& level) {
    level.groups.assign(level.all.begin(), level.all.end());
}

/// Keeps the groups that hold an unknown. Those that are skipped must read as zero, so the others' vectors are wiped.
void list_unknown(Level& level) {
    level.groups.clear();
    for (const Level::Group& group : level.all) {
        const std::int64_t at = group.at;
        const float* weight = level.weight.data() + at;
        float largest = 0.0f;
        for (std::int64_t k = 0; k < kGroup; ++k) largest = std::max(largest, weight[k]);
        if (largest > 0.0f) {
            level.groups.push_back(group);
            continue;
        }
        for (auto* values : {&level.right, &level.solution, &level.scratch})
            std::fill_n(values->begin() + at, kGroup, 0.0f);
    }
}

/// Where the children and parents of each group lie.
void relate(Level& level, const Level* finer, const Level* coarser) {
    for (Level::Group& group : level.all) {
        const Int3 cell = level.coordinates(group.at);
        if (finer != nullptr) group.child = static_cast<std::int32_t>(finer->index(2 * cell.x, 2 * cell.y, 2 * cell.z));
        if (coarser != nullptr)
            group.parent = static_cast<std::int32_t>(coarser->index(cell.x / 2, cell.y / 2, cell.z / 2));
    }
}

}  // namespace

void CellStorage::allocate(std::int64_t length, int slot, std::initializer_list<Cells*> vectors) {
    constexpr std::size_t kPage = 1024, kStep = 5 * kGroup;  // floats
    const std::size_t room = (static_cast<std::size_t>(length) + kPage - 1) / kPage * kPage;
    const auto count = vectors.size(), first = static_cast<std::size_t>(slot);
    memory_.assign(count * room + (first + count) * kStep, 0.0f);
    std::size_t k = 0;
    for (Cells* vector : vectors) {
        *vector = Cells(memory_.data() + k * room + (first + k) * kStep, static_cast<std::size_t>(length));
        ++k;
    }
}

Level Level::make(int cells) {
    Level level;
    level.cells = cells;
    level.rows = (cells + 1) / 2 * 2;
    level.row = (level.rows + kGroup - 1) / kGroup * kGroup;
    level.plane = level.row * level.rows;
    // Neighbours reach a plane and a vector beyond; restriction and aggregation read up to two groups further.
    level.first = level.plane + 4 * kGroup;
    level.length = level.first + level.plane * level.rows + level.plane + 4 * kGroup;
    level.storage.allocate(level.length, 0,
                           {&level.g[0], &level.g[1], &level.g[2], &level.ground, &level.weight, &level.right,
                            &level.solution, &level.scratch});
    level.groups.reserve(static_cast<std::size_t>(level.group_capacity()));
    for (std::int64_t at = level.first; at < level.first + level.group_capacity() * kGroup; at += kGroup)
        level.all.push_back({static_cast<std::int32_t>(at), 0, 0});
    return level;
}

Multigrid make_multigrid(int cells, const Kernels& kernels) {
    Multigrid grid;
    grid.kernels = kernels;
    grid.levels.push_back(Level::make(cells));
    do grid.levels.push_back(Level::make(grid.levels.back().rows / 2));
    while (grid.levels.back().cells > kCoarsest);
    for (std::size_t l = 0; l < grid.levels.size(); ++l)
        relate(grid.levels[l], l > 0 ? &grid.levels[l - 1] : nullptr,
               l + 1 < grid.levels.size() ? &grid.levels[l + 1] : nullptr);
    grid.krylov.storage.allocate(grid.levels[0].length, 8, {&grid.krylov.x, &grid.krylov.p});
    grid.parts.resize(static_cast<std::size_t>(grid.levels[0].group_capacity() / kChunk + 1));
    return grid;
}

void build_finest(Multigrid& grid) {
    Level& fine = grid.levels[0];
    parallel_for("electric.weights", 0, size(fine), kChunk,
                 [&](std::int64_t b, std::int64_t e) { grid.kernels.weights(fine, b, e); });
}

void build_coarse(Multigrid& grid) {
    const Kernels& kernels = grid.kernels;
    for (std::size_t l = 1; l < grid.levels.size(); ++l) {
        Level& level = grid.levels[l];
        parallel_for("electric.aggregate", 0, level.cells, level.task_planes(), [&](std::int64_t low, std::int64_t high) {
            for (std::int64_t c = low; c < high; ++c) kernels.aggregate(grid.levels[l - 1], level, static_cast<int>(c));
        });
        list_all(level);
        parallel_for("electric.weights", 0, size(level), kChunk,
                     [&](std::int64_t b, std::int64_t e) { kernels.weights(level, b, e); });
        list_unknown(level);
    }
}

namespace {

/// A loop over the groups of the finest level whose chunks add their norms in order.
template <class Body>
Norms sum_norms(const char* name, Multigrid& grid, const Body& body) {
    const std::int64_t groups = size(grid.levels[0]);
    parallel_for(name, 0, groups, kChunk, [&](std::int64_t b, std::int64_t e) {
        grid.parts[static_cast<std::size_t>(b / kChunk)] = body(b, e);
    });
    Norms sum;
    for (std::int64_t chunk = 0; chunk * kChunk < groups; ++chunk) {
        const Norms& part = grid.parts[static_cast<std::size_t>(chunk)];
        sum.residual += part.residual;
        sum.weighted += part.weighted;
    }
    return sum;
}

double apply(Multigrid& grid, const Cells vector) {
    Level& fine = grid.levels[0];
    return parallel_sum("electric.apply", 0, size(fine), kChunk,
                        [&](std::int64_t b, std::int64_t e) { return grid.kernels.apply(fine, vector.data(), b, e); });
}

/// From P^T r: levels[1].solution approximately its solution; returns their product.
double coarse_cycle(Multigrid& grid) {
    const Kernels& kernels = grid.kernels;
    std::vector<Level>& levels = grid.levels;
    restrict_to(kernels, levels[0], levels[0].right, levels[1]);
    for (std::size_t l = 1; l + 1 < levels.size(); ++l) {
        residual(kernels, levels[l]);
        restrict_to(kernels, levels[l], levels[l].scratch, levels[l + 1]);
    }
    double product = 0.0;
    for (int sweep = 0; sweep < kCoarsestSweeps; ++sweep) {
        product = smooth(kernels, levels.back());
        std::swap(levels.back().solution, levels.back().scratch);
    }
    for (std::size_t l = levels.size() - 1; l-- > 1;) {
        correct(kernels, levels[l], levels[l + 1]);
        product = smooth(kernels, levels[l]);
        std::swap(levels[l].solution, levels[l].scratch);
    }
    return product;
}

void direction(Multigrid& grid, double beta) {
    const Level& fine = grid.levels[0];
    parallel_for("electric.direction", 0, size(fine), kChunk, [&](std::int64_t b, std::int64_t e) {
        grid.kernels.direction(fine, grid.krylov, grid.levels[1].solution.data(), static_cast<float>(beta), b, e);
    });
}

double along_right(const Multigrid& grid, const std::vector<RightEntry>& right) {
    double sum = 0.0;
    for (const RightEntry& entry : right)
        sum +=
            static_cast<double>(entry.value) * static_cast<double>(grid.krylov.x[static_cast<std::size_t>(entry.cell)]);
    return sum;
}

}  // namespace

double precondition(Multigrid& grid) {
    const double coarse = coarse_cycle(grid);
    direction(grid, 0.0);
    return static_cast<double>(kAdded) * grid.norms.weighted + static_cast<double>(kCorrection) * coarse;
}

void begin(Multigrid& grid, const std::vector<RightEntry>& right) {
    Level& fine = grid.levels[0];
    grid.iterations = 0;
    grid.rho = 0.0;
    const double curvature = apply(grid, grid.krylov.x), along = along_right(grid, right);
    const double alpha = curvature > 0.0 && std::isfinite(curvature) ? along / curvature : 0.0;
    for (const Level::Group& group : fine.groups) std::fill_n(fine.right.begin() + group.at, kGroup, 0.0f);
    for (const RightEntry& entry : right) fine.right[static_cast<std::size_t>(entry.cell)] += entry.value;
    // |b|^2: several entries may share a cell, whose value is then their sum.
    grid.right_norm2 = 0.0;
    for (const RightEntry& entry : right)
        grid.right_norm2 +=
            static_cast<double>(entry.value) * static_cast<double>(fine.right[static_cast<std::size_t>(entry.cell)]);
    grid.norms = sum_norms("electric.start", grid, [&](std::int64_t b, std::int64_t e) {
        return grid.kernels.start(fine, grid.krylov, static_cast<float>(alpha), b, e);
    });
}

bool iterate(Multigrid& grid, int count, double relative_residual) {
    Level& fine = grid.levels[0];
    const double goal = relative_residual * relative_residual * grid.right_norm2;
    for (int k = 0; k < count && grid.norms.residual > goal; ++k) {
        const double coarse = coarse_cycle(grid);
        const double rho =
            static_cast<double>(kAdded) * grid.norms.weighted + static_cast<double>(kCorrection) * coarse;
        direction(grid, grid.rho > 0.0 ? rho / grid.rho : 0.0);
        grid.rho = rho;
        const double curvature = apply(grid, grid.krylov.p);
        if (!(curvature > 0.0) || !(rho > 0.0)) return false;
        grid.norms = sum_norms("electric.advance", grid, [&](std::int64_t b, std::int64_t e) {
            return grid.kernels.advance(fine, grid.krylov, static_cast<float>(rho / curvature), b, e);
        });
        ++grid.iterations;
    }
    return grid.norms.residual <= goal;
}

bool is_finite(const Multigrid& grid) {
    return std::isfinite(grid.norms.residual) && std::isfinite(grid.rho);
}

double relative_residual(const Multigrid& grid) {
    return grid.right_norm2 > 0.0 ? std::sqrt(grid.norms.residual / grid.right_norm2) : 0.0;
}

double best_scale(const Multigrid& grid, const std::vector<RightEntry>& right) {
    const Level& fine = grid.levels[0];
    const double along = along_right(grid, right);
    const double missing = parallel_sum("electric.scale", 0, size(fine), kChunk, [&](std::int64_t b, std::int64_t e) {
        return grid.kernels.dot(fine, grid.krylov.x.data(), fine.right.data(), b, e);
    });
    const double curvature = along - missing;  // x . A x, since A x = b - r
    return curvature > 0.0 && std::isfinite(curvature) ? along / curvature : 1.0;
}

}  // namespace calot::electric

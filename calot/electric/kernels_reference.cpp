// The loops of kernels.h, one cell at a time.

#include <algorithm>
#include <array>

#include "calot/electric/kernels.h"

namespace calot::electric {
namespace reference {

/// Partial sums, added in order at the end.
struct Sum {
    std::array<double, kSums> place{};
    /// `cell` counts from the first cell of the range.
    void add(std::int64_t cell, float product) {
        place[static_cast<std::size_t>(cell % kSums)] += static_cast<double>(product);
    }
    double total() const {
        double sum = 0.0;
        for (double value : place) sum += value;
        return sum;
    }
};

/// (A z)_i
float row_times(const Level& level, const float* z, std::int64_t i) {
    const float *gx = level.g[0].data(), *gy = level.g[1].data(), *gz = level.g[2].data();
    const std::int64_t row = level.row, plane = level.plane;
    const float here = z[i];
    float flow = gx[i] * (here - z[i + 1]) + gx[i - 1] * (here - z[i - 1]);
    flow = flow + (gy[i] * (here - z[i + row]) + gy[i - row] * (here - z[i - row]));
    flow = flow + (gz[i] * (here - z[i + plane]) + gz[i - plane] * (here - z[i - plane]));
    return flow + level.ground[static_cast<std::size_t>(i)] * here;
}

void gather(const Conductivity& tissue, std::int64_t first, std::int64_t count, float* out) {
    for (std::int64_t k = 0; k < count; ++k) out[k] = tissue.of(first + k);
}

void faces(Level& level, const float* sigma, std::int64_t begin, std::int64_t end) {
    const std::array<std::int64_t, 3> step{1, level.row, level.plane};
    for (std::int64_t n = begin; n < end; ++n)
        for (std::int64_t k = 0; k < kGroup; ++k) {
            const std::int64_t i = level.groups[static_cast<std::size_t>(n)].at + k;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const float here = sigma[i], there = sigma[i + step[axis]];
                level.g[axis][static_cast<std::size_t>(i)] = (2.0f * here) * there / std::max(here + there, 1e-30f);
            }
            level.ground[static_cast<std::size_t>(i)] = 0.0f;
        }
}

void weights(Level& level, std::int64_t begin, std::int64_t end) {
    const float *gx = level.g[0].data(), *gy = level.g[1].data(), *gz = level.g[2].data();
    for (std::int64_t n = begin; n < end; ++n)
        for (std::int64_t k = 0; k < kGroup; ++k) {
            const std::int64_t i = level.groups[static_cast<std::size_t>(n)].at + k;
            const auto at = static_cast<std::size_t>(i);
            float sum = level.ground[at] + (gx[i] + gx[i - 1]);
            sum = sum + (gy[i] + gy[i - level.row]);
            sum = sum + (gz[i] + gz[i - level.plane]);
            level.weight[at] = sum > 0.0f ? kDamping / sum : 0.0f;
        }
}

void aggregate(const Level& fine, Level& coarse, int plane) {
    for (int b = 0; b < coarse.cells; ++b)
        for (int a = 0; a < coarse.cells; ++a) {
            const std::int64_t f = fine.index(2 * a, 2 * b, 2 * plane);
            const auto to = static_cast<std::size_t>(coarse.index(a, b, plane));
            const float *gx = fine.g[0].data() + f, *gy = fine.g[1].data() + f, *gz = fine.g[2].data() + f;
            const float* ground = fine.ground.data() + f;
            const std::int64_t y = fine.row, z = fine.plane;
            auto four = [&](const float* v, std::int64_t k) { return (v[k] + v[k + y]) + (v[k + z] + v[k + y + z]); };
            coarse.g[0][to] = four(gx, 1);
            coarse.g[1][to] = (gy[y] + gy[y + z]) + (gy[y + 1] + gy[y + z + 1]);
            coarse.g[2][to] = (gz[z] + gz[y + z]) + (gz[z + 1] + gz[y + z + 1]);
            coarse.ground[to] = four(ground, 0) + four(ground, 1);
        }
}

double apply(Level& level, const float* p, std::int64_t begin, std::int64_t end) {
    Sum sum;
    for (std::int64_t n = begin; n < end; ++n)
        for (std::int64_t k = 0; k < kGroup; ++k) {
            const std::int64_t i = level.groups[static_cast<std::size_t>(n)].at + k;
            const float value = row_times(level, p, i);
            level.scratch[static_cast<std::size_t>(i)] = value;
            sum.add((n - begin) * kGroup + k, p[i] * value);
        }
    return sum.total();
}

double dot(const Level& level, const float* a, const float* b, std::int64_t begin, std::int64_t end) {
    Sum sum;
    for (std::int64_t n = begin; n < end; ++n)
        for (std::int64_t k = 0; k < kGroup; ++k) {
            const std::int64_t i = level.groups[static_cast<std::size_t>(n)].at + k;
            sum.add((n - begin) * kGroup + k, a[i] * b[i]);
        }
    return sum.total();
}

Norms start(Level& level, Krylov& krylov, float alpha, std::int64_t begin, std::int64_t end) {
    Sum residual, weighted;
    for (std::int64_t n = begin; n < end; ++n)
        for (std::int64_t k = 0; k < kGroup; ++k) {
            const auto i = static_cast<std::size_t>(level.groups[static_cast<std::size_t>(n)].at + k);
            krylov.x[i] = level.weight[i] > 0.0f ? alpha * krylov.x[i] : 0.0f;
            level.right[i] = level.right[i] - alpha * level.scratch[i];
            const std::int64_t place = (n - begin) * kGroup + k;
            residual.add(place, level.right[i] * level.right[i]);
            weighted.add(place, level.right[i] * (level.weight[i] * level.right[i]));
        }
    return {residual.total(), weighted.total()};
}

Norms advance(Level& level, Krylov& krylov, float alpha, std::int64_t begin, std::int64_t end) {
    Sum residual, weighted;
    for (std::int64_t n = begin; n < end; ++n)
        for (std::int64_t k = 0; k < kGroup; ++k) {
            const auto i = static_cast<std::size_t>(level.groups[static_cast<std::size_t>(n)].at + k);
            krylov.x[i] = krylov.x[i] + alpha * krylov.p[i];
            level.right[i] = level.right[i] - alpha * level.scratch[i];
            const std::int64_t place = (n - begin) * kGroup + k;
            residual.add(place, level.right[i] * level.right[i]);
            weighted.add(place, level.right[i] * (level.weight[i] * level.right[i]));
        }
    return {residual.total(), weighted.total()};
}

void direction(const Level& level, Krylov& krylov, const float* coarse, float beta, std::int64_t begin,
               std::int64_t end) {
    for (std::int64_t n = begin; n < end; ++n) {
        const Level::Group& group = level.groups[static_cast<std::size_t>(n)];
        for (std::int64_t k = 0; k < kGroup; ++k) {
            const auto i = static_cast<std::size_t>(group.at + k);
            const float own = (kAdded * level.weight[i]) * level.right[i];
            const float z = own + kCorrection * coarse[group.parent + k / 2];
            krylov.p[i] = level.weight[i] > 0.0f ? z + beta * krylov.p[i] : 0.0f;
        }
    }
}

void residual(Level& level, std::int64_t begin, std::int64_t end) {
    for (std::int64_t n = begin; n < end; ++n)
        for (std::int64_t k = 0; k < kGroup; ++k) {
            const std::int64_t i = level.groups[static_cast<std::size_t>(n)].at + k;
            const auto at = static_cast<std::size_t>(i);
            level.scratch[at] = level.right[at] - row_times(level, level.solution.data(), i);
        }
}

double smooth(Level& level, std::int64_t begin, std::int64_t end) {
    Sum sum;
    for (std::int64_t n = begin; n < end; ++n)
        for (std::int64_t k = 0; k < kGroup; ++k) {
            const std::int64_t i = level.groups[static_cast<std::size_t>(n)].at + k;
            const auto at = static_cast<std::size_t>(i);
            const float rest = level.right[at] - row_times(level, level.solution.data(), i);
            level.scratch[at] = level.solution[at] + level.weight[at] * rest;
            sum.add((n - begin) * kGroup + k, level.right[at] * level.scratch[at]);
        }
    return sum.total();
}

void restrict_residual(const Level& fine, const float* values, Level& coarse, std::int64_t begin, std::int64_t end) {
    for (std::int64_t n = begin; n < end; ++n) {
        const Level::Group& group = coarse.groups[static_cast<std::size_t>(n)];
        for (std::int64_t k = 0; k < kGroup; ++k) {
            const float* r = values + group.child + 2 * k;
            const std::int64_t y = fine.row, z = fine.plane;
            const float even = (r[0] + r[y]) + (r[z] + r[y + z]);
            const float odd = (r[1] + r[y + 1]) + (r[z + 1] + r[y + z + 1]);
            const auto i = static_cast<std::size_t>(group.at + k);
            coarse.right[i] = coarse.weight[i] > 0.0f ? even + odd : 0.0f;
            coarse.solution[i] = coarse.weight[i] * coarse.right[i];
        }
    }
}

void correct(Level& fine, const Level& coarse, std::int64_t begin, std::int64_t end) {
    for (std::int64_t n = begin; n < end; ++n) {
        const Level::Group& group = fine.groups[static_cast<std::size_t>(n)];
        for (std::int64_t k = 0; k < kGroup; ++k) {
            float& z = fine.solution[static_cast<std::size_t>(group.at + k)];
            z = z + kCorrection * coarse.solution[static_cast<std::size_t>(group.parent + k / 2)];
        }
    }
}

void heat(const Level& level, const float* sigma, const float* phi, float factor, float* out, std::int64_t begin,
          std::int64_t end) {
    const float *gx = level.g[0].data(), *gy = level.g[1].data(), *gz = level.g[2].data();
    const std::int64_t row = level.row, plane = level.plane;
    for (std::int64_t n = begin; n < end; ++n)
        for (std::int64_t k = 0; k < kGroup; ++k) {
            const std::int64_t i = level.groups[static_cast<std::size_t>(n)].at + k;
            auto square = [&](float g, float there) {
                const float flow = g * (phi[i] - there);
                return flow * flow;
            };
            float sum = square(gx[i], phi[i + 1]) + square(gx[i - 1], phi[i - 1]);
            sum = sum + (square(gy[i], phi[i + row]) + square(gy[i - row], phi[i - row]));
            sum = sum + (square(gz[i], phi[i + plane]) + square(gz[i - plane], phi[i - plane]));
            out[i] = sigma[i] > 0.0f ? ((0.5f * factor) * sum) / sigma[i] : 0.0f;
        }
}

void split(const Conductivity& tissue, const float* heat, const float* sigma, float scale, std::int64_t first,
           std::int64_t count, float* out, HeatSums& sums) {
    for (std::int64_t k = 0; k < count; ++k) {
        const std::int64_t hexel = first + k;
        const auto place = static_cast<std::size_t>(k % kGroup);
        const bool kept = (tissue.present[hexel >> 3] >> (hexel & 7)) & 1;
        out[k] = kept ? scale * heat[k] : 0.0f;
        if (!kept) {
            sums.rest[place] += static_cast<double>(heat[k]);
            continue;
        }
        const tissue::MaterialIndex m = tissue.material[hexel];
        sums.kept[m][place] += static_cast<double>(heat[k]);
        sums.greatest[m] = std::max(sums.greatest[m], heat[k] * sigma[k]);
    }
}

}  // namespace reference

Kernels reference_kernels() {
    using namespace reference;
    return {gather,    faces,    weights, aggregate,         apply,   dot,  start, advance,
            direction, residual, smooth,  restrict_residual, correct, heat, split};
}

}  // namespace calot::electric

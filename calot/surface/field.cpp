#include "calot/surface/field.h"

#include <algorithm>
#include <cmath>

namespace calot::surface {

namespace {

/// Weights of a row at squared distance `d2` from the point, for every pattern of its seven bits:
/// sum W + 2^32 sum W dx, so that one addition adds both.
using RowTable = std::array<std::int64_t, 128>;
constexpr std::array<int, 8> kRowDistances{0, 1, 2, 4, 5, 8, 9, 10};

constexpr std::array<RowTable, 8> make_tables(int (*weight)(int)) {
    std::array<RowTable, 8> tables{};
    for (std::size_t k = 0; k < kRowDistances.size(); ++k)
        for (std::size_t bits = 0; bits < 128; ++bits)
            for (int dx = -kReach; dx <= kReach; ++dx)
                if ((bits >> (dx + kReach)) & 1u) {
                    const std::int64_t w = weight(kRowDistances[k] + dx * dx);
                    tables[k][bits] += w + (w * dx) * (std::int64_t{1} << 32);
                }
    return tables;
}
constexpr std::array<RowTable, 8> kFieldTables = make_tables(field_weight);
constexpr std::array<RowTable, 8> kSlopeTables = make_tables(slope_weight);

constexpr int table_of(int d2) {
    for (int k = 0; k < 8; ++k)
        if (kRowDistances[static_cast<std::size_t>(k)] == d2) return k;
    return -1;
}

int low_part(std::int64_t sum) {
    return static_cast<int>(static_cast<std::uint32_t>(sum));
}
int high_part(std::int64_t sum) {
    return static_cast<int>((sum - low_part(sum)) >> 32);
}

/// Sums of packed rows by dy and by dz.
struct Sums {
    std::array<std::int64_t, 7> by_y{}, by_z{};

    void add(int dy, int dz, std::int64_t row) {
        by_y[static_cast<std::size_t>(dy + kReach)] += row;
        by_z[static_cast<std::size_t>(dz + kReach)] += row;
    }
    std::int64_t total() const {
        std::int64_t sum = 0;
        for (std::int64_t s : by_z) sum += s;
        return sum;
    }
    Int3 first_moment() const {
        Int3 m(high_part(total()), 0, 0);
        for (int d = 1; d <= kReach; ++d) {
            const auto up = static_cast<std::size_t>(kReach + d), down = static_cast<std::size_t>(kReach - d);
            m.y += d * (low_part(by_y[up]) - low_part(by_y[down]));
            m.z += d * (low_part(by_z[up]) - low_part(by_z[down]));
        }
        return m;
    }
};

template <int dy, int dz>
inline void add_row(const std::uint32_t* centre, int x, Sums& field, Sums& slope) {
    constexpr int k = table_of(dy * dy + dz * dz);
    if constexpr (k >= 0) {
        const std::uint32_t bits = (centre[dz * Window::kRows + dy] >> x) & 127u;
        slope.add(dy, dz, kSlopeTables[k][bits]);
        if constexpr (dy * dy + dz * dz <= 5) field.add(dy, dz, kFieldTables[k][bits]);
    }
}

template <int dz>
inline void add_plane(const std::uint32_t* centre, int x, Sums& field, Sums& slope) {
    add_row<-3, dz>(centre, x, field, slope);
    add_row<-2, dz>(centre, x, field, slope);
    add_row<-1, dz>(centre, x, field, slope);
    add_row<0, dz>(centre, x, field, slope);
    add_row<1, dz>(centre, x, field, slope);
    add_row<2, dz>(centre, x, field, slope);
    add_row<3, dz>(centre, x, field, slope);
}

}  // namespace

Moments moments_at(const Window& window, int x, int y, int z) {
    const std::uint32_t* centre = &window.rows[static_cast<std::size_t>((z + kReach) * Window::kRows + y + kReach)];
    Sums field, slope;
    add_plane<-3>(centre, x, field, slope);
    add_plane<-2>(centre, x, field, slope);
    add_plane<-1>(centre, x, field, slope);
    add_plane<0>(centre, x, field, slope);
    add_plane<1>(centre, x, field, slope);
    add_plane<2>(centre, x, field, slope);
    add_plane<3>(centre, x, field, slope);
    return {low_part(field.total()), field.first_moment(), slope.first_moment()};
}

Moments moments_at_reference(const Window& window, int x, int y, int z) {
    Moments m;
    for (int dz = -kReach; dz <= kReach; ++dz)
        for (int dy = -kReach; dy <= kReach; ++dy)
            for (int dx = -kReach; dx <= kReach; ++dx) {
                if (!window.test(x + dx, y + dy, z + dz)) continue;
                const int d2 = dx * dx + dy * dy + dz * dz;
                m.weight += field_weight(d2);
                m.mean += field_weight(d2) * Int3(dx, dy, dz);
                m.slope += slope_weight(d2) * Int3(dx, dy, dz);
            }
    return m;
}

float field_value(const Moments& m, bool present) {
    const Vec3f mean(m.mean);
    const float length = std::sqrt(mean.x * mean.x + mean.y * mean.y + mean.z * mean.z);
    const float share = 1.0f - 2.0f * static_cast<float>(m.weight) / static_cast<float>(kFullFieldWeight);
    if (present) return std::min({share, length / static_cast<float>(m.weight) - 0.5f, -kLeastValue});
    // Over all offsets sum W d = 0: what is absent has the opposite moment.
    return std::max({share, 0.5f - length / static_cast<float>(kFullFieldWeight - m.weight), kLeastValue});
}

}  // namespace calot::surface

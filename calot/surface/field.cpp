#include "calot/surface/field.h"

#include <algorithm>
#include <cmath>

namespace calot::surface {

namespace {

/// Four sums in one word, so that one addition adds all. From the low bits up: slope weight, field weight (never
/// negative), slope weight * dx, field weight * dx.
constexpr int kSlopeBits = 14, kFieldBits = 18, kSlopeMomentBits = 14;
constexpr int kSlopeMomentShift = kSlopeBits + kFieldBits, kFieldMomentShift = kSlopeMomentShift + kSlopeMomentBits;

struct Unpacked {
    int slope, field, slope_x, field_x;
};
constexpr Unpacked unpack(std::int64_t sum) {
    Unpacked u{};
    u.slope = static_cast<int>(sum & ((1 << kSlopeBits) - 1));
    u.field = static_cast<int>((sum >> kSlopeBits) & ((1 << kFieldBits) - 1));
    sum >>= kSlopeMomentShift;
    constexpr int kHalf = 1 << (kSlopeMomentBits - 1);
    u.slope_x = static_cast<int>((sum & (2 * kHalf - 1)) ^ kHalf) - kHalf;  // sign of the field's top bit
    u.field_x = static_cast<int>((sum - u.slope_x) >> kSlopeMomentBits);
    return u;
}

/// Sums of a row at squared distance kRowDistances[k] from the point, for every pattern of its seven bits.
using RowTable = std::array<std::int64_t, 128>;
constexpr std::array<int, 8> kRowDistances{0, 1, 2, 4, 5, 8, 9, 10};

constexpr std::array<RowTable, 8> make_tables() {
    std::array<RowTable, 8> tables{};
    for (std::size_t k = 0; k < kRowDistances.size(); ++k)
        for (std::size_t bits = 0; bits < 128; ++bits)
            for (int dx = -kReach; dx <= kReach; ++dx)
                if ((bits >> (dx + kReach)) & 1u) {
                    const int d2 = kRowDistances[k] + dx * dx;
                    const std::int64_t slope = slope_weight(d2), field = field_weight(d2);
                    tables[k][bits] += slope + field * (std::int64_t{1} << kSlopeBits) +
                                       slope * dx * (std::int64_t{1} << kSlopeMomentShift) +
                                       field * dx * (std::int64_t{1} << kFieldMomentShift);
                }
    return tables;
}
constexpr std::array<RowTable, 8> kTables = make_tables();

constexpr int table_of(int d2) {
    for (int k = 0; k < 8; ++k)
        if (kRowDistances[static_cast<std::size_t>(k)] == d2) return k;
    return -1;
}

/// The largest sums are those of the half and of the whole neighbourhood.
constexpr bool sums_fit() {
    int slope = 0, field = 0, slope_x = 0, field_x = 0;
    for (int dz = -kReach; dz <= kReach; ++dz)
        for (int dy = -kReach; dy <= kReach; ++dy)
            for (int dx = -kReach; dx <= kReach; ++dx) {
                const int d2 = dx * dx + dy * dy + dz * dz;
                slope += slope_weight(d2);
                field += field_weight(d2);
                if (dx > 0) slope_x += dx * slope_weight(d2), field_x += dx * field_weight(d2);
            }
    return slope < (1 << kSlopeBits) && field < (1 << kFieldBits) && slope_x < (1 << (kSlopeMomentBits - 1)) &&
           field_x < (1 << (63 - kFieldMomentShift)) && field_x < (1 << (kFieldBits - 1));
}
static_assert(sums_fit());

/// Packed sums over rows: of all, and weighted by dy and dz. Weighted ones are small enough to be unpacked as signed.
struct Sums {
    std::int64_t all = 0, by_z = 0;
    std::array<std::int64_t, kReach + 1> across{};  ///< rows at +dy less those at -dy

    template <int dy, int dz>
    std::int64_t row(const std::uint8_t* centre) {
        constexpr int k = table_of(dy * dy + dz * dz);
        if constexpr (k < 0)
            return 0;
        else
            return kTables[k][centre[dz * Window::kRows + dy]];
    }
    template <int d, int dz>
    std::int64_t row_pair(const std::uint8_t* centre) {
        const std::int64_t up = row<d, dz>(centre), down = row<-d, dz>(centre);
        across[d] += up - down;
        return up + down;
    }
    template <int dz>
    void add_plane(const std::uint8_t* centre) {
        const std::int64_t plane =
            row<0, dz>(centre) + row_pair<1, dz>(centre) + row_pair<2, dz>(centre) + row_pair<3, dz>(centre);
        all += plane;
        by_z += dz * plane;
    }
};

/// Slope and field part of a weighted sum.
struct SignedPair {
    int slope, field;
};
constexpr SignedPair unpack_signed(std::int64_t sum) {
    const auto signed_bits = [](std::int64_t word, int bits) {
        const std::int64_t half = std::int64_t{1} << (bits - 1);
        return static_cast<int>(((word & (2 * half - 1)) ^ half) - half);
    };
    const int slope = signed_bits(sum, kSlopeBits);
    return {slope, signed_bits((sum - slope) >> kSlopeBits, kFieldBits)};
}

}  // namespace

float field_value(const Moments& m, bool present) {
    const Vec3f mean(m.mean);
    const float length = std::sqrt(mean.x * mean.x + mean.y * mean.y + mean.z * mean.z);
    constexpr float kPerFull = 2.0f / static_cast<float>(kFullFieldWeight);
    const float share = 1.0f - kPerFull * static_cast<float>(m.weight);
    if (present) return std::min({share, length / static_cast<float>(m.weight) - 0.5f, -kLeastValue});
    // Over all offsets sum W d = 0: what is absent has the opposite moment.
    return std::max({share, 0.5f - length / static_cast<float>(kFullFieldWeight - m.weight), kLeastValue});
}

Slice slice_of(const Window& window, int x) {
    Slice slice;
    for (std::size_t row = 0; row < window.rows.size(); ++row)
        slice.pattern[row] = static_cast<std::uint8_t>((window.rows[row] >> x) & 127u);
    return slice;
}

Moments moments_at(const Slice& slice, int y, int z) {
    const std::uint8_t* centre = &slice.pattern[static_cast<std::size_t>((z + kReach) * Window::kRows + y + kReach)];
    Sums sums;
    sums.add_plane<-3>(centre);
    sums.add_plane<-2>(centre);
    sums.add_plane<-1>(centre);
    sums.add_plane<0>(centre);
    sums.add_plane<1>(centre);
    sums.add_plane<2>(centre);
    sums.add_plane<3>(centre);
    const Unpacked total = unpack(sums.all);
    const SignedPair along_y = unpack_signed(sums.across[1] + 2 * sums.across[2] + 3 * sums.across[3]),
                     along_z = unpack_signed(sums.by_z);
    return {total.field, {total.field_x, along_y.field, along_z.field}, {total.slope_x, along_y.slope, along_z.slope}};
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

}  // namespace calot::surface

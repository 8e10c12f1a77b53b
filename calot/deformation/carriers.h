#pragma once
// What carries material points of one phyxel's cell: the phyxel itself and the cells about it that its links reach.
// Used by embedding and by the search for near hexels.

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include "calot/deformation/embedding.h"
#include "calot/deformation/neighbours.h"
#include "calot/deformation/work.h"

namespace calot::deformation {

/// Four floats with ordinary arithmetic.
using Four = float __attribute__((vector_size(16)));

/// The shape of Shepard's weights: (1 - r^2 / R^2)^3, r in phyxel spacings.
inline float embedding_kernel(float r_squared) {
    constexpr auto kInverse = static_cast<float>(1.0 / (kEmbeddingRadius * kEmbeddingRadius));
    const float t = 1.0f - r_squared * kInverse;
    return t > 0.0f ? t * t * t : 0.0f;
}
/// Of four points.
inline Four embedding_kernel(Four r_squared) {
    constexpr auto kInverse = static_cast<float>(1.0 / (kEmbeddingRadius * kEmbeddingRadius));
    const Four t = 1.0f - r_squared * kInverse;
    return t > 0.0f ? t * t * t : Four{};
}

struct Carriers {
    int count = 0;                                 ///< 0: the phyxel is not there
    std::array<std::int8_t, kNeighbourhood> cell;  ///< index in the neighbourhood; the phyxel itself comes first
    std::array<std::int64_t, kNeighbourhood> phyxel;
};

/// The plain form: looks at the links themselves.
inline Carriers find_carriers(const tissue::Model& model, const tissue::State& state, std::int64_t phyxel) {
    Carriers carriers;
    if (phyxel < model.phyxels.first || phyxel >= model.phyxels.last || !state.phyxel_present.test(phyxel))
        return carriers;
    const auto& links = neighbour_links();
    std::array<bool, kNeighbourhood> reached{};
    auto add = [&](int k, std::int64_t cell) {
        carriers.cell[static_cast<std::size_t>(carriers.count)] = static_cast<std::int8_t>(k);
        carriers.phyxel[static_cast<std::size_t>(carriers.count++)] = cell;
        reached[static_cast<std::size_t>(k)] = true;
    };
    add(kNeighbourhoodCentre, phyxel);
    for (int k = 0; k < kNeighbourhood; ++k) {
        const NeighbourLink& link = links[static_cast<std::size_t>(k)];
        if (link.direction < 0) continue;
        const std::int64_t offset = model.phyxels.offset(link.step);
        if (link_lives(state, phyxel, offset, link)) add(k, phyxel + offset);
    }
    // A corner, in two links: by a face and an edge neighbour, or by an edge and a face neighbour.
    for (int k = 0; k < kNeighbourhood; ++k) {
        const Int3 corner = links[static_cast<std::size_t>(k)].step;
        if (corner.x * corner.y * corner.z == 0) continue;
        for (int axis = 0; axis < 3 && !reached[static_cast<std::size_t>(k)]; ++axis) {
            Int3 face(0), edge = corner;
            face[axis] = corner[axis];
            edge[axis] = 0;
            for (const Int3& via : {face, edge}) {
                if (reached[static_cast<std::size_t>(k)] || !reached[static_cast<std::size_t>(neighbour_index(via))])
                    continue;
                const NeighbourLink& onward = links[static_cast<std::size_t>(neighbour_index(corner - via))];
                const std::int64_t middle = phyxel + model.phyxels.offset(via);
                if (connected(model, state, middle, model.phyxels.offset(onward.step), onward))
                    add(k, phyxel + model.phyxels.offset(corner));
            }
        }
    }
    return carriers;
}

/// The two-step ways from a cell to a corner of its neighbourhood: over a face or an edge neighbour.
struct CornerWay {
    std::int8_t via = 0;     ///< neighbourhood index
    std::int8_t onward = 0;  ///< from there, as neighbourhood index
};
struct Corner {
    std::int8_t cell = 0;
    std::array<CornerWay, 6> way;
};
inline const std::array<Corner, 8>& corners() {
    static const std::array<Corner, 8> table = [] {
        std::array<Corner, 8> all;
        for (int n = 0; n < 8; ++n) {
            const Int3 step(n & 1 ? 1 : -1, n & 2 ? 1 : -1, n & 4 ? 1 : -1);
            Corner& corner = all[static_cast<std::size_t>(n)];
            corner.cell = static_cast<std::int8_t>(neighbour_index(step));
            for (int axis = 0; axis < 3; ++axis) {
                Int3 face(0);
                face[axis] = step[axis];
                const Int3 edge = step - face;
                corner.way[static_cast<std::size_t>(2 * axis)] = {static_cast<std::int8_t>(neighbour_index(face)),
                                                                  static_cast<std::int8_t>(neighbour_index(edge))};
                corner.way[static_cast<std::size_t>(2 * axis + 1)] = {static_cast<std::int8_t>(neighbour_index(edge)),
                                                                      static_cast<std::int8_t>(neighbour_index(face))};
            }
        }
        return all;
    }();
    return table;
}

/// The same as above from Work::link_word, in a fraction of the time. (Or state and work are both a Pose.)
template <class State, class Work>
Carriers find_carriers(const tissue::Model& model, const State& state, const Work& work, std::int64_t phyxel) {
    Carriers carriers;
    if (phyxel < model.phyxels.first || phyxel >= model.phyxels.last || !state.phyxel_present.test(phyxel))
        return carriers;
    const auto& offset = work.neighbour_offset;
    auto add = [&](int k) {
        carriers.cell[static_cast<std::size_t>(carriers.count)] = static_cast<std::int8_t>(k);
        carriers.phyxel[static_cast<std::size_t>(carriers.count++)] = phyxel + offset[static_cast<std::size_t>(k)];
    };
    add(kNeighbourhoodCentre);
    const std::uint32_t word = work.link_word[static_cast<std::size_t>(phyxel)];
    for (std::uint32_t rest = word; rest != 0; rest &= rest - 1) add(__builtin_ctz(rest));
    for (const Corner& corner : corners())
        for (const CornerWay& way : corner.way) {
            if (((word >> way.via) & 1u) == 0) continue;
            const std::int64_t middle = phyxel + offset[static_cast<std::size_t>(way.via)];
            const bool linked = (work.link_word[static_cast<std::size_t>(middle)] >> way.onward) & 1u;
            if (!linked && !(model.phyxel_ghost.test(middle) &&
                             model.phyxel_ghost.test(middle + offset[static_cast<std::size_t>(way.onward)])))
                continue;
            add(corner.cell);
            break;
        }
    return carriers;
}

/// Where a cell of the neighbourhood comes among carriers: the phyxel itself, cells that links reach, corners.
inline constexpr std::array<std::uint8_t, kNeighbourhood> kCarrierPlace = [] {
    std::array<std::uint8_t, kNeighbourhood> place{};
    std::uint8_t next = 1;
    for (const bool corners : {false, true})
        for (int k = 0; k < kNeighbourhood; ++k)
            if (k != kNeighbourhoodCentre && (k % 3 != 1 && k / 3 % 3 != 1 && k / 9 != 1) == corners)
                place[static_cast<std::size_t>(k)] = next++;
    return place;
}();

/// The carriers of a phyxel that is there, as bits in their order.
inline std::uint32_t carrier_bits(const tissue::Model& model, const Work& work, std::int64_t phyxel) {
    const auto& offset = work.neighbour_offset;
    const std::uint32_t word = work.link_word[static_cast<std::size_t>(phyxel)];
    // Cells between two corners, or a corner and the centre, move together.
    std::uint32_t bits = 1u | (word & 0x2u) | (word & 0x38u) >> 1 | (word & 0x80u) >> 2 | (word & 0x1e00u) >> 3 |
                         (word & 0x3c000u) >> 4 | (word & 0x80000u) >> 5 | (word & 0xe00000u) >> 6 |
                         (word & 0x2000000u) >> 7;
    for (const Corner& corner : corners())
        for (const CornerWay& way : corner.way) {
            if (((word >> way.via) & 1u) == 0) continue;
            const std::int64_t middle = phyxel + offset[static_cast<std::size_t>(way.via)];
            if (((work.link_word[static_cast<std::size_t>(middle)] >> way.onward) & 1u) == 0 &&
                !(model.phyxel_ghost.test(middle) &&
                  model.phyxel_ghost.test(middle + offset[static_cast<std::size_t>(way.onward)])))
                continue;
            bits |= 1u << kCarrierPlace[static_cast<std::size_t>(corner.cell)];
            break;
        }
    return bits;
}

/// The displacement fields u_j + G_j (X - X_j) of the carriers, each written as a + G r with r = X - X_owner [m].
struct CarrierFields {
    static constexpr int kComponents = 12;  ///< a (3), G (9, row-major)
    alignas(64) std::array<std::array<float, kComponents>, kNeighbourhood> field;

    template <class State, class Work>
    void gather(const tissue::Model& model, const State& state, const Work& work, const Carriers& carriers) {
        const auto spacing = static_cast<float>(model.phyxels.spacing_m);
        const auto& links = neighbour_links();
        for (int n = 0; n < carriers.count; ++n) {
            const auto phyxel = static_cast<std::size_t>(carriers.phyxel[static_cast<std::size_t>(n)]);
            const Vec3f d =
                spacing * Vec3f(links[static_cast<std::size_t>(carriers.cell[static_cast<std::size_t>(n)])].step);
            auto& f = field[static_cast<std::size_t>(n)];
            for (std::size_t row = 0; row < 3; ++row) {
                const float gx = work.gradient[3 * row][phyxel], gy = work.gradient[3 * row + 1][phyxel],
                            gz = work.gradient[3 * row + 2][phyxel];
                f[row] = state.displacement_m[row][phyxel] - (gx * d.x + gy * d.y + gz * d.z);
                f[3 + 3 * row] = gx;
                f[4 + 3 * row] = gy;
                f[5 + 3 * row] = gz;
            }
        }
    }
};

/// A field as fours.
using FieldFours = std::array<Four, CarrierFields::kComponents / 4>;
static_assert(sizeof(FieldFours) == sizeof(float) * CarrierFields::kComponents);
inline FieldFours fours(const std::array<float, CarrierFields::kComponents>& field) {
    return std::bit_cast<FieldFours>(field);
}

/// sum_n weight[n] field[n] / sum_n weight[n]. The first carrier alone where all weights vanish.
inline std::array<float, CarrierFields::kComponents> blend(const CarrierFields& fields, int count,
                                                           const float* weight) {
    // No branch where a weight is zero: they are hard to predict.
    FieldFours sum{};
    float total = 0.0f;
    for (int n = 0; n < count; ++n) {
        const float w = weight[n];
        total += w;
        const FieldFours field = fours(fields.field[static_cast<std::size_t>(n)]);
        for (std::size_t c = 0; c < sum.size(); ++c) sum[c] += w * field[c];
    }
    if (total <= 0.0f) return fields.field[0];
    const float inverse = 1.0f / total;
    for (Four& value : sum) value *= inverse;
    return std::bit_cast<std::array<float, CarrierFields::kComponents>>(sum);
}

/// Displacement a + G r.
template <std::size_t N>
Vec3f displacement_at(const std::array<float, N>& f, const Vec3f& r) {
    return Vec3f(f[0] + (f[3] * r.x + f[4] * r.y + f[5] * r.z), f[1] + (f[6] * r.x + f[7] * r.y + f[8] * r.z),
                 f[2] + (f[9] * r.x + f[10] * r.y + f[11] * r.z));
}

/// F = I + G, column-major.
template <std::size_t N>
Mat3f deformation_gradient_of(const std::array<float, N>& f) {
    return Mat3f(1.0f + f[3], f[6], f[9], f[4], 1.0f + f[7], f[10], f[5], f[8], 1.0f + f[11]);
}

}  // namespace calot::deformation

#include "calot/deformation/contact_spread.h"

#include <cstring>

#include "calot/deformation/carriers.h"
#include "calot/deformation/links.h"

namespace calot::deformation {

namespace {

/// A row of LocalShares.
using Row = float __attribute__((vector_size(32)));

/// Link weights of three neighbours in a row of x, where the bits of a link word say that they live, at the carrier's
/// place in the row; other lanes are 0. The row beside the carrier has edges, faces, edges (1 f 1), the carrier's own
/// two faces (f . f), a diagonal one a single edge (. 1 .).
struct RowWeights {
    std::array<std::array<std::array<Row, 8>, 3>, 3> of;  ///< [x of the first][|dy| + |dz|][bits]
    std::array<Row, 3> step, centre;                      ///< [x of the first] -1, 0, 1; 1 at the carrier
    RowWeights() : of{}, step{}, centre{} {
        constexpr float kFace = static_cast<float>(kFaceWeight), kEdge = static_cast<float>(kEdgeWeight);
        constexpr float kWeight[3][3] = {{kFace, 0.0f, kFace}, {kEdge, kFace, kEdge}, {0.0f, kEdge, 0.0f}};
        for (std::size_t first = 0; first < 3; ++first) {
            for (std::size_t kind = 0; kind < 3; ++kind)
                for (std::size_t bits = 0; bits < 8; ++bits)
                    for (std::size_t x = 0; x < 3; ++x)
                        of[first][kind][bits][first + x] = (bits >> x) & 1u ? kWeight[kind][x] : 0.0f;
            for (std::size_t x = 0; x < 3; ++x) step[first][first + x] = static_cast<float>(x) - 1.0f;
            centre[first][first + 1] = 1.0f;
        }
    }
};

Mat3f moment_inverse(const Work& work, std::size_t i) {
    std::array<float, 6> a;
    for (std::size_t k = 0; k < a.size(); ++k) a[k] = work.moment_inverse[k][i];
    return Mat3f(a[0], a[1], a[2], a[1], a[3], a[4], a[2], a[4], a[5]);
}

/// Adds one carrier j: phi_j (u_j + G_j (X - X_j)), G_j (X - X_j) = sum_l w u_jl (X_jl . A_j^-1 (X - X_j)).
/// `lever` = phi_j s A_j^-1 (X - X_j), `step` from the owner to the carrier.
void add_carrier(std::uint32_t links, const Vec3f& lever, float phi, const Int3& step, LocalShares& out) {
    static const RowWeights weights;
    const auto first = static_cast<std::size_t>(step.x + 1);
    const Row along = lever.x * weights.step[first];
    float* middle = out.share.data() + 8 * (step.y + 2) + 40 * (step.z + 2);
    Row total{}, own{};
    for (int z = -1; z <= 1; ++z)
        for (int y = -1; y <= 1; ++y, links >>= 3) {
            const Row& w = weights.of[first][static_cast<std::size_t>((y & 1) + (z & 1))][links & 7u];
            const float across = lever.y * static_cast<float>(y) + lever.z * static_cast<float>(z);
            const Row share = w * (across + along);
            total += share;
            Row row;
            std::memcpy(&row, middle + 8 * y + 40 * z, sizeof(row));
            row += share;
            if (y == 0 && z == 0)
                own = row;
            else
                std::memcpy(middle + 8 * y + 40 * z, &row, sizeof(row));
        }
    own += (phi - ((total[first] + total[first + 1]) + total[first + 2])) * weights.centre[first];
    std::memcpy(middle, &own, sizeof(own));
}

}  // namespace

void local_shares(const tissue::Model& model, const tissue::State& state, const Work& work, std::int64_t hexel,
                  LocalShares& out) {
    const int m = model.hexels_per_edge;
    const Int3 at = model.hexels.coordinates(hexel), local = at % m, cell = at / m;
    out.owner = model.phyxels.index(cell);
    out.share.fill(0.0f);
    const Carriers carriers = find_carriers(model, state, work, out.owner);
    if (carriers.count == 0) return;
    const float* table = work.hexel_weight.data() + kNeighbourhood * (local.x + m * (local.y + m * local.z));
    std::array<float, kNeighbourhood> phi;
    float sum = 0.0f;
    for (std::size_t n = 0; n < static_cast<std::size_t>(carriers.count); ++n) sum += phi[n] = table[carriers.cell[n]];
    const auto spacing = static_cast<float>(model.phyxels.spacing_m);
    const Vec3f r = Vec3f(model.hexels.centre_m(at) - model.phyxels.centre_m(cell));
    for (std::size_t n = 0; n < static_cast<std::size_t>(carriers.count); ++n) {
        if (phi[n] == 0.0f) continue;
        const Int3 step = neighbour_links()[static_cast<std::size_t>(carriers.cell[n])].step;
        const auto carrier = static_cast<std::size_t>(carriers.phyxel[n]);
        const float share = phi[n] / sum;
        const Vec3f lever = (share * spacing) * (moment_inverse(work, carrier) * (r - spacing * Vec3f(step)));
        add_carrier(work.link_word[carrier], lever, share, step, out);
    }
}

}  // namespace calot::deformation

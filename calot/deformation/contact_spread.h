#pragma once
// psi: what share of a material point's motion each phyxel has (contact.h).

#include <array>
#include <cstdint>

#include "calot/deformation/neighbours.h"
#include "calot/deformation/work.h"

namespace calot::deformation {

/// What carries the hexels of one phyxel: the same for all points in it.
struct PhyxelCarriers {
    struct Carrier {
        Mat3f moment_inverse{0.0f};
        Vec3f step_m{0.0f};                          ///< from the phyxel
        std::uint32_t cell = 0;                      ///< of the neighbourhood
        std::uint32_t links = 0, first = 0, at = 0;  ///< as in CarrierShare
    };
    std::int64_t phyxel = -1;
    std::size_t count = 0;
    std::array<Carrier, kNeighbourhood> carrier;
};

/// Of the centre of a hexel. All zero when nothing carries it. `carriers` are renewed if they are another phyxel's.
void local_shares(const tissue::Model& model, const tissue::State& state, const Work& work, std::int64_t hexel,
                  PhyxelCarriers& carriers, LocalShares& out);

/// A carrier j's part: phi_j (u_j + G_j (X - X_j)), G_j (X - X_j) = sum_l w u_jl (X_jl . A_j^-1 (X - X_j)).
struct CarrierShare {
    Vec3f lever{0.0f};  ///< phi_j s A_j^-1 (X - X_j)
    float phi = 0.0f;
    std::uint32_t links = 0;  ///< Work::link_word
    std::uint32_t first = 0;  ///< x of the cell before it in its row of LocalShares
    std::uint32_t at = 0;     ///< where its row begins there
};

/// Sets `share` and `there` to the sum of the carriers' parts.
void add_carriers(const CarrierShare* carriers, std::size_t count, LocalShares& out);

/// From a point's own phyxel to a cell of LocalShares.
inline Int3 share_step(int at) {
    return Int3(at % 8 - 2, at / 8 % 5 - 2, at / 40 - 2);
}

/// Calls visit(place in LocalShares, share) for every cell that has a share.
template <class Visit>
void for_each_share(const LocalShares& local, const Visit& visit) {
    for (std::size_t word = 0; word < local.there.size(); ++word)
        for (std::uint64_t rest = local.there[word]; rest != 0; rest &= rest - 1) {
            const std::size_t at = 64 * word + static_cast<std::size_t>(__builtin_ctzll(rest));
            visit(at, local.share[at]);
        }
}

}  // namespace calot::deformation

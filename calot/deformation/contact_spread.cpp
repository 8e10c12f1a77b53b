#include "calot/deformation/contact_spread.h"

#include "calot/deformation/carriers.h"

namespace calot::deformation {

namespace {

Mat3f moment_inverse(const Work& work, std::size_t i) {
    std::array<float, 6> a;
    for (std::size_t k = 0; k < a.size(); ++k) a[k] = work.moment_inverse[k][i];
    return Mat3f(a[0], a[1], a[2], a[1], a[3], a[4], a[2], a[4], a[5]);
}

}  // namespace

void local_shares(const tissue::Model& model, const tissue::State& state, const Work& work, std::int64_t hexel,
                  LocalShares& out) {
    const int m = model.hexels_per_edge;
    const Int3 at = model.hexels.coordinates(hexel), local = at % m, cell = at / m;
    out.owner = model.phyxels.index(cell);
    const Carriers carriers = find_carriers(model, state, work, out.owner);
    const float* table = work.hexel_weight.data() + kNeighbourhood * (local.x + m * (local.y + m * local.z));
    std::array<float, kNeighbourhood> phi;
    float sum = 0.0f;
    for (std::size_t n = 0; n < static_cast<std::size_t>(carriers.count); ++n) sum += phi[n] = table[carriers.cell[n]];
    const auto spacing = static_cast<float>(model.phyxels.spacing_m);
    const Vec3f r = Vec3f(model.hexels.centre_m(at) - model.phyxels.centre_m(cell));
    std::array<CarrierShare, kNeighbourhood> parts;
    std::size_t count = 0;
    for (std::size_t n = 0; n < static_cast<std::size_t>(carriers.count); ++n) {
        if (phi[n] == 0.0f) continue;
        const Int3 step = neighbour_links()[static_cast<std::size_t>(carriers.cell[n])].step;
        const auto carrier = static_cast<std::size_t>(carriers.phyxel[n]);
        CarrierShare& part = parts[count++];
        part.phi = phi[n] / sum;
        part.lever = (part.phi * spacing) * (moment_inverse(work, carrier) * (r - spacing * Vec3f(step)));
        part.links = work.link_word[carrier];
        part.first = static_cast<std::uint32_t>(step.x + 1);
        part.at = static_cast<std::uint32_t>(8 * (step.y + 2) + 40 * (step.z + 2));
    }
    add_carriers(parts.data(), count, out);
}

}  // namespace calot::deformation

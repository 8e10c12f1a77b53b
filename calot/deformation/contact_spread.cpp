#include "calot/deformation/contact_spread.h"

#include "calot/deformation/carriers.h"

namespace calot::deformation {

namespace {

Mat3f moment_inverse(const Work& work, std::size_t i) {
    std::array<float, 6> a;
    for (std::size_t k = 0; k < a.size(); ++k) a[k] = work.moment_inverse[k][i];
    return Mat3f(a[0], a[1], a[2], a[1], a[3], a[4], a[2], a[4], a[5]);
}

void list_carriers(const tissue::Model& model, const tissue::State& state, const Work& work, std::int64_t phyxel,
                   PhyxelCarriers& out) {
    const auto spacing = static_cast<float>(model.phyxels.spacing_m);
    const Carriers carriers = find_carriers(model, state, work, phyxel);
    out.phyxel = phyxel;
    out.count = static_cast<std::size_t>(carriers.count);
    for (std::size_t n = 0; n < out.count; ++n) {
        const auto cell = static_cast<std::size_t>(carriers.cell[n]), at = static_cast<std::size_t>(carriers.phyxel[n]);
        const Int3 step = neighbour_links()[cell].step;
        PhyxelCarriers::Carrier& carrier = out.carrier[n];
        carrier.moment_inverse = moment_inverse(work, at);
        carrier.step_m = spacing * Vec3f(step);
        carrier.cell = static_cast<std::uint32_t>(cell);
        carrier.links = work.link_word[at];
        carrier.first = static_cast<std::uint32_t>(step.x + 1);
        carrier.at = static_cast<std::uint32_t>(8 * (step.y + 2) + 40 * (step.z + 2));
    }
}

}  // namespace

void local_shares(const tissue::Model& model, const tissue::State& state, const Work& work, std::int64_t hexel,
                  PhyxelCarriers& carriers, LocalShares& out) {
    const int m = model.hexels_per_edge;
    const Int3 at = model.hexels.coordinates(hexel), cell = at / m, local = at - cell * m;
    out.owner = model.phyxels.index(cell);
    if (carriers.phyxel != out.owner) list_carriers(model, state, work, out.owner, carriers);
    const float* table = work.hexel_weight.data() + kNeighbourhood * (local.x + m * (local.y + m * local.z));
    std::array<CarrierShare, kNeighbourhood> parts;
    std::size_t count = 0;
    float sum = 0.0f;
    for (std::size_t n = 0; n < carriers.count; ++n) {
        const float phi = table[carriers.carrier[n].cell];
        if (phi == 0.0f) continue;
        sum += phi;
        parts[count].phi = phi;
        parts[count++].at = static_cast<std::uint32_t>(n);
    }
    const auto spacing = static_cast<float>(model.phyxels.spacing_m);
    const Vec3f r = Vec3f(model.hexels.centre_m(at) - model.phyxels.centre_m(cell));
    for (std::size_t n = 0; n < count; ++n) {
        CarrierShare& part = parts[n];
        const PhyxelCarriers::Carrier& carrier = carriers.carrier[part.at];
        part.phi /= sum;
        part.lever = (part.phi * spacing) * (carrier.moment_inverse * (r - carrier.step_m));
        part.links = carrier.links;
        part.first = carrier.first;
        part.at = carrier.at;
    }
    add_carriers(parts.data(), count, out);
}

}  // namespace calot::deformation

#include "calot/deformation/work.h"

#include "calot/deformation/integrate.h"

namespace calot::deformation {

namespace {

/// One bit per surviving hexel of a phyxel's cell.
std::uint64_t occupancy_of(const tissue::Model& model, const tissue::State& state, std::int64_t phyxel) {
    std::uint64_t word = 0;
    const int m = model.hexels_per_edge;
    const Int3 low = model.phyxels.coordinates(phyxel) * m;
    for (int z = 0, bit = 0; z < m; ++z)
        for (int y = 0; y < m; ++y)
            for (int x = 0; x < m; ++x, ++bit)
                if (state.hexel_present.test(model.hexels.index(low + Int3(x, y, z)))) word |= std::uint64_t{1} << bit;
    return word;
}

}  // namespace

Work make_work(const tissue::Model& model, const tissue::State& state) {
    Work work;
    const auto cells = static_cast<std::size_t>(model.phyxels.cells);
    work.occupancy.assign(cells, 0);
    for (auto& component : work.moment_inverse) component.assign(cells, 0.0f);
    for (Array<float>* field :
         {&work.volume_m3, &work.inverse_mass_per_kg, &work.hourglass, &work.lame_mu_Pa, &work.lame_lambda_Pa})
        field->assign(cells, 0.0f);
    for (auto& component : work.gradient) component.assign(cells, 0.0f);
    for (auto& component : work.moment_stress) component.assign(cells, 0.0f);
    work.substeps = model.deformation.substeps;
    work.substep_s = static_cast<float>(model.tick_s / work.substeps);

    for (std::int64_t p = model.phyxels.first; p < model.phyxels.last; ++p)
        if (state.phyxel_present.test(p)) work.occupancy[static_cast<std::size_t>(p)] = occupancy_of(model, state, p);
    for (std::int64_t p = model.phyxels.first; p < model.phyxels.last; ++p)
        if (state.phyxel_present.test(p) || model.phyxel_ghost.test(p)) refresh_phyxel(model, state, work, p);
    update_gradients(model, state, work);
    return work;
}

}  // namespace calot::deformation

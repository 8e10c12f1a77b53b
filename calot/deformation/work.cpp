#include "calot/deformation/work.h"

#include "calot/deformation/integrate.h"
#include "calot/deformation/rest.h"
#include "calot/deformation/kernel.h"
#include "calot/deformation/topology.h"

namespace calot::deformation {

Work make_work(const tissue::Model& model, const tissue::State& state) {
    Work work;
    const auto cells = static_cast<std::size_t>(model.phyxels.cells);
    initialise_topology(model, state, work);
    for (auto& component : work.moment_inverse) component.assign(cells, 0.0f);
    for (Array<float>* field : {&work.volume_m3, &work.inverse_mass_per_kg, &work.gravity_share, &work.hourglass,
                                &work.pull_N_per_m2, &work.lame_mu_Pa, &work.lame_lambda_Pa})
        field->assign(cells, 0.0f);
    for (auto& component : work.gradient) component.assign(cells, 0.0f);
    for (auto& component : work.moment_stress) component.assign(cells, 0.0f);
    for (auto& component : work.own_force_N) component.assign(cells, 0.0f);
    for (auto& component : work.step_sum) component.assign(cells, 0.0f);
    work.link_word.assign(cells, 0);
    work.volume_share = volume_shares(model);
    work.groups = make_groups(model, state);
    work.touched_groups.reserve(work.groups.size());
    work.contact = make_contact_work(model);
    work.substeps = model.deformation.substeps;
    work.substep_s = static_cast<float>(model.tick_s / work.substeps);

    refresh_all_phyxels(model, state, work);
    update_gradients(model, state, work);
    return work;
}

}  // namespace calot::deformation

#include "calot/deformation/work.h"

#include "calot/deformation/integrate.h"
#include "calot/deformation/kernel.h"
#include "calot/deformation/near_kernel.h"
#include "calot/deformation/rest.h"
#include "calot/deformation/stable_mass.h"
#include "calot/deformation/topology.h"

namespace calot::deformation {

Work make_work(const tissue::Model& model, const tissue::State& state) {
    Work work;
    const auto cells = static_cast<std::size_t>(model.phyxels.cells);
    initialise_topology(model, state, work);
    for (auto& component : work.moment_inverse) component.assign(cells, 0.0f);
    for (Array<float>* field :
         {&work.volume_m3, &work.inverse_mass_per_kg, &work.gravity_share, &work.hourglass, &work.pull_N_per_m2,
          &work.lame_mu_Pa, &work.lame_lambda_Pa, &work.weighing_mass_kg, &work.moving_mass_kg,
          &work.initial_stiffness_Nm, &work.stable_mass_kg, &work.stiffening})
        field->assign(cells, 0.0f);
    for (auto& component : work.gradient) component.assign(cells, 0.0f);
    for (auto& component : work.moment_stress) component.assign(cells, 0.0f);
    for (auto& component : work.own_force_N) component.assign(cells, 0.0f);
    for (auto& component : work.step_sum) component.assign(cells, 0.0f);
    work.raise.assign(cells, 1.0f);
    work.raised.reserve(cells);
    work.link_word.assign(cells, 0);
    work.volume_share = volume_shares(model);
    work.groups = make_groups(model, state);
    work.strained.assign(work.groups.size(), 0);
    work.fast.assign(work.groups.size(), 0);
    work.touched_groups.reserve(work.groups.size());
    work.near = make_near_work(model, work);
    for (std::size_t r = 0; r < 3; ++r) {
        work.rest_m[r].assign(cells, 0.0f);
        for (std::int64_t p = model.phyxels.first; p < model.phyxels.last; ++p)
            work.rest_m[r][static_cast<std::size_t>(p)] =
                static_cast<float>(model.phyxels.centre_m(model.phyxels.coordinates(p))[static_cast<int>(r)]);
    }
    work.contact = make_contact_work(model);
    work.substeps = model.deformation.substeps;
    work.substep_s = static_cast<float>(model.tick_s / work.substeps);

    find_initial_stiffness(model, work);
    refresh_all_phyxels(model, state, work);
    update_gradients(model, state, work);
    return work;
}

}  // namespace calot::deformation

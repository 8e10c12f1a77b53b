#include "calot/simulation/simulation.h"

#include "calot/deformation/embedding.h"

namespace calot::simulation {

Work::Work(const tissue::Model& model, const tissue::State& state, const instruments::HookShape& hook,
           const effects::SmokeParameters& smoke)
    : hook(hook),
      deformation(deformation::make_work(model, state)),
      electric(electric::make_work(model)),
      thermal(thermal::make_work(model, state)),
      surface(model),
      smoke(smoke) {
    surface.rebuild(model, state);
}

Simulation::Simulation(std::shared_ptr<const Setup> setup)
    : setup_(std::move(setup)),
      state_(tissue::State::make(setup_->model)),
      work_(setup_->model, state_, setup_->hook, setup_->smoke) {}

bool Simulation::tick(const tissue::Input& input) {
    if (!state_.status.ok) return false;
    step(setup_->model, state_, work_, input);
    return state_.status.ok;
}

void Simulation::world_surface(WorldSurface& out) const {
    const surface::Mesh& mesh = work_.surface.rest_mesh();
    out.position_m.resize(mesh.position_m.size());
    out.deformation_gradient.resize(mesh.position_m.size());
    deformation::embed_points(setup_->model, state_, work_.deformation, mesh.position_m, work_.surface.owner(),
                              out.position_m, out.deformation_gradient);
}

double Simulation::energy_imbalance() const {
    const tissue::EnergyBudget& energy = state_.energy_J;
    if (energy.delivered == 0.0) return 0.0;
    const double accounted = energy.outflow + energy.gas + energy.surface + energy.perfusion + energy.debris +
                             thermal::stored_J(setup_->model, state_);
    return (energy.delivered - accounted) / energy.delivered;
}

}  // namespace calot::simulation

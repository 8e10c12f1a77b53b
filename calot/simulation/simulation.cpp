#include "calot/simulation/simulation.h"

#include "calot/base/error.h"
#include "calot/deformation/embedding.h"
#include "calot/deformation/topology.h"

namespace calot::simulation {

namespace {

/// A fresh state with the links that the anatomy carries, without what nothing holds.
tissue::State make_initial_state(const tissue::Model& model) {
    tissue::State state = tissue::State::make(model);
    deformation::sever_initial_links(model, state);
    if (state.hexel_present.count() == 0)
        throw InputError("no tissue is held by any organ",
                         "let the tissue touch an organ that holds, or use no organs at all");
    return state;
}

/// The state, if it can be gone on from.
tissue::State checked(const tissue::Model& model, tissue::State state) {
    tissue::State fresh = tissue::State::make(model);
    const std::vector<tissue::Field> expected = tissue::fields(fresh), found = tissue::fields(state);
    for (std::size_t f = 0; f < expected.size(); ++f)
        if (expected[f].bytes != found[f].bytes)
            throw InputError("the state's field \"" + std::string(expected[f].name) + "\" has " +
                                 std::to_string(found[f].bytes) + " bytes, the scene's " +
                                 std::to_string(expected[f].bytes),
                             "go on with the scene that the state was saved from");
    if (state.tick % model.frame_ticks != 0)
        throw InputError("the state was taken at tick " + std::to_string(state.tick) + ", in the middle of a frame",
                         "save states at ticks that are multiples of " + std::to_string(model.frame_ticks));
    return state;
}

}  // namespace

Work::Work(const tissue::Model& model, const tissue::State& state, const instruments::HookShape& hook,
           const effects::SmokeParameters& smoke, const instruments::GrasperShape& grasper)
    : hook(hook),
      grasper(grasper),
      deformation(deformation::make_work(model, state)),
      electric(electric::make_work(model)),
      thermal(thermal::make_work(model, state)),
      surface(model),
      smoke(smoke),
      bleeding(model) {
    tissue::reserve_exchange(model, exchange);
    gas_rest_m.reserve(exchange.gas.capacity());
    gas_world_m.reserve(exchange.gas.capacity());
    gas_owner.reserve(exchange.gas.capacity());
    surface.rebuild(model, state);
}

Simulation::Simulation(std::shared_ptr<const Setup> setup)
    : setup_(std::move(setup)),
      state_(make_initial_state(setup_->model)),
      work_(setup_->model, state_, setup_->hook, setup_->smoke, setup_->grasper) {}

Simulation::Simulation(std::shared_ptr<const Setup> setup, tissue::State state)
    : setup_(std::move(setup)),
      state_(checked(setup_->model, std::move(state))),
      work_(setup_->model, state_, setup_->hook, setup_->smoke, setup_->grasper) {}

bool Simulation::tick(const tissue::Input& input) {
    if (!state_.status.ok) return false;
    step(setup_->model, state_, work_, input);
    return state_.status.ok;
}

void Simulation::archive_effects(Archive& archive) {
    work_.smoke.archive(archive);
    work_.bleeding.archive(archive);
}

void Simulation::world_surface(WorldSurface& out) const {
    const surface::Mesh& mesh = work_.surface.smooth_mesh();
    out.position_m.resize(mesh.position_m.size());
    out.deformation_gradient.resize(mesh.position_m.size());
    // While the surface changes from frame to frame, keeping weights does not pay.
    const bool changed =
        vertices_.surface_version != work_.surface.version() || vertices_.links_severed != state_.links_severed;
    if (changed) {
        vertices_.surface_version = work_.surface.version();
        vertices_.links_severed = state_.links_severed;
        vertices_.kept = false;
        deformation::embed_points(setup_->model, state_, work_.deformation, mesh.position_m, work_.surface.owner(),
                                  out.position_m, out.deformation_gradient);
        return;
    }
    if (!vertices_.kept) vertices_.points.rebuild(setup_->model, state_, mesh.position_m, work_.surface.owner());
    vertices_.kept = true;
    vertices_.points.move(setup_->model, state_, work_.deformation, out.position_m, out.deformation_gradient);
}

double Simulation::energy_imbalance() const {
    const tissue::EnergyBudget& energy = state_.energy_J;
    if (energy.delivered == 0.0) return 0.0;
    return (energy.delivered - energy.accounted() - thermal::stored_J(setup_->model, state_)) / energy.delivered;
}

}  // namespace calot::simulation

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
    const std::size_t most = exchange.gas.capacity();
    for (auto* places : {&gas.rest_m, &gas.world_m, &gas.event_m}) places->reserve(most);
    for (auto* places : {&gas.owner, &gas.phyxel}) places->reserve(most);
    gas.source.reserve(most);
    surface.rebuild(model, state);
}

Simulation::Simulation(std::shared_ptr<const Setup> setup)
    : setup_(std::move(setup)),
      state_(make_initial_state(setup_->model)),
      work_(setup_->model, state_, setup_->hook, setup_->smoke, setup_->grasper),
      backend_(cpu_backend()) {
    start_backend();
}

Simulation::Simulation(std::shared_ptr<const Setup> setup, tissue::State state)
    : setup_(std::move(setup)),
      state_(checked(setup_->model, std::move(state))),
      work_(setup_->model, state_, setup_->hook, setup_->smoke, setup_->grasper),
      backend_(cpu_backend()) {
    start_backend();
}

bool Simulation::tick(const tissue::Input& input) {
    if (!state_.status.ok) return false;
    if (kept_)
        tick_with_backend(input);
    else
        backend_->step(setup_->model, state_, work_, input);
    return state_.status.ok;
}

void Simulation::start_backend() {
    if (!setup_->backend) return;
    try {
        std::unique_ptr<Backend> other = setup_->backend(*setup_);
        other->begin(setup_->model, state_, work_);
        backend_ = std::move(other);
    } catch (const BackendError& error) {
        note(std::string("the processor computes: ") + error.what());
        return;
    }
    if (backend_->keeps_host_current()) return;
    kept_.emplace();
    kept_->inputs.reserve(kKeptTicks);
    keep();
}

void Simulation::keep() {
    kept_->state = state_;
    kept_->inputs.clear();
    keep_effects();
}

void Simulation::keep_effects() {
    Archive effects;
    work_.smoke.archive(effects);
    work_.bleeding.archive(effects);
    kept_->effects = effects.bytes();
}

void Simulation::tick_with_backend(const tissue::Input& input) {
    kept_->inputs.push_back(input);
    state_lags_ = surface_lags_ = true;
    try {
        backend_->step(setup_->model, state_, work_, input);
    } catch (const BackendError& error) {
        fall_back(error.what());
        return;
    }
    if (state_.tick % kKeptTicks != 0 || !state_.status.ok) return;
    fetch_state();
    if (kept_) keep();
}

void Simulation::fetch_state() const {
    try {
        backend_->fetch_state(setup_->model, state_, work_);
        state_lags_ = false;
    } catch (const BackendError& error) {
        fall_back(error.what());
    }
}

void Simulation::fetch_surface() const {
    try {
        backend_->fetch_surface(setup_->model, state_, work_);
        surface_lags_ = false;
    } catch (const BackendError& error) {
        fall_back(error.what());
    }
}

void Simulation::note(const std::string& notice) const {
    notices_.push_back(notice);
    if (setup_->tell) setup_->tell(notice);
}

/// The processor takes over: from the state that was kept on, once more through the ticks since.
void Simulation::fall_back(const std::string& why) const {
    const Kept kept = *std::move(kept_);
    note(backend_->name() + " failed at tick " +
         std::to_string(kept.state.tick + static_cast<std::int64_t>(kept.inputs.size())) + " (" + why +
         "); the processor goes on, from tick " + std::to_string(kept.state.tick));
    backend_ = cpu_backend();
    kept_.reset();
    state_lags_ = surface_lags_ = false;
    state_ = kept.state;
    surface::Surface surface = std::move(work_.surface);  // goes on counting its versions
    work_ = Work(setup_->model, state_, setup_->hook, setup_->smoke, setup_->grasper);
    work_.surface = std::move(surface);
    work_.surface.rebuild(setup_->model, state_);
    Archive effects(kept.effects);
    work_.smoke.archive(effects);
    work_.bleeding.archive(effects);
    vertices_.surface_version = ~std::uint64_t{0};
    for (const tissue::Input& input : kept.inputs)
        if (state_.status.ok) step(setup_->model, state_, work_, input);
}

void Simulation::archive_effects(Archive& archive) {
    work_.smoke.archive(archive);
    work_.bleeding.archive(archive);
    if (archive.reading() && kept_) keep_effects();
}

void Simulation::world_surface(WorldSurface& out) const {
    const surface::Mesh& mesh = surface().smooth_mesh();
    out.position_m.resize(mesh.position_m.size());
    out.deformation_gradient.resize(mesh.position_m.size());
    if (kept_) {
        try {
            backend_->embed_surface(work_, out.position_m, out.deformation_gradient);
            return;
        } catch (const BackendError& error) {
            fall_back(error.what());
            world_surface(out);
            return;
        }
    }
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
    return (energy.delivered - energy.accounted() - thermal::stored_J(setup_->model, state())) / energy.delivered;
}

}  // namespace calot::simulation

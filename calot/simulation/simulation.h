#pragma once
// A running simulation: what programs hold. Setup in, ticks, state and surface out.
//
//     auto setup = std::make_shared<simulation::Setup>(scene::build(scene::load("scenes/block.toml")));
//     simulation::Simulation run(setup);
//     while (run.time_s() < setup->duration_s) run.tick(setup->script.at(run.time_s()));

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "calot/deformation/embedded_points.h"
#include "calot/simulation/setup.h"
#include "calot/simulation/step.h"

namespace calot::simulation {

/// The tissue's surface in the world at this moment.
struct WorldSurface {
    std::vector<Vec3f> position_m;
    std::vector<Mat3f> deformation_gradient;  ///< turns rest normals by its inverse transpose
};

class Simulation {
  public:
    explicit Simulation(std::shared_ptr<const Setup> setup);

    /// Goes on from a state that a simulation of the same setup had, at a tick that is a multiple of
    /// Model::frame_ticks: bit for bit as that one did. What is not part of the state (smoke, blood) starts
    /// anew unless archive_effects() brings it. Throws InputError when the state does not fit the model or was taken in
    /// the middle of a frame.
    Simulation(std::shared_ptr<const Setup> setup, tissue::State state);

    /// What is seen and not felt (smoke, blood): no part of the state, so a run that is to go on looking the same takes
    /// it along. Throws std::runtime_error when what is read is of another scene.
    void archive_effects(Archive& archive);

    /// One step of Model::tick_s. Returns false, and does nothing more, once State::status is not ok.
    bool tick(const tissue::Input& input);

    double time_s() const { return static_cast<double>(state_.tick) * setup_->model.tick_s; }
    const Setup& setup() const { return *setup_; }
    const tissue::Model& model() const { return setup_->model; }
    const tissue::State& state() const { return state_; }
    const Work& work() const { return work_; }
    const surface::Surface& surface() const { return work_.surface; }
    const std::vector<tissue::Capsule>& capsules() const { return work_.exchange.capsules; }

    /// World positions and deformation gradients of Surface::smooth_mesh()'s vertices. Not for several threads at once.
    void world_surface(WorldSurface& out) const;

    /// delivered - (outflow + gas + surface + perfusion + debris + tip + stored), as a fraction of delivered (0 when
    /// none).
    double energy_imbalance() const;

  private:
    std::shared_ptr<const Setup> setup_;
    tissue::State state_;
    Work work_;

    // For world_surface: how vertices hang on phyxels, kept while neither surface nor links change.
    struct VertexCache {
        deformation::EmbeddedPoints points;
        std::uint64_t surface_version = ~std::uint64_t{0};  ///< of the last call
        std::int64_t links_severed = -1;
        bool kept = false;  ///< `points` belong to these
    };
    mutable VertexCache vertices_;
};

}  // namespace calot::simulation

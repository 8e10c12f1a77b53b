#pragma once
// A running simulation: what programs hold. Setup in, ticks, state and surface out.
//
//     auto setup = std::make_shared<simulation::Setup>(scene::build(scene::load("scenes/block.toml")));
//     simulation::Simulation run(setup);
//     while (run.time_s() < setup->duration_s) run.tick(setup->script.at(run.time_s()));

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "calot/deformation/embedded_points.h"
#include "calot/simulation/backend.h"
#include "calot/simulation/setup.h"
#include "calot/simulation/step.h"

namespace calot::simulation {

/// The tissue's surface in the world at this moment.
struct WorldSurface {
    std::vector<Vec3f> position_m;
    std::vector<Mat3f> deformation_gradient;  ///< turns rest normals by its inverse transpose
};

/// A backend other than the processor's may keep the large arrays to itself. state(), work(), surface() and
/// world_surface() then wait for them; figures(), exchange() and the like never do. Not for several threads at once.
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
    const tissue::State& state() const {
        if (state_lags_) fetch_state();
        return state_;
    }
    const Work& work() const {
        if (state_lags_) fetch_state();
        if (surface_lags_) fetch_surface();
        return work_;
    }
    const surface::Surface& surface() const {
        if (surface_lags_) fetch_surface();
        return work_.surface;
    }

    /// The state without its arrays, of which only State::hexel_present is sure to be of now.
    const tissue::State& figures() const { return state_; }
    const tissue::Exchange& exchange() const { return work_.exchange; }
    const std::vector<tissue::Capsule>& capsules() const { return work_.exchange.capsules; }
    const effects::Smoke& smoke() const { return work_.smoke; }
    const effects::Bleeding& bleeding() const { return work_.bleeding; }
    const std::array<float, kStages>& stage_us() const { return work_.stage_us; }

    /// Who computes the ticks.
    const Backend& backend() const { return *backend_; }
    /// What became of the backend that was asked for, if it failed: for people.
    const std::vector<std::string>& notices() const { return notices_; }

    /// Whether displacements are on a device, and world_surface() is the way to have the surface moved by them.
    bool moves_surface_itself() const { return kept_.has_value(); }
    /// World positions and deformation gradients of Surface::smooth_mesh()'s vertices.
    void world_surface(WorldSurface& out) const;

    /// delivered - (outflow + gas + surface + perfusion + debris + tip + stored), as a fraction of delivered (0 when
    /// none).
    double energy_imbalance() const;

  private:
    /// Where to go on from when the backend fails: a complete state, and the inputs since.
    struct Kept {
        tissue::State state;
        std::string effects;  ///< archive_effects()
        std::vector<tissue::Input> inputs;
    };
    /// Ticks between such states. Their arrays have to come from the device; what has to be done again is at most this.
    static constexpr std::int64_t kKeptTicks = 512;

    void start_backend();
    void keep();
    void keep_effects();
    void tick_with_backend(const tissue::Input& input);
    void fetch_state() const;
    void fetch_surface() const;
    void fall_back(const std::string& why) const;
    void note(const std::string& notice) const;

    std::shared_ptr<const Setup> setup_;
    // Mutable: looking at them may bring them up to date, and show that the backend is lost.
    mutable tissue::State state_;
    mutable Work work_;
    mutable std::unique_ptr<Backend> backend_;
    mutable std::optional<Kept> kept_;  ///< while the backend does not keep the host current
    mutable bool state_lags_ = false, surface_lags_ = false;
    mutable std::vector<std::string> notices_;

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

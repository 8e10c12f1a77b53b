#pragma once
// A hand, a device, a servo loop and a simulation on one virtual clock.

#include <functional>
#include <memory>
#include <vector>

#include "calot/anatomy/block.h"
#include "calot/anatomy/shapes.h"
#include "calot/haptics/session.h"
#include "calot/haptics/simulated.h"
#include "calot/instruments/hook.h"
#include "calot/simulation/setup.h"
#include "calot/simulation/simulation.h"
#include "calot/tissue/sampling.h"

namespace calot::haptics {

inline const Vec3 kTrocar_m(0.0, -0.08, 0.14);

/// 5 kPa fat, 36 x 36 x 28.8 mm, its top at z = 0.
inline std::shared_ptr<simulation::Setup> fat_setup() {
    auto setup = std::make_shared<simulation::Setup>();
    setup->anatomy = anatomy::make_block({.size_m = Vec3(0.036, 0.036, 0.0288)});
    setup->model = tissue::sample(setup->anatomy, {});
    return setup;
}

/// A smaller block, for what needs no depth.
inline std::shared_ptr<simulation::Setup> small_setup() {
    auto setup = std::make_shared<simulation::Setup>();
    setup->anatomy = anatomy::make_block({.size_m = Vec3(0.0192, 0.0192, 0.0144)});
    setup->model = tissue::sample(setup->anatomy, {});
    return setup;
}

/// One with a rigid wall beside it, x > 10 mm, whose top is at z = 0 too.
inline std::shared_ptr<simulation::Setup> wall_setup() {
    auto setup = std::make_shared<simulation::Setup>();
    setup->anatomy = anatomy::make_block({.size_m = Vec3(0.0144, 0.0144, 0.0096)});
    setup->anatomy.organs.push_back(
        {"wall", "liver", false, anatomy::make_box(Vec3(0.01, -0.03, -0.03), Vec3(0.06, 0.03, 0.0))});
    setup->model = tissue::sample(setup->anatomy, {});
    return setup;
}

inline SessionOptions rig_options() {
    SessionOptions options;
    options.threads = false;
    options.mapping.trocar_m = kTrocar_m;
    options.mapping.device_to_world = device_to_world(Vec3(0.0, -1.0, 0.0), Vec3(0.0), Vec3(0.0, 0.0, 1.0));
    return options;
}

/// What one tick was like.
struct Moment {
    double time_s = 0.0;
    Vec3 tip_m{0.0};
    Vec3 tissue_N{0.0};
    bool driven = false;
    ServoState servo;
};

class Rig {
  public:
    Rig(std::shared_ptr<const simulation::Setup> setup, std::vector<HandKey> script, const Vec3& start_m,
        const SessionOptions& options = rig_options(), const HandParameters& hand = {})
        : run_(std::move(setup)) {
        auto device = std::make_unique<SimulatedDevice>(std::move(script), hand);
        device_ = device.get();
        session_ = std::make_unique<Session>(std::move(device), options);
        input_.hook = instruments::pose_through_trocar(kTrocar_m, start_m, 0.0);
        session_->keep();
    }

    /// A millisecond: one servo step, one tick. `simulate` false: the simulation hangs.
    const Moment& tick(bool simulate = true) {
        time_s_ += 1e-3;
        session_->servo_step(time_s_);
        moment_.time_s = time_s_;
        if (simulate) {
            tissue::Input input = input_;
            moment_.driven = session_->drive(input);
            run_.tick(input);
            session_->feel(run_.state());
            input_.hook = input.hook;
            moment_.tip_m = input.hook.position_m;
            moment_.tissue_N = run_.state().hook_force_N;
        }
        moment_.servo = session_->status().servo;
        return moment_;
    }

    SimulatedDevice& device() { return *device_; }
    Session& session() { return *session_; }
    simulation::Simulation& simulation() { return run_; }
    tissue::Input& input() { return input_; }
    double time_s() const { return time_s_; }

  private:
    simulation::Simulation run_;
    SimulatedDevice* device_ = nullptr;
    std::unique_ptr<Session> session_;
    tissue::Input input_;
    Moment moment_;
    double time_s_ = 100.0;  // clocks do not begin at 0
};

}  // namespace calot::haptics

#include "calot/simulation/step.h"

#include <chrono>

#include "calot/base/parallel.h"
#include "calot/deformation/embedding.h"
#include "calot/deformation/grasp.h"
#include "calot/deformation/integrate.h"
#include "calot/deformation/settle.h"
#include "calot/deformation/tear.h"
#include "calot/deformation/topology.h"
#include "calot/instruments/contact.h"

namespace calot::simulation {

namespace {

/// Hexels this close to the hook are embedded and offered to contact and current.
constexpr double kReach_m = 2e-3;

/// Wall time of each stage. It is shown to people and never flows back into the state.
class StageClock {
  public:
    explicit StageClock(std::array<float, kStages>& stage_us) : stage_us_(stage_us), last_(Clock::now()) {}
    void restart() { last_ = Clock::now(); }
    void lap(Stage stage) {
        const auto now = Clock::now();
        stage_us_[static_cast<std::size_t>(stage)] = std::chrono::duration<float, std::micro>(now - last_).count();
        last_ = now;
    }

  private:
    using Clock = std::chrono::steady_clock;
    std::array<float, kStages>& stage_us_;
    Clock::time_point last_;
};

/// Where this tick's gas came from, in the world: smoke starts there.
void place_gas(const tissue::Model& model, const tissue::State& state, Work& work) {
    work.gas_rest_m.clear();
    work.gas_owner.clear();
    for (const tissue::GasEvent& event : work.exchange.gas) {
        work.gas_rest_m.push_back(Vec3f(model.hexels.centre_m(event.hexel)));
        work.gas_owner.push_back(event.hexel);
    }
    work.gas_world_m.resize(work.gas_rest_m.size());
    deformation::embed_points(model, state, work.deformation, work.gas_rest_m, work.gas_owner, work.gas_world_m);
}

void place_instruments(const tissue::Model& model, const tissue::State& state, Work& work, const tissue::Input& input) {
    instruments::place_hook(work.hook, input.hook, state.tick == 0 ? input.hook : state.hook, model.tick_s,
                            work.exchange.capsules);
    tissue::GrasperInput& grasper = work.exchange.grasper;
    grasper = input.grasper;
    grasper.jaw = deformation::stopped_jaw(grasper, state.grasper.held);
    const tissue::GrasperInput before{state.grasper.present != 0, state.grasper.pose, state.grasper.jaw};
    instruments::place_grasper(work.grasper, grasper, before, state.grasper.held > 0, model.tick_s,
                               work.exchange.capsules);
}

void remember_instruments(tissue::State& state, const tissue::Exchange& exchange, const tissue::Input& input) {
    state.hook = input.hook;
    state.grasper.present = exchange.grasper.present ? 1 : 0;
    state.grasper.pose = exchange.grasper.pose;
    state.grasper.jaw = exchange.grasper.jaw;
    state.hook_force_N = exchange.contact_force_N + exchange.organ_force_N;
    state.grasper.force_N = exchange.grasper_contact_force_N + exchange.grasper_organ_force_N;
}

}  // namespace

void step(const tissue::Model& model, tissue::State& state, Work& work, const tissue::Input& input) {
    tissue::Exchange& exchange = work.exchange;
    exchange.removed_hexels.clear();
    exchange.changed_phyxels.clear();
    exchange.gas.clear();

    StageClock clock(work.stage_us);
    place_instruments(model, state, work, input);
    deformation::find_near(model, state, exchange, work.deformation, kReach_m);
    instruments::find_contacts(model, state, exchange);
    deformation::update_grasp(model, state, exchange,
                              {work.grasper.jaw_length_m, 0.5 * work.grasper.jaw_diameter_m, work.grasper.opening_rad});
    clock.lap(Stage::contact);

    // Tissue moves by forces, warms by currents: within a tick neither asks the other.
    parallel_pair(
        "simulation.move_and_heat",
        [&] {
            StageClock moving(work.stage_us);
            deformation::settle(state);
            deformation::advance(model, state, exchange, work.deformation);
            moving.lap(Stage::deformation);
        },
        [&] {
            StageClock heating(work.stage_us);
            electric::step_field(model, state, exchange, input, *work.electric);
            heating.lap(Stage::electric);
            if (input.wipe_tip) state.tip.char_kg = 0.0;
            thermal::conduct(model, state, exchange, work.thermal);
            heating.lap(Stage::heat);
        });
    deformation::check(model, state, work.deformation);
    remember_instruments(state, exchange, input);

    clock.restart();
    thermal::remove_vaporised(model, state, exchange, work.thermal);
    place_gas(model, state, work);  // while the phyxels that carried it are still there
    clock.lap(Stage::removal);

    deformation::tear_overstretched(model, state, exchange, work.deformation);
    deformation::sever_burnt_links(model, state, exchange, work.deformation);
    clock.lap(Stage::topology);

    work.surface.update_dirty_blocks(model, state, exchange);
    clock.lap(Stage::surface);

    work.smoke.step(exchange, work.gas_world_m, state.tick, model.tick_s, input.suction);
    work.bleeding.step(model, state, exchange, input);
    clock.lap(Stage::smoke);

    ++state.tick;
}

}  // namespace calot::simulation

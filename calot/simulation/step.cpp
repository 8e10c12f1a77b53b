#include "calot/simulation/step.h"

#include <algorithm>

#include "calot/base/parallel.h"
#include "calot/deformation/embedding.h"
#include "calot/deformation/integrate.h"
#include "calot/deformation/tear.h"
#include "calot/deformation/topology.h"
#include "calot/simulation/step_parts.h"

namespace calot::simulation {

namespace {

/// Ticks of a frame in which blocks of the surface are redone, the rest being for hexels that go: `count` from `first`
/// on. What comes late in them stays for the next, rather than make the last long.
struct SurfaceTurns {
    int first, count;
};
constexpr SurfaceTurns kSurfaceTurns{5, 6};

}  // namespace

void step(const tissue::Model& model, tissue::State& state, Work& work, const tissue::Input& input) {
    tissue::Exchange& exchange = work.exchange;
    clear_exchange(exchange);

    StageClock clock(work.stage_us);
    place_instruments(model, state, work, input);
    deformation::find_near(model, state, exchange, work.deformation, near_reach(model, state, exchange, input));
    find_contacts(model, state, work);
    clock.lap(Stage::contact);

    // Tissue moves by forces, warms by currents: within a tick neither asks the other.
    parallel_pair(
        "simulation.move_and_heat",
        [&] {
            StageClock moving(work.stage_us);
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
    list_gas(model, work);  // while the phyxels that carried it are still there
    deformation::embed_points(model, state, work.deformation, work.gas.rest_m, work.gas.owner, work.gas.world_m);
    place_gas(model, work);
    clock.lap(Stage::removal);

    deformation::tear_overstretched(model, state, exchange, work.deformation);
    deformation::sever_burnt_links(model, state, exchange, work.deformation);
    clock.lap(Stage::topology);

    // What is seen may wait for ticks with little else to do; who asks for the mesh before gets it as it is now.
    work.surface.remove(exchange);
    const auto turn = static_cast<int>((state.tick - kSurfaceTurns.first) & (tissue::Model::frame_ticks - 1));
    if (turn < kSurfaceTurns.count) work.surface.redo_dirty_blocks(std::max(kSurfaceTurns.count - turn, 2));
    clock.lap(Stage::surface);

    work.smoke.step(exchange, work.gas.event_m, state.tick, model.tick_s, input.suction);
    work.bleeding.step(model, state, exchange, input);
    clock.lap(Stage::smoke);

    ++state.tick;
}

}  // namespace calot::simulation

// Heat: OpenVDB's Laplacian of the temperature against a whole step of ours (conduction, surroundings, perfusion, phase
// change, damage), every hexel warm. Theirs is the Laplacian alone: it flatters them.

#include <openvdb/openvdb.h>
#include <openvdb/tools/GridOperators.h>

#include <fmt/format.h>

#include "apps/calot/bench_bodies.h"
#include "calot/base/random.h"
#include "calot/thermal/heat.h"
#include "rivals.h"

namespace calot::rivals {

void race_heat() {
    openvdb::initialize();
    for (const std::int64_t hexels : {std::int64_t{147'233}, std::int64_t{1'178'091}}) {
        const tissue::Model model = app::hexel_block(hexels);
        tissue::State state = tissue::State::make(model);
        Random random(1);
        const auto temperature = openvdb::FloatGrid::create(310.15f);
        auto accessor = temperature->getAccessor();
        const Int3 size = model.hexels.size;
        for (int z = 0; z < size.z; ++z)
            for (int y = 0; y < size.y; ++y)
                for (int x = 0; x < size.x; ++x) {
                    const std::int64_t cell = model.hexels.index(x, y, z);
                    if (!state.hexel_present.test(cell)) continue;
                    const auto enthalpy = static_cast<float>(random.uniform(0.0, 1e7));
                    state.enthalpy_J_per_m3[static_cast<std::size_t>(cell)] = enthalpy;
                    accessor.setValue({x, y, z}, 310.15f + enthalpy / 2.1e6f);
                }
        tissue::Exchange exchange;
        tissue::reserve_exchange(model, exchange);
        thermal::Work work = thermal::make_work(model, state);
        const double steps_per_second = 1.0 / (model.tick_s * model.thermal.refresh_ticks);
        Race race;
        race.what = fmt::format("heat step, {} hexels", hexels);
        race.theirs_name = "OpenVDB tools::laplacian";
        race.ours = [&] {
            for (int k = 0; k < model.thermal.refresh_ticks; ++k, ++state.tick) {
                exchange.gas.clear();
                exchange.removed_hexels.clear();
                thermal::conduct(model, state, exchange, work);
                thermal::remove_vaporised(model, state, exchange, work);
            }
        };
        race.theirs = [&] { openvdb::tools::laplacian(*temperature); };
        race.ours_per_second = race.theirs_per_second = steps_per_second;
        race.note = "both at our step of 4 ms; ours is the whole step, theirs the Laplacian alone";
        run(race, hexels > 1'000'000 ? 15 : 40);
    }
}

}  // namespace calot::rivals

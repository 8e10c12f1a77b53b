#pragma once
// One tick of everything, in order.

#include <array>
#include <cstdint>
#include <vector>

#include "calot/deformation/work.h"
#include "calot/effects/bleeding.h"
#include "calot/effects/smoke.h"
#include "calot/electric/solve.h"
#include "calot/instruments/grasper.h"
#include "calot/instruments/hook.h"
#include "calot/surface/surface.h"
#include "calot/thermal/heat.h"
#include "calot/tissue/exchange.h"
#include "calot/tissue/input.h"
#include "calot/tissue/state.h"

namespace calot::simulation {

/// The stages of a tick, in their order.
enum class Stage { contact, deformation, electric, heat, removal, topology, surface, smoke };
inline constexpr int kStages = 8;
inline constexpr std::array<const char*, kStages> kStageNames{"contact", "deformation", "electric", "heat",
                                                              "removal", "topology",    "surface",  "smoke"};

/// Where Exchange::gas comes from. What comes from one phyxel hangs on its first event there: `source`.
struct GasPlaces {
    std::vector<Vec3f> rest_m, world_m;  ///< of the sources
    std::vector<std::int64_t> owner;     ///< hexels of the sources
    std::vector<std::int64_t> phyxel;    ///< of the sources
    std::vector<std::int32_t> source;    ///< of each event
    std::vector<Vec3f> event_m;          ///< in the world, of each event
};

/// Scratch of all rooms, with what they exchange and how long the stages of the last tick took.
struct Work {
    instruments::HookShape hook;
    instruments::GrasperShape grasper;
    tissue::Exchange exchange;
    deformation::Work deformation;
    electric::WorkPtr electric;
    thermal::Work thermal;
    surface::Surface surface;
    effects::Smoke smoke;
    effects::Bleeding bleeding;
    GasPlaces gas;
    std::array<float, kStages> stage_us{};  ///< wall time of the last tick's stages

    Work(const tissue::Model& model, const tissue::State& state, const instruments::HookShape& hook,
         const effects::SmokeParameters& smoke, const instruments::GrasperShape& grasper = {});
};

/// Advances the state by Model::tick_s. Does not throw, allocate, log or lock.
void step(const tissue::Model& model, tissue::State& state, Work& work, const tissue::Input& input);

}  // namespace calot::simulation

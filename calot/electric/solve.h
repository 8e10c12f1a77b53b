#pragma once
// The electric field around the tip and the heat it makes (docs/physics.md section 5).

#include <memory>

#include "calot/base/array.h"
#include "calot/tissue/exchange.h"
#include "calot/tissue/input.h"
#include "calot/tissue/state.h"

namespace calot::electric {

/// Scratch, sized at set-up. (Its contents are the room's own.)
struct Work;
struct WorkDeleter {
    void operator()(Work*) const;
};
using WorkPtr = std::unique_ptr<Work, WorkDeleter>;
WorkPtr make_work(const tissue::Model& model);

/// One tick. The field of one volt on the metal, div(sigma grad phi) = 0 in a window of hexels about the bare tip, is
/// solved over each frame of Model::frame_ticks in which metal touches tissue (or an arc could strike):
///
///     tick 0  place the window, conductivities, contacts     4 5 6  an iteration each, until the residual is small
///          1  matrix                                         7      heat and potential of the new field
///          2  coarse matrices, last potential
///          3  its residual
///
/// Between, the field of the frame before holds, for tissue as it was then; hexels that are gone take no heat. Whether
/// the pedal is down or not the field is solved, so that current flows in the tick in which it goes down. In every tick
/// the generator meets the load (State::generator), and Exchange::joule is the heat at its voltage. A released pedal or
/// a lost contact ends the current at once.
void step_field(const tissue::Model& model, tissue::State& state, tissue::Exchange& exchange,
                const tissue::Input& input, Work& work);

/// What the generator gives now, the heat that it makes, and where it goes, by State::field. (The last part of
/// step_field, for fields that are solved elsewhere.)
void drive_load(const tissue::Model& model, tissue::State& state, tissue::Exchange& exchange,
                const tissue::Input& input);

/// step_field with a whole solve in this very tick, to the residual of ElectricParameters. (For validation.)
void solve_now(const tissue::Model& model, tissue::State& state, tissue::Exchange& exchange, const tissue::Input& input,
               Work& work);

}  // namespace calot::electric

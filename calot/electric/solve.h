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

/// Every ElectricParameters::refresh_ticks: solves div(sigma grad phi) = 0 in a window of hexels about the bare tip,
/// electrode = hexels of Exchange::near with bare_gap_m <= ElectricParameters::contact_gap_m, outer faces Robin 1/r,
/// and writes Exchange::joule scaled to the power that the source gives (power-limited, never above the voltage limit),
/// State::generator, State::potential. Organs that hold tissue conduct, so that current leaves the tissue through them.
/// On the other ticks nothing changes, except that a released pedal or a lost contact ends the current at once.
void solve_potential(const tissue::Model& model, tissue::State& state, tissue::Exchange& exchange,
                     const tissue::Input& input, Work& work);

}  // namespace calot::electric

#pragma once
// Heat: conduction, surroundings, boiling, gasification, damage (docs/physics.md section 6).
//
// A heat step is explicit in the enthalpy H. It is spread over the ThermalParameters::refresh_ticks ticks of its
// interval, block by block (of 256 consecutive cells), as much work in each tick as in any other:
//
//     tick     0                                1               ...   7
//     begin: warm blocks --dilate--> active     .               .     .
//     the first blocks                          the next        .     the last
//     a quarter of the hexels that are gas      a quarter       .     a quarter
//
// Each block takes Joule heat, exchanges heat with temperatures of the start of the step, and gets its temperatures of
// the end, which lie in an array of their own until the step is done. So blocks need no order, and hexels that vanish
// meanwhile (burnt, fallen) still take their part in the exchange that has begun; what that leaves in them is booked
// with them at the end of the step. Between ticks, EnergyBudget::transit holds what blocks that had their turn owe to
// those that had not: the budget closes at every tick.
//
// A group of 16 cells is warm when any of its hexels has a temperature other than body temperature (tissue::kRest_K and
// more away from it); its neighbours are active too, and those that Joule heat reaches. Everything that exchanges heat
// is zero at body temperature, so that skipping the other groups changes no byte: heat cannot be lost at the cold
// front. Blocks with active groups take turns. Which groups are active, and hence when each block has its turn, is a
// function of State alone.

#include <cstdint>
#include <vector>

#include "calot/base/array.h"
#include "calot/thermal/blocks.h"
#include "calot/thermal/groups.h"
#include "calot/thermal/properties.h"
#include "calot/tissue/exchange.h"
#include "calot/tissue/state.h"

namespace calot::thermal {

/// What hexels contributed to a heat step, per cubic metre of hexel: sums over them [J/m^3].
struct HeatSums {
    double delivered = 0.0;  ///< by Joule heat
    double conducted = 0.0;  ///< into hexels that are still there; zero over all blocks, up to rounding
    double surface = 0.0;
    double perfusion = 0.0;
    double gas = 0.0;
    double latent = 0.0;
    std::int64_t bad_hexel = -1;  ///< the first whose enthalpy is no longer a number
};

/// What a heat step found in a block.
struct BlockMarks {
    std::uint16_t warm = 0;  ///< its groups with hexels that are not at body temperature now
    bool changed = false;  ///< some that boiled or took damage
    bool boiled = false;   ///< Work::steam_kg_per_m3 has entries
    bool spent = false;    ///< some that are gas
};

/// Scratch. What lies in it at the end of a heat step is a function of State.
struct Work {
    Array<float> temperature_K;  ///< [hexels.cells] of every present hexel at the end of the last complete heat step
    BlockSet active;             ///< blocks that take part in this step, in active_groups
    bool dense = false;          ///< every block takes part: for comparison only
    bool scalar = false;         ///< take the scalar reference kernels: for comparison only

    // The room's own.
    Properties properties;
    Groups groups;
    Array<float> next_temperature_K;   ///< [hexels.cells] of the step under way; of resting blocks as the other
    Array<float> steam_kg_per_m3;      ///< [hexels.cells] boiled off in this tick; zero between ticks
    BitArray present;                  ///< hexels when the step began
    BlockSet populated;                ///< blocks that ever held tissue
    BlockSet populated_groups, warm, active_groups, heated;  ///< groups that ever did, that are warm, active, were
                                                             ///< active in the step before
    BlockSet late;                     ///< groups that Joule heat reaches since the step began
    Int3 joule_low{0}, joule_size{0};  ///< where it was looked for last
    std::vector<std::int32_t> turns;   ///< the active blocks of this step, ascending
    std::vector<std::uint8_t> costs;   ///< of each, in vectors of cells
    std::vector<std::size_t> slices;   ///< where each tick's part of them begins, and the end
    std::vector<BlockMarks> marks;     ///< of each
    std::vector<HeatSums> sums;        ///< of each chunk of a tick's part
    std::vector<std::int32_t> spent;     ///< hexels that are gas and have still to go, ascending
    std::size_t waiting = 0;             ///< how many of them there were before this tick
    std::vector<float> sticks;           ///< share of the solids of each that goes now which stays on the wire
    std::vector<std::int32_t> burnt;     ///< hexels that went since the step began
    std::int64_t fallen = 0;             ///< State::hexels_fallen when it began
    int substeps = 1;                    ///< more than one where a step would not be stable; then all in its first tick
};
Work make_work(const tissue::Model& model, const tissue::State& state);

using tissue::temperature_K;

/// This tick's part of a heat step: the hot wire, conduction, surroundings, blood, Joule heat (Exchange::joule),
/// boiling (State::water, GasEvents), damage and peak temperature, with the energy budget. Books as
/// EnergyBudget::delivered what Exchange::joule really put into hexels (those burnt since the field was solved get
/// nothing) plus its outflow.
void conduct(const tissue::Model& model, tissue::State& state, tissue::Exchange& exchange, Work& work);

/// Takes a quarter of the hexels whose latent budget is spent out of State::hexel_present, and
/// lists them in Exchange::removed_hexels, in the order of their cells, with their GasEvents.
void remove_vaporised(const tissue::Model& model, tissue::State& state, tissue::Exchange& exchange, Work& work);

/// Enthalpy stored in present hexels [J].
double stored_J(const tissue::Model& model, const tissue::State& state);

/// What heat did to one tissue.
struct MaterialInjury {
    tissue::MaterialIndex material = tissue::kNoMaterial;
    std::int64_t present_hexels = 0;
    std::int64_t removed_hexels = 0;  ///< burnt or fallen
    std::int64_t damaged_hexels = 0;  ///< present with Omega >= 1: irreversibly coagulated
    double damaged_volume_m3 = 0.0;   ///< of those
    double peak_temperature_K = 0.0;  ///< hottest so far, removed hexels included
};
/// One entry per material that the model holds hexels of, ascending.
std::vector<MaterialInjury> injuries(const tissue::Model& model, const tissue::State& state);

}  // namespace calot::thermal

#pragma once
// Heat: conduction, surroundings, boiling, gasification, damage (docs/physics.md section 6).
//
// A heat step is explicit in the enthalpy H and runs over blocks of consecutive cells:
//
//     warm blocks --dilate--> active blocks --deposit q--> conduct (T -> H) --> settle (H -> water, T, damage)
//
// A block is warm when any of its hexels has a temperature other than body temperature, bit by bit; its neighbours are
// active too. Everything that exchanges heat is zero at body temperature, so that skipping the other blocks changes no
// byte: heat cannot be lost at the cold front, and which blocks are warm is a function of State alone.

#include <cstdint>
#include <vector>

#include "calot/base/array.h"
#include "calot/thermal/properties.h"
#include "calot/tissue/exchange.h"
#include "calot/tissue/state.h"

namespace calot::thermal {

/// What one block of cells contributed to a heat step, per cubic metre of hexel: sums over its hexels [J/m^3].
struct BlockSums {
    double surface = 0.0;
    double perfusion = 0.0;
    double gas = 0.0;
    double latent = 0.0;
    std::int64_t bad_hexel = -1;  ///< the first whose enthalpy is no longer a number
    bool boiled = false;          ///< Work::steam_kg_per_m3 has entries
    bool spent = false;           ///< holds hexels that are gas now
};

/// Scratch. `temperature_K` is current for every present hexel at the end of conduct().
struct Work {
    Array<float> temperature_K;        ///< [hexels.cells]
    std::vector<std::int32_t> blocks;  ///< active in this step, ascending
    bool dense = false;                ///< every block is active: for comparison only
    bool scalar = false;               ///< take the scalar reference kernels: for comparison only

    // The room's own.
    Properties properties;
    Array<float> steam_kg_per_m3;        ///< [hexels.cells] boiled off in this step; zero between steps
    Array<std::uint8_t> group_material;  ///< see Properties
    std::vector<std::uint8_t> warm;      ///< [blocks] a superset of the warm blocks
    std::vector<std::uint8_t> active;    ///< [blocks]
    std::vector<BlockSums> sums;         ///< [active blocks]
    std::vector<double> plane_sums;      ///< Joule heat of each plane of the window
    int substeps = 1;                    ///< of a heat step, so that it is stable
};
Work make_work(const tissue::Model& model, const tissue::State& state);

using tissue::temperature_K;

/// Every ThermalParameters::refresh_ticks: one step of conduction, surroundings, perfusion, Joule heat
/// (Exchange::joule), boiling (State::water, GasEvents), damage and peak temperature, with the energy budget. On other
/// ticks returns at once. Books as EnergyBudget::delivered what Exchange::joule really put into hexels (those burnt
/// since the field was solved get nothing) plus its outflow.
void conduct(const tissue::Model& model, tissue::State& state, tissue::Exchange& exchange, Work& work);

/// Takes hexels whose latent budget is spent out of State::hexel_present and lists them in Exchange::removed_hexels, in
/// the order of their cells, with their GasEvents.
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

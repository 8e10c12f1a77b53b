#pragma once
// What the electric room works with between set-up and the last tick.

#include <cstdint>
#include <vector>

#include "calot/base/array.h"
#include "calot/electric/contact.h"
#include "calot/electric/multigrid.h"
#include "calot/electric/solve.h"
#include "calot/electric/window.h"

namespace calot::electric {

/// An outer face of the window that cuts through conducting matter.
struct OuterFace {
    std::int32_t cell = 0;
    float g = 0.0f;       ///< from the cell's centre to the far return electrode, S/m
    float inside = 0.0f;  ///< share of its heat that is made in half the cell
};

struct Work {
    Array<float> hexel_conductivity_S_per_m;  ///< [hexels.cells] at body temperature, see conductivity.h
    Conductivity conductivity;
    Multigrid grid;

    // The present solve; indices are those of the finest level.
    bool solving = false;  ///< a frame's solve is under way
    Window window;
    CellStorage storage;
    Cells sigma_S_per_m;              ///< conductivity of each cell, 0 = gas
    std::vector<std::uint8_t> alive;  ///< [groups of the finest level] held conducting cells in the last solve
    std::vector<Entry> entries;       ///< where current enters, a cell at most once
    std::vector<std::int32_t> electrode_cells;  ///< of the entries
    std::vector<std::int32_t> near_of_entry;    ///< index into Exchange::near
    Vec3 centre{0.0};                           ///< of the entries, window coordinates
    std::int64_t arcs = 0;                      ///< entries that are arcs
    BitArray entered;                           ///< cells of the entries
    std::vector<OuterFace> outer_faces;
    std::vector<RightEntry> right;
    bool finite = true;  ///< the potential, of the last solve
    const float* kept = nullptr;  ///< State::potential that krylov.x is, in the window at State::field_low
    double scale = 1.0;  ///< its best multiple
    HeatSums sums;

    // What came out, for tests and benchmarks
    double conductance_S = 0.0;            ///< by the heat: sum of g dphi^2
    double electrode_conductance_S = 0.0;  ///< by the current out of the electrode
    int iterations = 0;
};

WorkPtr make_work(const tissue::Model& model, const Kernels& kernels);

// The parts of a solve, in their order. step_field spreads them over the ticks of a frame.
/// Places the window, looks at the tissue's conductivity, finds where current enters (assemble.cpp).
void gather(const tissue::Model& model, const tissue::State& state, const tissue::Exchange& exchange,
            const tissue::Input& input, Work& work);
/// The matrix of the finest level (assemble.cpp).
void assemble(const tissue::Model& model, Work& work);
/// Coarse matrices, and the last potential as a first guess.
void prepare(const tissue::State& state, Work& work);
/// The first guess' residual.
void begin_field(Work& work);
/// At most `count` iterations; true when the residual is reached.
bool iterate_field(const tissue::Model& model, Work& work, int count);
/// The best multiple of the potential, and the heat between cells.
void weigh_field(Work& work);
/// Heat of one volt, potential, conductances into the state.
void finish_field(const tissue::Model& model, tissue::State& state, Work& work);

/// Heat of the field in krylov.x, scaled, in the cells; and for one volt into State::joule_S_per_m3, with its sums
/// (joule.cpp).
void spread_heat(Work& work);
void keep_heat(const tissue::Model& model, tissue::State& state, Work& work);

}  // namespace calot::electric

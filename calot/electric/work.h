#pragma once
// What the electric room works with between set-up and the last tick.

#include <cstdint>
#include <vector>

#include "calot/base/array.h"
#include "calot/electric/multigrid.h"
#include "calot/electric/solve.h"
#include "calot/electric/window.h"

namespace calot::electric {

/// A face between an electrode's cell and an unknown one.
struct ElectrodeFace {
    std::int32_t electrode = 0;
    std::int32_t cell = 0;
    float g = 0.0f;  ///< S/m
};

/// An outer face of the window that cuts through conducting matter.
struct OuterFace {
    std::int32_t cell = 0;
    float g = 0.0f;  ///< from the cell's centre to the far return electrode, S/m
};

struct Work {
    Array<float> hexel_conductivity_S_per_m;  ///< [hexels.cells] see conductivity.h
    Multigrid grid;

    // The present solve; indices are those of the finest level.
    Window window;
    CellStorage storage;
    Cells sigma_S_per_m;  ///< conductivity of each cell, 0 = gas
    BitArray electrode;
    std::vector<std::int32_t> electrode_cells;
    std::vector<ElectrodeFace> electrode_faces;
    std::vector<OuterFace> outer_faces;
    std::vector<RightEntry> right;
    Array<float> joule_W_per_m3;  ///< handed to Exchange::joule at the first solve

    // What came out, for tests and benchmarks
    double conductance_S = 0.0;            ///< by the heat: sum of g dphi^2
    double electrode_conductance_S = 0.0;  ///< by the current out of the electrode
    int iterations = 0;
};

WorkPtr make_work(const tissue::Model& model, const Kernels& kernels);

// A solve in three parts, so that its iterations can be spread over ticks.
void begin_field(const tissue::Model& model, const tissue::State& state, const tissue::Exchange& exchange, Work& work);
/// True when the residual is reached.
bool iterate_field(const tissue::Model& model, Work& work, int count);
void finish_field(const tissue::Model& model, tissue::State& state, tissue::Exchange& exchange,
                  const tissue::Input& input, Work& work);

/// Matrix of the finest level from the tissue as it is: conductivities, electrode, outer faces (assemble.cpp).
void assemble(const tissue::Model& model, const tissue::State& state, const tissue::Exchange& exchange, Work& work);

/// Heat of the field in krylov.x for one volt, and conductance_S (joule.cpp).
void find_heat(const tissue::Model& model, const tissue::State& state, Work& work, double& tissue_W,
               double& elsewhere_W);
/// Writes Exchange::joule for the voltage.
void write_heat(const tissue::Model& model, tissue::Exchange& exchange, Work& work, double voltage_V);

}  // namespace calot::electric

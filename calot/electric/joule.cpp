// Joule heat q = sigma |grad phi|^2 (Pan et al. 2019, Eq. 16) of the solved field, face by face.
//
// A face between cells 1 and 2 carries J = g (phi_1 - phi_2) through half a cell of sigma_1 and half a cell of sigma_2
// in series. Each half heats its own cell with J^2 / (2 sigma), so that both halves make g dphi^2 together and the sum
// over all cells is V I to the last digit. All per volt squared and per spacing of hexels until the end.

#include <algorithm>
#include <array>

#include "calot/base/parallel.h"
#include "calot/electric/work.h"

namespace calot::electric {

namespace {

float half_cell_heat(float flow, float sigma) {
    return 0.5f * flow * flow / sigma;
}

/// Faces that are not in the matrix: at the electrode, and to the far return. Returns what is lost beyond the window.
double add_fixed_faces(Work& work, Cells phi, Cells heat) {
    double current = 0.0;
    for (const ElectrodeFace& face : work.electrode_faces) {
        const auto metal = static_cast<std::size_t>(face.electrode), cell = static_cast<std::size_t>(face.cell);
        const float flow = face.g * (1.0f - phi[cell]);
        heat[metal] += half_cell_heat(flow, work.sigma_S_per_m[metal]);
        heat[cell] += half_cell_heat(flow, work.sigma_S_per_m[cell]);
        current += static_cast<double>(flow);
    }
    double beyond = 0.0;
    for (const OuterFace& face : work.outer_faces) {
        const auto cell = static_cast<std::size_t>(face.cell);
        const float flow = face.g * phi[cell], inside = half_cell_heat(flow, work.sigma_S_per_m[cell]);
        heat[cell] += inside;
        beyond += static_cast<double>(flow) * static_cast<double>(phi[cell]) - static_cast<double>(inside);
        if (work.electrode.test(face.cell)) current += static_cast<double>(flow);
    }
    work.electrode_conductance_S = current;
    return beyond;
}

}  // namespace

void find_heat(const tissue::Model& model, const tissue::State& state, Work& work, double& tissue_W,
               double& elsewhere_W) {
    Level& fine = work.grid.levels[0];
    const Cells phi = work.grid.krylov.x;
    const Cells heat = fine.solution;
    parallel_for("electric.heat", 0, fine.group_capacity(), 2048, [&](std::int64_t b, std::int64_t e) {
        work.grid.kernels.heat(fine, work.sigma_S_per_m.data(), phi.data(), heat.data(), b, e);
    });
    const double beyond = add_fixed_faces(work, phi, heat);
    const Window& window = work.window;
    HeatSums sums;
    for (int c = window.begin.z; c < window.end.z; ++c)
        for (int b = window.begin.y; b < window.end.y; ++b)
            work.grid.kernels.split(heat.data() + fine.index(window.begin.x, b, c), state.hexel_present.bytes(),
                                    model.hexels.index(window.to_hexel({window.begin.x, b, c})),
                                    window.end.x - window.begin.x, sums);
    double present = 0.0, held = beyond;
    for (const double sum : sums.kept) present += sum;
    for (const double sum : sums.rest) held += sum;
    const double spacing = model.hexels.spacing_m;
    tissue_W = spacing * present;
    elsewhere_W = spacing * held;
    work.conductance_S = tissue_W + elsewhere_W;
    work.electrode_conductance_S *= spacing;
}

void write_heat(const tissue::Model& model, tissue::Exchange& exchange, Work& work, double voltage_V) {
    tissue::JouleHeat& joule = exchange.joule;
    if (joule.density_W_per_m3.size() < work.joule_W_per_m3.size()) joule.density_W_per_m3.swap(work.joule_W_per_m3);
    const Level& fine = work.grid.levels[0];
    const Window& window = work.window;
    joule.place(model.hexels, window.to_hexel(window.begin),
                window.to_hexel(window.end) - window.to_hexel(window.begin));
    // Per volt squared and spacing -> W/m^3. The window's axes are in the order of the lattice's.
    const double spacing = model.hexels.spacing_m;
    const auto scale = static_cast<float>(voltage_V * voltage_V / (spacing * spacing));
    const Int3 count = window.end - window.begin;
    float* to = joule.density_W_per_m3.data();
    for (int c = 0; c < count.z; ++c)
        for (int b = 0; b < count.y; ++b, to += count.x) {
            const float* from =
                fine.solution.data() + fine.index(window.begin.x, window.begin.y + b, window.begin.z + c);
            for (int a = 0; a < count.x; ++a) to[a] = scale * from[a];
        }
}

}  // namespace calot::electric

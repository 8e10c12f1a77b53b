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

namespace {

/// One plane of the window, transposed: `to` has x along its second axis' unit steps.
///     from[x * from_step + a]  ->  to[x + a * to_step]
/// Eight values of a at a time, so that each line of memory is written from end to end while it is at hand.
void transpose(const float* from, std::int64_t from_step, int count_x, int count_a, float scale, float* to,
               std::int64_t to_step) {
    constexpr int kTile = 8;
    for (int low = 0; low < count_a; low += kTile) {
        const int high = std::min(low + kTile, count_a);
        for (int x = 0; x < count_x; ++x)
            for (int a = low; a < high; ++a) to[x + a * to_step] = scale * from[x * from_step + a];
    }
}

}  // namespace

void write_heat(const tissue::Model& model, tissue::Exchange& exchange, Work& work, double voltage_V) {
    tissue::JouleHeat& joule = exchange.joule;
    if (joule.density_W_per_m3.size() < work.joule_W_per_m3.size()) joule.density_W_per_m3.swap(work.joule_W_per_m3);
    const Level& fine = work.grid.levels[0];
    const Window& window = work.window;
    joule.low = window.to_hexel(window.begin);
    joule.size = window.to_hexel(window.end) - joule.low;
    // Per volt squared and spacing -> W/m^3.
    const double spacing = model.hexels.spacing_m;
    const auto scale = static_cast<float>(voltage_V * voltage_V / (spacing * spacing));
    // Steps along each window axis: in the window, and in the box, where x is fastest.
    const std::array<std::int64_t, 3> from_step{1, fine.row, fine.plane},
        box_step{1, joule.size.x, std::int64_t{joule.size.x} * joule.size.y};
    std::array<std::int64_t, 3> to_step{};
    for (int k = 0; k < 3; ++k)
        to_step[static_cast<std::size_t>(k)] = box_step[static_cast<std::size_t>(window.axis[k])];
    const Int3 count = window.end - window.begin;
    const float* from = fine.solution.data() + fine.index(window.begin.x, window.begin.y, window.begin.z);
    float* to = joule.density_W_per_m3.data();
    if (window.axis.x == 0) {
        for (int c = 0; c < count.z; ++c)
            for (int b = 0; b < count.y; ++b)
                for (int a = 0; a < count.x; ++a)
                    to[a + b * to_step[1] + c * to_step[2]] = scale * from[a + b * from_step[1] + c * from_step[2]];
        return;
    }
    const std::size_t x = window.axis.y == 0 ? 1 : 2, other = 3 - x;
    for (int n = 0; n < count[static_cast<int>(other)]; ++n)
        transpose(from + n * from_step[other], from_step[x], count[static_cast<int>(x)], count.x, scale,
                  to + n * to_step[other], to_step[0]);
}

}  // namespace calot::electric

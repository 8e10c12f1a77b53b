// Joule heat q = sigma |grad phi|^2 (Pan et al. 2019, Eq. 16) of the solved field, face by face.
//
// A face between cells 1 and 2 carries J = g (phi_1 - phi_2) through half a cell of sigma_1 and half a cell of sigma_2
// in series. Each half heats its own cell with J^2 / (2 sigma), so that both halves make g dphi^2 together and the sum
// over all cells is V I to the last digit. All per volt squared and per spacing of hexels until the end.

#include "calot/base/parallel.h"
#include "calot/electric/work.h"

namespace calot::electric {

namespace {

float half_cell_heat(float flow, float sigma) {
    return 0.5f * flow * flow / sigma;
}

/// Faces that are not in the matrix: at the electrode, and to the far return. Returns what is lost beyond the window.
double add_fixed_faces(Work& work, const Array<float>& phi, Array<float>& heat) {
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
    const Array<float>& phi = work.grid.krylov.x;
    Array<float>& heat = fine.solution;
    parallel_for("electric.heat", 0, fine.group_capacity(), 2048, [&](std::int64_t b, std::int64_t e) {
        work.grid.kernels.heat(fine, work.sigma_S_per_m.data(), phi.data(), heat.data(), b, e);
    });
    double held = add_fixed_faces(work, phi, heat), present = 0.0;
    const Window& window = work.window;
    for (int c = window.begin.z; c < window.end.z; ++c)
        for (int b = window.begin.y; b < window.end.y; ++b) {
            const float* row = heat.data() + fine.index(0, b, c);
            std::int64_t hexel = model.hexels.index(window.to_hexel({window.begin.x, b, c}));
            for (int a = window.begin.x; a < window.end.x; ++a, ++hexel)
                (state.hexel_present.test(hexel) ? present : held) += static_cast<double>(row[a]);
        }
    const double spacing = model.hexels.spacing_m;
    tissue_W = spacing * present;
    elsewhere_W = spacing * held;
    work.conductance_S = tissue_W + elsewhere_W;
    work.electrode_conductance_S *= spacing;
}

void write_heat(const tissue::Model& model, const tissue::State& state, tissue::Exchange& exchange, Work& work,
                double voltage_V) {
    tissue::JouleHeat& joule = exchange.joule;
    if (joule.density_W_per_m3.size() < work.joule_W_per_m3.size()) joule.density_W_per_m3.swap(work.joule_W_per_m3);
    const Level& fine = work.grid.levels[0];
    const Window& window = work.window;
    joule.low = window.to_hexel(window.begin);
    joule.size = window.to_hexel(window.end) - joule.low;
    // Per volt squared and spacing -> W/m^3.
    const double spacing = model.hexels.spacing_m;
    const auto scale = static_cast<float>(voltage_V * voltage_V / (spacing * spacing));
    const std::int64_t box_y = joule.size.x, box_z = box_y * joule.size.y;
    const std::int64_t along = window.axis.x == 0 ? 1 : window.axis.x == 1 ? box_y : box_z;
    for (int c = window.begin.z; c < window.end.z; ++c)
        for (int b = window.begin.y; b < window.end.y; ++b) {
            const float* row = fine.solution.data() + fine.index(0, b, c);
            const Int3 first = window.to_hexel({window.begin.x, b, c}), in_box = first - joule.low;
            std::int64_t hexel = model.hexels.index(first);
            float* out = joule.density_W_per_m3.data() + in_box.x + box_y * in_box.y + box_z * in_box.z;
            for (int a = window.begin.x; a < window.end.x; ++a, ++hexel, out += along)
                *out = state.hexel_present.test(hexel) ? scale * row[a] : 0.0f;
        }
}

}  // namespace calot::electric

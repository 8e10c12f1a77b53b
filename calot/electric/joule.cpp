// Joule heat q = sigma |grad phi|^2 (Pan et al. 2019, Eq. 16) of the solved field, face by face.
//
// A face between cells 1 and 2 carries J = g (phi_1 - phi_2) through half a cell of sigma_1 and half a cell of sigma_2
// in series. Each half heats its own cell with J^2 / (2 sigma), so that both halves make g dphi^2 together and the sum
// over all cells is V I to the last digit. Char heats the hexel that the current enters, arcs that hexel and
// the wire (contact.h). All per volt squared and per spacing of hexels until the end.

#include <algorithm>
#include <cmath>

#include "calot/base/parallel.h"
#include "calot/electric/work.h"

namespace calot::electric {

namespace {

/// What is not in the tissue's hexels.
struct Elsewhere {
    double wire = 0.0, beyond = 0.0;  ///< in the metal; lost beyond the window
};

/// Faces that are not in the matrix: at the metal, and to the far return.
Elsewhere add_fixed_faces(Work& work, const Cells phi, float scale, Cells heat) {
    double current = 0.0;
    Elsewhere elsewhere;
    for (const Entry& entry : work.entries) {
        const auto cell = static_cast<std::size_t>(entry.cell);
        const float drop = 1.0f - scale * phi[cell], flow = entry.g * drop;
        const float wire = entry.wire * (flow * drop);
        heat[cell] += flow * drop - wire;
        elsewhere.wire += static_cast<double>(wire);
        current += static_cast<double>(flow);
    }
    constexpr std::size_t kAhead = 12;  // of most, each has lines of its own
    const std::size_t count = work.outer_faces.size();
    for (std::size_t k = 0; k < count; ++k) {
        const OuterFace& face = work.outer_faces[k];
        const auto cell = static_cast<std::size_t>(face.cell);
        const auto ahead = static_cast<std::size_t>(work.outer_faces[std::min(k + kAhead, count - 1)].cell);
        __builtin_prefetch(&phi[ahead]);
        __builtin_prefetch(&heat[ahead]);
        const float level = scale * phi[cell], all = face.g * level * level, inside = face.inside * all;
        heat[cell] += inside;
        elsewhere.beyond += static_cast<double>(all - inside);
    }
    work.electrode_conductance_S = current;
    return elsewhere;
}

/// Heat of present hexels into the state, and its sums.
void keep_hexels(const tissue::Model& model, tissue::State& state, Work& work, const Cells heat) {
    const Window& window = work.window;
    const Level& fine = work.grid.levels[0];
    const double s = model.hexels.spacing_m;
    work.sums.clear(model.materials.size());
    float* out = state.joule_S_per_m3.data();
    for (int c = 0; c < window.cells; ++c)
        for (int b = 0; b < window.cells; ++b, out += window.cells) {
            const bool on_lattice = c >= window.begin.z && c < window.end.z && b >= window.begin.y && b < window.end.y;
            const int begin = on_lattice ? window.begin.x : 0, end = on_lattice ? window.end.x : 0;
            std::fill(out, out + begin, 0.0f);
            std::fill(out + end, out + window.cells, 0.0f);
            if (!on_lattice) continue;
            const std::int64_t cell = fine.index(begin, b, c);
            work.grid.kernels.split(work.conductivity, heat.data() + cell, work.sigma_S_per_m.data() + cell,
                                    static_cast<float>(1.0 / (s * s)),
                                    model.hexels.index(window.to_hexel({begin, b, c})), end - begin, out + begin,
                                    work.sums);
        }
}

double total(const HeatSums::Places& places) {
    double sum = 0.0;
    for (const double place : places) sum += place;
    return sum;
}

}  // namespace

void spread_heat(Work& work) {
    Level& fine = work.grid.levels[0];
    const Cells phi = work.grid.krylov.x, heat = fine.solution;
    const auto factor = static_cast<float>(work.scale * work.scale);
    parallel_for("electric.heat", 0, static_cast<std::int64_t>(fine.groups.size()), kTaskGroups,
                 [&](std::int64_t b, std::int64_t e) {
                     work.grid.kernels.heat(fine, work.sigma_S_per_m.data(), phi.data(), factor, heat.data(), b, e);
                 });
}

void keep_heat(const tissue::Model& model, tissue::State& state, Work& work) {
    const Cells phi = work.grid.krylov.x, heat = work.grid.levels[0].solution;
    const Elsewhere elsewhere = add_fixed_faces(work, phi, static_cast<float>(work.scale), heat);
    keep_hexels(model, state, work, heat);

    const double s = model.hexels.spacing_m;
    state.field.tissue_S = 0.0;
    for (std::size_t m = 0; m < model.materials.size(); ++m) {
        const double heat_S = s * total(work.sums.kept[m]);
        state.field.tissue_S += heat_S;
        if (m >= tissue::kStrayMaterials) continue;
        state.stray_S[m] = heat_S;
        // Heat is q s^2, and q = J^2 / sigma.
        state.stray_density_S_per_m2[m] = std::sqrt(static_cast<double>(work.sums.greatest[m])) / s;
    }
    state.field.elsewhere_S = s * (elsewhere.beyond + total(work.sums.rest));
    state.field.wire_S = s * elsewhere.wire;
    work.conductance_S = state.field.conductance_S();
    work.electrode_conductance_S *= s;
}

}  // namespace calot::electric

// From the tissue to the matrix: conductivities, faces, electrode, outer faces.
//
//       electrode cell: phi = 1          gas: sigma = 0            outer face, distance r from the electrode:
//            | g = 2 s1 s2 / (s1 + s2)   no face, no current       half a cell of sigma, then Robin 1/r
//       ---[ e ]---[ cell ]---[ cell ]   [ gas ]                   g = sigma a / (1 + a/2), a = s n.r / r^2
//
// All g are in S/m: a conductance is g times the spacing s of hexels.

#include <algorithm>
#include <cmath>

#include "calot/base/parallel.h"
#include "calot/electric/work.h"

namespace calot::electric {

namespace {

void gather_conductivity(const tissue::Model& model, const tissue::State& state, Work& work) {
    const Window& window = work.window;
    const Level& fine = work.grid.levels[0];
    std::fill(work.sigma_S_per_m.begin(), work.sigma_S_per_m.end(), 0.0f);
    const std::uint8_t *present = state.hexel_present.bytes(), *held = model.hexel_held.bytes();
    parallel_for("electric.gather", window.begin.z, window.end.z, 4, [&](std::int64_t low, std::int64_t high) {
        for (int c = static_cast<int>(low); c < high; ++c)
            for (int b = window.begin.y; b < window.end.y; ++b)
                work.grid.kernels.gather(work.hexel_conductivity_S_per_m.data(), present, held,
                                         model.hexels.index(window.to_hexel({window.begin.x, b, c})),
                                         window.end.x - window.begin.x,
                                         work.sigma_S_per_m.data() + fine.index(window.begin.x, b, c));
    });
}

void make_faces(Work& work) {
    Level& fine = work.grid.levels[0];
    parallel_for("electric.faces", 0, fine.group_capacity(), 2048, [&](std::int64_t b, std::int64_t e) {
        work.grid.kernels.faces(fine, work.sigma_S_per_m.data(), b, e);
    });
    // The last cell of a row is followed by the next row, the last row by the next plane.
    for (int c = 0; c < fine.rows; ++c) {
        for (int b = 0; b < fine.rows; ++b)
            fine.g[0][static_cast<std::size_t>(fine.index(static_cast<int>(fine.row) - 1, b, c))] = 0.0f;
        const auto last = fine.g[1].begin() + fine.index(0, fine.rows - 1, c);
        std::fill(last, last + fine.row, 0.0f);
    }
}

/// Centre of the electrode in window coordinates.
Vec3 list_electrode(const tissue::Model& model, const tissue::Exchange& exchange, Work& work) {
    const Level& fine = work.grid.levels[0];
    for (const std::int32_t cell : work.electrode_cells) work.electrode.clear(cell);
    work.electrode_cells.clear();
    Vec3 centre(0.0);
    for (const tissue::NearHexel& near : exchange.near) {
        if (!touches(model.electric, near)) continue;
        const Int3 cell = work.window.from_hexel(model.hexels.coordinates(near.hexel));
        if (!work.window.contains(cell) || work.electrode_cells.size() == work.electrode_cells.capacity()) continue;
        const std::int64_t index = fine.index(cell.x, cell.y, cell.z);
        if (work.electrode.test(index) || !(work.sigma_S_per_m[static_cast<std::size_t>(index)] > 0.0f)) continue;
        work.electrode.set(index);
        work.electrode_cells.push_back(static_cast<std::int32_t>(index));
        centre += Vec3(cell);
    }
    if (!work.electrode_cells.empty()) centre /= static_cast<double>(work.electrode_cells.size());
    return centre;
}

/// Takes the electrode's cells out of the matrix: their faces become ground and right-hand side of their neighbours.
void fix_electrode(Work& work) {
    Level& fine = work.grid.levels[0];
    work.electrode_faces.clear();
    work.right.clear();
    const std::array<std::int64_t, 3> step{1, fine.row, fine.plane};
    for (const std::int32_t cell : work.electrode_cells)
        for (std::size_t axis = 0; axis < 3; ++axis)
            for (const std::int64_t direction : {-step[axis], step[axis]}) {
                const std::int64_t other = cell + direction;
                float& g = fine.g[axis][static_cast<std::size_t>(std::min<std::int64_t>(cell, other))];
                const float value = g;
                g = 0.0f;
                if (value == 0.0f || work.electrode.test(other)) continue;
                fine.ground[static_cast<std::size_t>(other)] += value;
                work.right.push_back({static_cast<std::int32_t>(other), value});
                work.electrode_faces.push_back({cell, static_cast<std::int32_t>(other), value});
            }
}

void list_outer_faces(Work& work, const Vec3& centre) {
    Level& fine = work.grid.levels[0];
    const Window& window = work.window;
    work.outer_faces.clear();
    for (int axis = 0; axis < 3; ++axis)
        for (const int side : {-1, 1}) {
            Int3 low = window.begin, high = window.end;
            if (low[axis] >= high[axis]) return;
            (side < 0 ? high[axis] : low[axis]) = side < 0 ? low[axis] + 1 : high[axis] - 1;
            for (int c = low.z; c < high.z; ++c)
                for (int b = low.y; b < high.y; ++b)
                    for (int a = low.x; a < high.x; ++a) {
                        const std::int64_t cell = fine.index(a, b, c);
                        const float sigma = work.sigma_S_per_m[static_cast<std::size_t>(cell)];
                        if (!(sigma > 0.0f)) continue;
                        Vec3 r = Vec3(a, b, c) - centre;
                        r[axis] += 0.5 * side;
                        const double falloff = std::max(0.0, side * r[axis]) / glm::dot(r, r);
                        const auto g = static_cast<float>(static_cast<double>(sigma) * falloff / (1.0 + 0.5 * falloff));
                        work.outer_faces.push_back({static_cast<std::int32_t>(cell), g});
                        if (!work.electrode.test(cell)) fine.ground[static_cast<std::size_t>(cell)] += g;
                    }
        }
}

}  // namespace

void assemble(const tissue::Model& model, const tissue::State& state, const tissue::Exchange& exchange, Work& work) {
    gather_conductivity(model, state, work);
    make_faces(work);
    const Cells ground = work.grid.levels[0].ground;
    std::fill(ground.begin(), ground.end(), 0.0f);
    const Vec3 centre = list_electrode(model, exchange, work);
    fix_electrode(work);
    list_outer_faces(work, centre);
}

}  // namespace calot::electric

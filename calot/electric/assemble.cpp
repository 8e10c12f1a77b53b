// From the tissue to the matrix: conductivities, faces, metal, outer faces.
//
//       metal: phi = 1                  gas: sigma = 0            outer face, distance r from where current enters:
//        ---+---  entry (contact.h)     no face, no current       half a cell of sigma, then Robin 1/r
//       [ cell ]---[ cell ]---[ cell ]  [ gas ]                   g = sigma a / (1 + a/2), a = s n.r / r^2
//                g = 2 s1 s2 / (s1 + s2)
//
// All g are in S/m: a conductance is g times the spacing s of hexels.

#include <algorithm>
#include <cmath>
#include <cstring>

#include "calot/base/parallel.h"
#include "calot/electric/conductivity.h"
#include "calot/electric/poles.h"
#include "calot/electric/work.h"

namespace calot::electric {

namespace {

/// Conductivities of the window, in cells that lie on the lattice; 0 in all others.
void gather_conductivity(const tissue::Model& model, Work& work) {
    const Window& window = work.window;
    const Level& fine = work.grid.levels[0];
    const Int3 size = window.end - window.begin;
    const bool whole = size.x == window.cells && size.y == window.cells && size.z == window.cells;
    // Rows are short and far apart: what one will want from memory is called for some rows ahead.
    constexpr int kAhead = 6;
    const auto call_for = [&](int b, int c) {
        if (b >= window.end.y) b -= size.y, ++c;
        if (c >= window.end.z) return;
        const std::int64_t first = model.hexels.index(window.to_hexel({window.begin.x, b, c}));
        for (std::int64_t k = 0; k < size.x + kGroup - 1; k += kGroup)
            for (const float* values : {work.conductivity.rest_S_per_m, work.conductivity.enthalpy_J_per_m3,
                                        work.conductivity.water_kg_per_m3})
                __builtin_prefetch(values + first + std::min<std::int64_t>(k, size.x - 1));
    };
    if (!whole) std::fill(work.sigma_S_per_m.begin(), work.sigma_S_per_m.end(), 0.0f);
    parallel_for("electric.gather", window.begin.z, window.end.z, fine.task_planes(), [&](std::int64_t low, std::int64_t high) {
        for (int c = static_cast<int>(low); c < high; ++c)
            for (int b = window.begin.y; b < window.end.y; ++b) {
                call_for(b + kAhead, c);
                work.grid.kernels.gather(work.conductivity, model.hexels.index(window.to_hexel({window.begin.x, b, c})),
                                         size.x, work.sigma_S_per_m.data() + fine.index(window.begin.x, b, c));
            }
    });
}

/// Lists the groups that hold conducting cells. What is skipped must read as zero: groups that hold none any more are
/// wiped.
void list_groups(Work& work) {
    Level& fine = work.grid.levels[0];
    Krylov& krylov = work.grid.krylov;
    fine.groups.resize(work.alive.size());
    const float* sigma = work.sigma_S_per_m.data();
    std::size_t count = 0;
    for (std::size_t n = 0; n < work.alive.size(); ++n) {
        const Level::Group group = fine.all[n];
        std::uint64_t any = 0;  // of the bits of conductivities, none of which is negative
        for (std::int64_t k = 0; k < kGroup; k += 2) {
            std::uint64_t two;
            std::memcpy(&two, sigma + group.at + k, sizeof(two));
            any |= two;
        }
        const std::uint8_t alive = any != 0 ? 1 : 0;
        fine.groups[count] = group;
        count += alive;
        if (alive == work.alive[n]) continue;
        work.alive[n] = alive;
        if (alive != 0) continue;
        for (auto* values : {&fine.g[0], &fine.g[1], &fine.g[2], &fine.ground, &fine.weight, &fine.right,
                             &fine.solution, &fine.scratch, &krylov.x, &krylov.p})
            std::fill_n(values->begin() + group.at, kGroup, 0.0f);
    }
    fine.groups.resize(count);
}

/// Arcs keep dried tissue conducting in a hexel at the metal and in those behind its faces.
void burn_through(const tissue::Model& model, std::int64_t hexel, const Int3& place, Work& work) {
    const Level& fine = work.grid.levels[0];
    const auto arc = static_cast<float>(model.electric.arc_conductivity_S_per_m);
    auto burn = [&](const Int3& cell, std::int64_t there) {
        if (!work.window.contains(cell)) return;
        float& sigma = work.sigma_S_per_m[static_cast<std::size_t>(fine.index(cell.x, cell.y, cell.z))];
        const float rest = work.hexel_conductivity_S_per_m[static_cast<std::size_t>(there)];
        if (sigma > 0.0f) sigma = std::max(sigma, std::min(rest, arc));
    };
    burn(place, hexel);
    for (int k = 0; k < 3; ++k)
        for (const int side : {-1, 1}) {
            Int3 cell = place;
            cell[k] += side;
            burn(cell, hexel + side * std::int64_t{model.hexels.stride[work.window.axis[k]]});
        }
}

/// Which hexels current enters: Work::entries without their g, electrode_cells, near_of_entry, centre.
void list_entries(const tissue::Model& model, const tissue::Exchange& exchange, const Reach& reach, Work& work) {
    const Level& fine = work.grid.levels[0];
    for (const std::int32_t cell : work.electrode_cells) work.entered.clear(cell);
    work.entries.clear();
    work.electrode_cells.clear();
    work.near_of_entry.clear();
    work.centre = Vec3(0.0);
    for (std::size_t n = 0; n < exchange.near.size(); ++n) {
        const tissue::NearHexel& near = exchange.near[n];
        if (!reaches(reach, near) || work.entries.size() == work.entries.capacity()) continue;
        const Int3 place = work.window.from_hexel(model.hexels.coordinates(near.hexel));
        if (!work.window.contains(place)) continue;
        const auto cell = static_cast<std::int32_t>(fine.index(place.x, place.y, place.z));
        if (work.entered.test(cell) || !(work.sigma_S_per_m[static_cast<std::size_t>(cell)] > 0.0f)) continue;
        if (reach.arcs) burn_through(model, near.hexel, place, work);
        work.entered.set(cell);
        work.electrode_cells.push_back(cell);
        work.near_of_entry.push_back(static_cast<std::int32_t>(n));
        work.entries.push_back({cell, 0.0f, 0.0f});
        work.centre += Vec3(place);
    }
    if (!work.entries.empty()) work.centre /= static_cast<double>(work.entries.size());
}

/// Faces of an entry that look at gas, towards where the metal is, and more for every side on which the metal ends
/// while the tissue's surface goes on: the current crowds there, as 1/sqrt of the distance from the edge.
double face_weight(const Work& work, std::int32_t cell, const Vec3f& outward) {
    const Level& fine = work.grid.levels[0];
    const std::array<std::int64_t, 3> step{1, fine.row, fine.plane};
    auto conducts = [&](std::int64_t at) { return work.sigma_S_per_m[static_cast<std::size_t>(at)] > 0.0f; };
    double faces = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (const int side : {-1, 1}) {
            const std::int64_t out = side * step[axis];
            if (conducts(cell + out) || static_cast<float>(side) * outward[static_cast<int>(axis)] < 0.0f) continue;
            faces += 1.0;
            for (std::size_t along = 0; along < 3; ++along)
                for (const std::int64_t beside : {cell - step[along], cell + step[along]})
                    if (along != axis && conducts(beside) && !conducts(beside + out) && !work.entered.test(beside))
                        faces += kEdge;
        }
    return std::clamp(faces, 1.0, 3.0 + 4.0 * kEdge);
}

/// g of every entry: char, arc and half a cell in series.
void connect_entries(const tissue::Model& model, const tissue::State& state, const tissue::Exchange& exchange,
                     Work& work) {
    const tissue::ElectricParameters& p = model.electric;
    const double s = model.hexels.spacing_m;
    const double char_m = state.tip.char_kg / (p.char_density_kg_per_m3 * p.bare_area_m2);
    work.arcs = 0;
    for (std::size_t n = 0; n < work.entries.size(); ++n) {
        Entry& entry = work.entries[n];
        const tissue::NearHexel& near = exchange.near[static_cast<std::size_t>(work.near_of_entry[n])];
        Vec3f outward(0.0f);
        for (int k = 0; k < 3; ++k) outward[k] = near.outward[work.window.axis[k]];
        const double faces = face_weight(work, entry.cell, outward);
        const double sigma = static_cast<double>(work.sigma_S_per_m[static_cast<std::size_t>(entry.cell)]);
        double inverse = 1.0 / (2.0 * sigma * faces) + char_m / (p.char_conductivity_S_per_m * s * faces);
        const double gap_m = static_cast<double>(near.bare_gap_m);
        double arc = 0.0;
        if (gap_m > p.contact_gap_m) {
            arc = s * (p.arc_resistance_Ohm + p.arc_resistance_Ohm_per_m * gap_m);
            inverse += arc;
            ++work.arcs;
        }
        entry.g = static_cast<float>(1.0 / inverse);
        entry.wire = static_cast<float>(p.arc_wire_share * arc / inverse);
    }
}

void make_faces(Work& work) {
    Level& fine = work.grid.levels[0];
    parallel_for(
        "electric.faces", 0, static_cast<std::int64_t>(fine.groups.size()), kTaskGroups,
        [&](std::int64_t b, std::int64_t e) { work.grid.kernels.faces(fine, work.sigma_S_per_m.data(), b, e); });
    // The last cell of a row is followed by the next row, the last row by the next plane.
    for (int c = 0; c < fine.rows; ++c) {
        for (int b = 0; b < fine.rows; ++b)
            fine.g[0][static_cast<std::size_t>(fine.index(static_cast<int>(fine.row) - 1, b, c))] = 0.0f;
        const auto last = fine.g[1].begin() + fine.index(0, fine.rows - 1, c);
        std::fill(last, last + fine.row, 0.0f);
    }
}

void list_outer_faces(const tissue::Model& model, Work& work) {
    Level& fine = work.grid.levels[0];
    const Window& window = work.window;
    const Poles poles = find_poles(model, work.window, work.centre);
    work.outer_faces.clear();
    for (int axis = 0; axis < 3; ++axis)
        for (const int side : {-1, 1}) {
            Int3 low = window.begin, high = window.end;
            if (low[axis] >= high[axis]) return;
            (side < 0 ? high[axis] : low[axis]) = side < 0 ? low[axis] + 1 : high[axis] - 1;
            for (int c = low.z; c < high.z; ++c)
                for (int b = low.y; b < high.y; ++b)
                    for (int a = low.x; a < high.x; ++a) {
                        const auto cell = static_cast<std::size_t>(fine.index(a, b, c));
                        const float sigma = work.sigma_S_per_m[cell];
                        if (!(sigma > 0.0f)) continue;
                        Vec3f face(static_cast<float>(a), static_cast<float>(b), static_cast<float>(c));
                        face[axis] += 0.5f * static_cast<float>(side);
                        const float share = poles.share(face, axis, static_cast<float>(side));
                        work.outer_faces.push_back({static_cast<std::int32_t>(cell), sigma * share, 0.5f * share});
                        fine.ground[cell] += sigma * share;
                    }
        }
}

}  // namespace

void gather(const tissue::Model& model, const tissue::State& state, const tissue::Exchange& exchange,
            const tissue::Input& input, Work& work) {
    const Reach reach = find_reach(model, state, exchange, input);
    work.window = place_window(model, exchange, reach, state.field_low);
    look_at(model, state, work.hexel_conductivity_S_per_m, work.conductivity);
    gather_conductivity(model, work);
    list_groups(work);
    list_entries(model, exchange, reach, work);
    connect_entries(model, state, exchange, work);
}

void assemble(const tissue::Model& model, Work& work) {
    make_faces(work);
    Level& fine = work.grid.levels[0];
    work.right.clear();
    for (const Entry& entry : work.entries) {
        fine.ground[static_cast<std::size_t>(entry.cell)] += entry.g;
        work.right.push_back({entry.cell, entry.g});
    }
    list_outer_faces(model, work);
    build_finest(work.grid);
}

}  // namespace calot::electric

#include "calot/deformation/rest.h"

#include <algorithm>
#include <cmath>

#include "calot/deformation/ghosts.h"
#include "calot/deformation/integrate.h"
#include "calot/deformation/kernel.h"
#include "calot/deformation/links.h"
#include "calot/deformation/neighbours.h"
#include "calot/deformation/stable_mass.h"

namespace calot::deformation {

using tissue::Material;
using tissue::Model;
using tissue::State;

namespace {

/// Sums over the hexels of one cell.
struct Content {
    int hexels = 0;
    double density = 0.0, mu = 0.0, lambda = 0.0;

    void add(const Material& material) {
        const double shear = material.youngs_modulus_Pa / (2.0 * (1.0 + material.poisson_ratio));
        ++hexels;
        density += material.density_kg_per_m3;
        mu += shear;
        lambda += 2.0 * shear * material.poisson_ratio / (1.0 - 2.0 * material.poisson_ratio);
    }
};

/// The surviving hexels of a phyxel's cell.
Content content_of(const Model& model, const Work& work, std::int64_t phyxel) {
    Content content;
    const std::uint64_t occupancy = work.occupancy[static_cast<std::size_t>(phyxel)];
    const int m = model.hexels_per_edge;
    const Int3 low = model.phyxels.coordinates(phyxel) * m;
    for (int z = 0, bit = 0; z < m; ++z)
        for (int y = 0; y < m; ++y)
            for (int x = 0; x < m; ++x, ++bit) {
                if (((occupancy >> bit) & 1u) == 0) continue;
                const std::int64_t hexel = model.hexels.index(low + Int3(x, y, z));
                content.add(model.materials[model.hexel_material[static_cast<std::size_t>(hexel)]]);
            }
    return content;
}

/// Eigenvalues of a symmetric matrix, smallest and largest (Smith 1961, trigonometric form).
std::array<double, 2> extreme_eigenvalues(const Mat3& a) {
    const double mean = (a[0][0] + a[1][1] + a[2][2]) / 3.0;
    const Mat3 deviator = a - Mat3(mean);
    double squares = 0.0;
    for (int c = 0; c < 3; ++c) squares += glm::dot(deviator[c], deviator[c]);
    const double radius = std::sqrt(squares / 6.0);
    if (radius <= 1e-14 * mean) return {mean, mean};
    const double half_det = 0.5 * glm::determinant(deviator / radius);
    const double angle = std::acos(std::clamp(half_det, -1.0, 1.0)) / 3.0;
    constexpr double kThirdOfTurn = 2.0943951023931953;
    return {mean + 2.0 * radius * std::cos(angle + kThirdOfTurn), mean + 2.0 * radius * std::cos(angle)};
}

/// Moment matrix A = sum w X_ij X_ij^T over live links, in units of s^2.
Mat3 moment(const Model& model, const State& state, std::int64_t phyxel) {
    Mat3 a(0.0);
    for_each_link(model.phyxels, state.links, phyxel, [&](std::int64_t, const Int3& step, double weight) {
        a += weight * glm::outerProduct(Vec3(step), Vec3(step));
    });
    return a;
}

/// Volume, mass and constants of a phyxel, volume not yet scaled.
void fill_from_hexels(const Model& model, const Work& work, std::int64_t phyxel, PhyxelRest& rest) {
    const Content content = content_of(model, work, phyxel);
    if (content.hexels == 0) return;
    const double hexel_m3 = model.hexel_volume_m3();
    rest.volume_m3 = content.hexels * hexel_m3;
    rest.mass_kg = content.density * hexel_m3;
    rest.mu_Pa = content.mu / content.hexels;
    rest.lambda_Pa = content.lambda / content.hexels;
    rest.fill = static_cast<double>(content.hexels) / model.hexels_per_phyxel();
    rest.moving_mass_kg = rest.mass_kg * std::max(1.0, model.deformation.mass_fraction_floor / rest.fill);
}

/// How much more hourglass control a phyxel gets at a free surface.
///
/// There its links lead inward alone: strain across the surface is that of a place half a cell deeper, and the phyxel
/// gives way to what this makes of its neighbours' stress. For stress that grows with depth, as it does below a free
/// surface, the force that is too much goes as fill^2 - fill/2 + 1/4, fill = share of the cell that is tissue. Only
/// hourglass control resists. The factor is chosen so that bars in bending and in torsion come within 3 % from 5 cells
/// across on, with their outer cells full and half full (docs/validation.md).
double surface_factor(double trace, double fill) {
    constexpr double kInside = 6.0 * kFaceWeight + 12.0 * 2.0 * kEdgeWeight, kSurface = 10.0;
    return 1.0 + kSurface * (1.0 - trace / kInside) * fill * fill;
}

}  // namespace

double initial_trace(const Model& model, std::int64_t phyxel) {
    double trace = 0.0;
    const bool real = model.phyxel_initial.test(phyxel);
    for (std::size_t d = 0; d < tissue::kLinkDirections.size(); ++d) {
        const std::int64_t offset = model.phyxels.offset(tissue::kLinkDirections[d]);
        // w |X|^2
        const double term = static_cast<int>(d) < tissue::kFaceDirections ? kFaceWeight : 2.0 * kEdgeWeight;
        for (const std::int64_t other : {phyxel + offset, phyxel - offset})
            if (model.phyxel_initial.test(other) || (real && model.phyxel_ghost.test(other))) trace += term;
    }
    return trace;
}

Array<float> volume_shares(const Model& model) {
    const int m = model.hexels_per_edge;
    const auto cells = static_cast<std::size_t>(model.phyxels.cells);
    std::vector<double> own(cells, 0.0), volume(cells, 0.0);
    for (std::int64_t p = model.phyxels.first; p < model.phyxels.last; ++p) {
        if (!model.phyxel_initial.test(p)) continue;
        const Int3 low = model.phyxels.coordinates(p) * m;
        Vec3 centroid(0.0);  // of its hexels, from the centre of the cell, in spacings
        double count = 0.0;
        for (int z = 0; z < m; ++z)
            for (int y = 0; y < m; ++y)
                for (int x = 0; x < m; ++x)
                    if (model.hexel_initial.test(model.hexels.index(low + Int3(x, y, z)))) {
                        centroid += (Vec3(x, y, z) + 0.5) / static_cast<double>(m) - 0.5;
                        count += 1.0;
                    }
        centroid /= count;
        own[static_cast<std::size_t>(p)] = count;
        for (int corner = 0; corner < 8; ++corner) {
            double weight = count;
            Int3 step(0);
            for (int axis = 0; axis < 3; ++axis) {
                const double away = std::abs(centroid[axis]);
                const bool beyond = (corner >> axis) & 1;
                weight *= beyond ? away : 1.0 - away;
                if (beyond) step[axis] = centroid[axis] < 0.0 ? -1 : 1;
            }
            const std::int64_t to = p + model.phyxels.offset(step);
            volume[static_cast<std::size_t>(model.phyxel_initial.test(to) ? to : p)] += weight;
        }
    }
    Array<float> share;
    share.assign(cells, 1.0f);
    for (std::size_t p = 0; p < cells; ++p)
        if (own[p] > 0.0) share[p] = static_cast<float>(volume[p] / own[p]);
    return share;
}

PhyxelRest phyxel_rest(const Model& model, const State& state, const Work& work, std::int64_t phyxel) {
    PhyxelRest rest;
    const bool ghost = model.phyxel_ghost.test(phyxel);
    if (!ghost && state.phyxel_present.test(phyxel)) fill_from_hexels(model, work, phyxel, rest);
    if (!ghost && rest.volume_m3 == 0.0) return rest;

    const Mat3 a = moment(model, state, phyxel);
    const auto [smallest, largest] = extreme_eigenvalues(a);
    // Nearly flat or lonely neighbourhoods: their gradient is ill-determined and blows up. They have no stress of their
    // own and are carried by what their neighbours see of them.
    if (!(smallest >= model.deformation.singular_ratio * largest) || largest <= 0.0) {
        rest.volume_m3 = 0.0;
        return rest;
    }
    const double trace = a[0][0] + a[1][1] + a[2][2];
    const double s2 = model.phyxels.spacing_m * model.phyxels.spacing_m;
    rest.moment_inverse_per_m2 = glm::inverse(a) / s2;
    if (ghost) return rest;
    rest.volume_m3 *= static_cast<double>(work.volume_share[static_cast<std::size_t>(phyxel)]) *
                      std::min(1.0, trace / initial_trace(model, phyxel));
    const double youngs = rest.mu_Pa * (3.0 * rest.lambda_Pa + 2.0 * rest.mu_Pa) / (rest.lambda_Pa + rest.mu_Pa);
    rest.hourglass_N_per_m =
        model.deformation.hourglass_alpha * surface_factor(trace, rest.fill) * youngs * rest.volume_m3 / (trace * s2);
    return rest;
}

namespace {

/// The live links as the kernels and the embedding want them.
void store_links(const Model& model, const State& state, Work& work, std::int64_t phyxel) {
    const auto cell = static_cast<std::size_t>(phyxel);
    Vec3 sum(0.0);
    std::uint32_t word = 0;
    for_each_link(model.phyxels, state.links, phyxel, [&](std::int64_t, const Int3& step, double weight) {
        sum += weight * Vec3(step);
        word |= 1u << neighbour_index(step);
    });
    work.link_word[cell] = word;
    for (std::size_t r = 0; r < 3; ++r) work.step_sum[r][cell] = static_cast<float>(sum[static_cast<int>(r)]);
    refresh_group(model, state, group_of(work, phyxel));
}

void store_moment(Work& work, std::int64_t phyxel, const PhyxelRest& rest) {
    const Mat3& inverse = rest.moment_inverse_per_m2;
    const std::array<double, 6> upper{inverse[0][0], inverse[1][0], inverse[2][0],
                                      inverse[1][1], inverse[2][1], inverse[2][2]};
    for (std::size_t k = 0; k < upper.size(); ++k)
        work.moment_inverse[k][static_cast<std::size_t>(phyxel)] = static_cast<float>(upper[k]);
}

/// Stores what depends on one cell alone, and on which phyxels a ghost mirrors.
void store_rest(const Model& model, const State& state, Work& work, std::int64_t phyxel) {
    const auto cell = static_cast<std::size_t>(phyxel);
    const PhyxelRest rest = phyxel_rest(model, state, work, phyxel);
    store_moment(work, phyxel, rest);
    work.volume_m3[cell] = static_cast<float>(rest.volume_m3);
    work.hourglass[cell] = static_cast<float>(rest.hourglass_N_per_m);
    work.lame_mu_Pa[cell] = static_cast<float>(rest.mu_Pa);
    work.lame_lambda_Pa[cell] = static_cast<float>(rest.lambda_Pa);
    work.weighing_mass_kg[cell] = static_cast<float>(rest.mass_kg);
    work.moving_mass_kg[cell] = static_cast<float>(rest.moving_mass_kg);
    store_links(model, state, work, phyxel);
    refresh_pull(model, state, work, phyxel);
    if (model.phyxel_ghost.test(phyxel)) refresh_mirror(model, state, work, phyxel);
    if (rest.moment_inverse_per_m2[0][0] == 0.0) {
        for (auto& component : work.gradient) component[cell] = 0.0f;
        for (auto& component : work.moment_stress) component[cell] = 0.0f;
        for (auto& component : work.own_force_N) component[cell] = 0.0f;
    }
}

/// Stores what makes a step stable, which depends on the neighbours as well.
void store_mass(const Model& model, const State& state, Work& work, std::int64_t phyxel) {
    const auto cell = static_cast<std::size_t>(phyxel);
    work.stable_mass_kg[cell] = static_cast<float>(stable_mass_kg(model, state, work, phyxel));
    set_mass(work, phyxel, work.raise[cell]);
}

template <class Visit>
void for_each_neighbour_cell(const Lattice& phyxels, std::int64_t phyxel, const Visit& visit) {
    for (const Int3& step : tissue::kLinkDirections)
        for (const std::int64_t offset : {phyxels.offset(step), -phyxels.offset(step)}) visit(phyxel + offset);
}

}  // namespace

namespace {

/// Cells, each once however often it is noted. Work::search_stack is free here, Work::changed clear.
struct Noted {
    Work& work;
    std::size_t count = 0;

    void note(std::int64_t cell) {
        if (work.changed.test(cell)) return;
        work.changed.set(cell);
        work.search_stack[count++] = cell;
    }
    template <class Visit>
    void for_each(const Visit& visit) const {
        for (std::size_t k = 0; k < count; ++k) {
            work.changed.clear(work.search_stack[k]);
            visit(work.search_stack[k]);
        }
    }
};

/// Calls visit(cell) for phyxels that changed and the ghosts beside them.
template <class Visit>
void for_each_with_ghosts(const Model& model, Work& work, std::span<const std::int64_t> phyxels, const Visit& visit) {
    Noted noted{work};
    for (const std::int64_t phyxel : phyxels) {
        noted.note(phyxel);
        for_each_neighbour_cell(model.phyxels, phyxel, [&](std::int64_t other) {
            if (model.phyxel_ghost.test(other)) noted.note(other);
        });
    }
    noted.for_each(visit);
}

}  // namespace

void refresh_phyxels(const Model& model, const State& state, Work& work, std::span<const std::int64_t> phyxels) {
    for_each_with_ghosts(model, work, phyxels, [&](std::int64_t cell) { store_rest(model, state, work, cell); });
    // Masses depend on the rest properties of neighbours.
    Noted noted{work};
    for (const std::int64_t phyxel : phyxels) {
        noted.note(phyxel);
        for_each_neighbour_cell(model.phyxels, phyxel, [&](std::int64_t other) {
            if (state.phyxel_present.test(other)) noted.note(other);
            if (!model.phyxel_ghost.test(other)) return;
            const Mirror& mirror = find_mirror(work, other);
            for (int k = 0; k < mirror.count; ++k) noted.note(mirror.phyxel[static_cast<std::size_t>(k)]);
        });
    }
    noted.for_each([&](std::int64_t cell) { store_mass(model, state, work, cell); });
}

void refresh_shapes(const Model& model, const State& state, Work& work, std::span<const std::int64_t> phyxels) {
    for_each_with_ghosts(model, work, phyxels, [&](std::int64_t cell) {
        store_moment(work, cell, phyxel_rest(model, state, work, cell));
        store_links(model, state, work, cell);
        if (model.phyxel_ghost.test(cell)) refresh_mirror(model, state, work, cell);
    });
}

void refresh_all_phyxels(const Model& model, const State& state, Work& work) {
    list_ghosts(model, work);
    for (std::int64_t p = model.phyxels.first; p < model.phyxels.last; ++p)
        if (state.phyxel_present.test(p) || model.phyxel_ghost.test(p)) store_rest(model, state, work, p);
    for (std::int64_t p = model.phyxels.first; p < model.phyxels.last; ++p)
        if (state.phyxel_present.test(p)) store_mass(model, state, work, p);
    reserve_images(model, state, work);
}

double added_mass_kg(const Work& work) {
    double total = 0.0;
    for (std::size_t i = 0; i < work.inverse_mass_per_kg.size(); ++i)
        if (work.inverse_mass_per_kg[i] > 0.0f)
            total += static_cast<double>((1.0f - work.gravity_share[i]) / work.inverse_mass_per_kg[i]);
    return total;
}

}  // namespace calot::deformation

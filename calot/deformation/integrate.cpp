#include "calot/deformation/integrate.h"

#include <algorithm>
#include <cmath>

#include "calot/base/parallel.h"
#include "calot/deformation/ghosts.h"
#include "calot/deformation/grasp.h"
#include "calot/deformation/kernel.h"
#include "calot/deformation/law.h"
#include "calot/deformation/links.h"
#include "calot/deformation/stable_mass.h"

namespace calot::deformation {

using tissue::Model;
using tissue::State;

namespace {

/// Groups of a parallel task: big enough that handing it out costs nothing (some 25 us of work), small enough that two
/// threads end together, and fixed, so that it never depends on threads.
constexpr std::int64_t kChunk = 128;
/// Up to so many groups are one task: a second thread would gain less than waiting for it may cost.
constexpr std::int64_t kOneTask = 512;

using Sweep = void (*)(const KernelView&, Groups);

void run(const char* name, Sweep sweep, const KernelView& view, Work& work) {
    const Groups groups(work.groups);
    const auto count = static_cast<std::int64_t>(groups.size());
    parallel_for(name, 0, count, count <= kOneTask ? kOneTask : kChunk, [&](std::int64_t low, std::int64_t high) {
        sweep(view, groups.subspan(static_cast<std::size_t>(low), static_cast<std::size_t>(high - low)));
    });
}

/// Gradients and motion of all groups. Chunks whose neighbours belong to another thread are moved when all gradients
/// are there.
void run_both(const KernelView& view, Work& work) {
    const Groups groups(work.groups);
    const auto count = static_cast<std::int64_t>(groups.size());
    const std::int64_t chunks = std::max<std::int64_t>(1, count / kOneTask), chunk = (count + chunks - 1) / chunks;
    if (chunks == 1) {  // what fits into the caches gains nothing by one pass
        sweep_gradients(view, groups);
        sweep_motion(view, groups);
        return;
    }
    auto range = [&](std::int64_t low) { return GroupRange{low, std::min(low + chunk, count)}; };
    parallel_for("deformation.both", 0, count, chunk, [&](std::int64_t low, std::int64_t) {
        const GroupRange gradients = range(low);
        sweep_both(view, groups, gradients, inner_groups(view, groups, gradients));
    });
    parallel_for("deformation.borders", 1, chunks, 1, [&](std::int64_t border, std::int64_t) {
        const std::int64_t low = inner_groups(view, groups, range((border - 1) * chunk)).end,
                           high = inner_groups(view, groups, range(border * chunk)).begin;
        sweep_motion(view, groups.subspan(static_cast<std::size_t>(low), static_cast<std::size_t>(high - low)));
    });
}

std::int64_t first_bad_cell(const Model& model, const State& state) {
    for (std::int64_t p = model.phyxels.first; p < model.phyxels.last; ++p) {
        const auto i = static_cast<std::size_t>(p);
        for (const auto& u : state.displacement_m)
            if (!std::isfinite(u[i])) return p;
    }
    return -1;
}

/// Where a displacement is no number, neither is the stretch of its phyxel and neighbours: Group::overstretched has
/// both.
bool all_finite(const State& state, const Work& work) {
    bool finite = true;
    for_each_strained(work, [&](const Group& group) {
        for (std::uint32_t rest = group.overstretched; rest != 0; rest &= rest - 1) {
            const auto i = static_cast<std::size_t>(group.first + __builtin_ctz(rest));
            for (const auto& u : state.displacement_m) finite &= std::isfinite(u[i]);
        }
    });
    return finite;
}

}  // namespace

std::vector<Group> make_groups(const Model& model, const State& state) {
    // Where rows begin alike within vectors, so do groups; else at the first cell that no earlier one holds.
    bool aligned = true;
    for (const int stride : {model.phyxels.stride.x, model.phyxels.stride.y, model.phyxels.stride.z})
        aligned &= stride == 1 || stride % kGroupCells == 0;
    std::vector<Group> groups;
    std::int64_t end = 0;
    for (std::int64_t p = model.phyxels.first; p < model.phyxels.last; ++p) {
        if (p < end || !(state.phyxel_present.test(p) || model.phyxel_ghost.test(p))) continue;
        const std::int64_t first = aligned ? p / kGroupCells * kGroupCells : p;
        groups.emplace_back().first = static_cast<std::int32_t>(first);
        refresh_group(model, state, groups.back());
        end = first + kGroupCells;
    }
    return groups;
}

void refresh_group(const Model& model, const State& state, Group& group) {
    auto bits = [](const BitArray& array, std::int64_t cell) { return static_cast<std::uint16_t>(array.bits32(cell)); };
    group.present = bits(state.phyxel_present, group.first);
    group.ghost = bits(model.phyxel_ghost, group.first);
    for (std::size_t d = 0; d < group.plus.size(); ++d) {
        group.plus[d] = bits(state.links[d], group.first);
        group.minus[d] = bits(state.links[d], group.first - model.phyxels.offset(tissue::kLinkDirections[d]));
    }
}

Group& group_of(Work& work, std::int64_t phyxel) {
    auto after = std::upper_bound(work.groups.begin(), work.groups.end(), phyxel,
                                  [](std::int64_t cell, const Group& group) { return cell < group.first; });
    return after == work.groups.begin() ? *after : *--after;
}

KernelView KernelView::make(const Model& model, State& state, Work& work) {
    KernelView view;
    for (std::size_t r = 0; r < 3; ++r) {
        view.displacement_m[r] = state.displacement_m[r].data();
        view.velocity_m_per_s[r] = state.velocity_m_per_s[r].data();
        view.gravity_step_m_per_s[r] =
            static_cast<float>(model.deformation.gravity_m_per_s2[static_cast<int>(r)]) * work.substep_s;
        view.own_force_N[r] = work.own_force_N[r].data();
        view.step_sum[r] = work.step_sum[r].data();
    }
    for (std::size_t e = 0; e < 9; ++e) {
        view.gradient[e] = work.gradient[e].data();
        view.moment_stress[e] = work.moment_stress[e].data();
        view.offset[e] = model.phyxels.offset(tissue::kLinkDirections[e]);
        view.reach = std::max(view.reach, std::abs(view.offset[e]));
    }
    for (std::size_t e = 0; e < 6; ++e) view.moment_inverse[e] = work.moment_inverse[e].data();
    view.stiffening = work.stiffening.data();
    view.strained = work.strained.data();
    view.fast = work.fast.data();
    view.first_group = work.groups.data();
    const double stretch = model.deformation.tear_stretch;
    // Uniaxial stretch of incompressible tissue: lambda along, 1 / sqrt(lambda) across.
    view.most_squared_stretch = static_cast<float>(stretch * stretch + 2.0 / stretch);
    view.volume_m3 = work.volume_m3.data();
    view.inverse_mass_per_kg = work.inverse_mass_per_kg.data();
    view.gravity_share = work.gravity_share.data();
    view.hourglass = work.hourglass.data();
    view.lame_mu_Pa = work.lame_mu_Pa.data();
    view.lame_lambda_Pa = work.lame_lambda_Pa.data();
    view.law = model.deformation.law;
    view.volume_stiffness_Pa = static_cast<float>(model.deformation.volume_stiffness_Pa);
    view.spacing_m = static_cast<float>(model.phyxels.spacing_m);
    view.substep_s = work.substep_s;
    view.decay = static_cast<float>(std::exp(-model.deformation.damping_per_s * static_cast<double>(work.substep_s)));
    return view;
}

void update_gradients(const Model& model, const State& state, Work& work) {
    // The view is of mutable arrays, but this sweep only reads the state.
    const KernelView view = KernelView::make(model, const_cast<State&>(state), work);
    run("deformation.gradients", sweep_gradients, view, work);
}

void update_gradients_about(const Model& model, const State& state, Work& work,
                            const std::vector<std::int64_t>& phyxels) {
    // Groups that hold one of the 27 cells about a phyxel: few, found and swept one by one.
    work.touched_groups.clear();
    for (const std::int64_t phyxel : phyxels)
        for (const std::int64_t offset : work.neighbour_offset) {
            Group* group = &group_of(work, phyxel + offset);
            if (phyxel + offset >= group->first + kGroupCells || group->touched) continue;
            group->touched = 1;
            work.touched_groups.push_back(static_cast<std::int32_t>(group - work.groups.data()));
        }
    const KernelView view = KernelView::make(model, const_cast<State&>(state), work);
    for (const std::int32_t g : work.touched_groups) {
        Group& group = work.groups[static_cast<std::size_t>(g)];
        group.touched = 0;
        sweep_gradients(view, Groups(&group, 1));
    }
}

void advance(const Model& model, State& state, tissue::Exchange& exchange, Work& work) {
    exchange.contact_force_N = exchange.grasper_contact_force_N = Vec3(0.0);
    raise_masses(model, state, work);
    prepare_contacts(model, state, exchange, work);
    const KernelView view = KernelView::make(model, state, work);
    KernelView within_tick = view;
    within_tick.embedding = false;
    refresh_images(work);
    for (int substep = 0; substep < work.substeps; ++substep) {
        if (substep == 0)
            run("deformation.motion", sweep_motion, view, work);
        else
            run_both(within_tick, work);
        return_ghost_impulses(state, work, view.decay);
        solve_contacts(model, state, work);
        move_ghosts(state, work);
    }
    run("deformation.gradients", sweep_gradients, view, work);
    exchange.contact_force_N = work.contact.impulse_Ns[0] / -model.tick_s;
    exchange.grasper_contact_force_N = work.contact.impulse_Ns[1] / -model.tick_s;
    slip_held(state, exchange, work.contact);
    remember_contacts(state, work);
}

void check(const Model& model, State& state, const Work& work) {
    if (state.status.ok && !all_finite(state, work))
        state.status = {false, "displacement_m", first_bad_cell(model, state), state.tick};
}

void integrate(const Model& model, State& state, tissue::Exchange& exchange, Work& work) {
    if (!state.status.ok) return;
    advance(model, state, exchange, work);
    check(model, state, work);
}

double elastic_energy_J(const Model& model, const State& state, const Work& work) {
    const Law<double> law{model.deformation.law, model.deformation.volume_stiffness_Pa};
    const Lattice& lattice = model.phyxels;
    auto displacement = [&](std::int64_t p) {
        const auto i = static_cast<std::size_t>(p);
        return Vec3(state.displacement_m[0][i], state.displacement_m[1][i], state.displacement_m[2][i]);
    };
    double total = 0.0;
    for (std::int64_t p = lattice.first; p < lattice.last; ++p) {
        const auto i = static_cast<std::size_t>(p);
        const double volume = static_cast<double>(work.volume_m3[i]);
        if (volume == 0.0) continue;
        Mat3 g;
        for (int r = 0; r < 3; ++r)
            for (int c = 0; c < 3; ++c)
                g[c][r] = static_cast<double>(work.gradient[static_cast<std::size_t>(3 * r + c)][i]);
        double misfit = 0.0;
        for_each_link(lattice, state.links, p, [&](std::int64_t other, const Int3& step, double weight) {
            const Vec3 d = displacement(other) - displacement(p) - g * (lattice.spacing_m * Vec3(step));
            misfit += weight * glm::dot(d, d);
        });
        total += volume * law.energy_J_per_m3(g, static_cast<double>(work.lame_mu_Pa[i]),
                                              static_cast<double>(work.lame_lambda_Pa[i])) +
                 0.5 * static_cast<double>(work.hourglass[i]) * misfit;
    }
    return total;
}

double kinetic_energy_J(const Model& model, const State& state, const Work& work) {
    double total = 0.0;
    for (std::int64_t p = model.phyxels.first; p < model.phyxels.last; ++p) {
        const auto i = static_cast<std::size_t>(p);
        if (work.inverse_mass_per_kg[i] == 0.0f) continue;
        const Vec3 v(state.velocity_m_per_s[0][i], state.velocity_m_per_s[1][i], state.velocity_m_per_s[2][i]);
        total += 0.5 * glm::dot(v, v) / static_cast<double>(work.inverse_mass_per_kg[i]);
    }
    return total;
}

}  // namespace calot::deformation

#include "calot/deformation/stable_mass.h"

#include <algorithm>

#include "calot/deformation/ghosts.h"
#include "calot/deformation/links.h"

namespace calot::deformation {

namespace {

Mat3 moment_inverse_per_m2(const Work& work, std::int64_t phyxel) {
    std::array<double, 6> a;
    for (std::size_t k = 0; k < a.size(); ++k)
        a[k] = static_cast<double>(work.moment_inverse[k][static_cast<std::size_t>(phyxel)]);
    return Mat3(a[0], a[1], a[2], a[1], a[3], a[4], a[2], a[4], a[5]);
}

}  // namespace

void find_initial_stiffness(const tissue::Model& model, Work& work) {
    for (std::int64_t hexel = model.hexels.first; hexel < model.hexels.last; ++hexel) {
        if (!model.hexel_initial.test(hexel)) continue;
        const tissue::Material& material = model.materials[model.hexel_material[static_cast<std::size_t>(hexel)]];
        const double nu = material.poisson_ratio;  // lambda + 2 mu = E (1 - nu) / ((1 + nu) (1 - 2 nu))
        const double modulus = material.youngs_modulus_Pa * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu));
        work.initial_stiffness_Nm[static_cast<std::size_t>(model.phyxel_of(model.hexels.coordinates(hexel)))] +=
            static_cast<float>(modulus * model.hexel_volume_m3());
    }
}

void refresh_pull(const tissue::Model& model, const tissue::State& state, Work& work, std::int64_t phyxel) {
    const auto i = static_cast<std::size_t>(phyxel);
    const Mat3 inverse = moment_inverse_per_m2(work, phyxel);
    Vec3 own(0.0);
    double lengths = 0.0;
    double support = 0.0;
    const double stiffness = static_cast<double>(work.initial_stiffness_Nm[i]);
    for_each_link(model.phyxels, state.links, phyxel, [&](std::int64_t other, const Int3& step, double weight) {
        const Vec3 g = inverse * (weight * model.phyxels.spacing_m * Vec3(step));
        own -= g;
        const double others = static_cast<double>(work.initial_stiffness_Nm[static_cast<std::size_t>(other)]);
        support += weight * (model.phyxel_ghost.test(other) ? 1.0 : std::min(1.0, others / stiffness));
        lengths += glm::length(g);
    });
    constexpr double kWhole = 6 * kFaceWeight + 12 * kEdgeWeight;
    const double share = 1.0 - kSupport * support / kWhole;
    const double modulus = static_cast<double>(work.lame_lambda_Pa[i] + 2.0f * work.lame_mu_Pa[i]);
    work.pull_N_per_m2[i] =
        static_cast<float>(share * static_cast<double>(work.volume_m3[i]) * modulus * (lengths + glm::length(own)));
}

namespace {

/// Sum of pull |g| over the links of a cell: what its neighbours' stresses pull at it [N/m].
double neighbours_row(const tissue::Model& model, const tissue::State& state, const Work& work, std::int64_t phyxel) {
    double row = 0.0;
    for_each_link(model.phyxels, state.links, phyxel, [&](std::int64_t other, const Int3& step, double weight) {
        const Vec3 g = moment_inverse_per_m2(work, other) * (weight * model.phyxels.spacing_m * Vec3(step));
        row += static_cast<double>(work.pull_N_per_m2[static_cast<std::size_t>(other)]) * glm::length(g);
    });
    return row;
}

/// What is pulled at the ghosts that mirror a phyxel comes back to it.
double ghosts_row(const tissue::Model& model, const tissue::State& state, const Work& work, std::int64_t phyxel) {
    double row = 0.0;
    for_each_link(model.phyxels, state.links, phyxel, [&](std::int64_t other, const Int3&, double) {
        if (!model.phyxel_ghost.test(other)) return;
        const Mirror& mirror = find_mirror(work, other);
        for (int k = 0; k < mirror.count; ++k)
            if (mirror.phyxel[static_cast<std::size_t>(k)] == phyxel)
                row += neighbours_row(model, state, work, other) / mirror.count;
    });
    return row;
}

}  // namespace

void set_mass(Work& work, std::int64_t phyxel, float raise) {
    const auto i = static_cast<std::size_t>(phyxel);
    const float weighing = work.weighing_mass_kg[i];
    const float moving = std::max(work.moving_mass_kg[i], raise * work.stable_mass_kg[i]);
    work.inverse_mass_per_kg[i] = weighing > 0.0f ? 1.0f / moving : 0.0f;
    work.gravity_share[i] = weighing > 0.0f ? weighing / moving : 0.0f;
}

void raise_masses(const tissue::Model& model, const tissue::State& state, Work& work) {
    for (const std::int32_t cell : work.raised) {
        work.raise[static_cast<std::size_t>(cell)] = 1.0f;
        set_mass(work, cell, 1.0f);
    }
    work.raised.clear();
    auto raise = [&](std::int64_t cell, float factor) {
        float& most = work.raise[static_cast<std::size_t>(cell)];
        if (!(factor > most)) return;
        if (most == 1.0f) work.raised.push_back(static_cast<std::int32_t>(cell));
        most = factor;
    };
    for_each_strained(work, [&](const Group& group) {
        for (std::uint32_t rest = group.stiffened & group.present; rest != 0; rest &= rest - 1) {
            const std::int64_t phyxel = group.first + __builtin_ctz(rest);
            const float factor = 1.0f + work.stiffening[static_cast<std::size_t>(phyxel)];
            raise(phyxel, factor);
            for_each_link(model.phyxels, state.links, phyxel, [&](std::int64_t other, const Int3&, double) {
                if (state.phyxel_present.test(other)) raise(other, factor);
            });
        }
    });
    for (const std::int32_t cell : work.raised) set_mass(work, cell, work.raise[static_cast<std::size_t>(cell)]);
}

double stable_mass_kg(const tissue::Model& model, const tissue::State& state, const Work& work, std::int64_t phyxel) {
    auto hourglass = [&](std::int64_t p) { return static_cast<double>(work.hourglass[static_cast<std::size_t>(p)]); };
    const Mat3 inverse = moment_inverse_per_m2(work, phyxel);
    Vec3 own(0.0);
    double row = neighbours_row(model, state, work, phyxel) + ghosts_row(model, state, work, phyxel);  // D [N/m]
    for_each_link(model.phyxels, state.links, phyxel, [&](std::int64_t other, const Int3& step, double weight) {
        own -= inverse * (weight * model.phyxels.spacing_m * Vec3(step));
        row += 2.0 * weight * (hourglass(phyxel) + hourglass(other));
    });
    row += static_cast<double>(work.pull_N_per_m2[static_cast<std::size_t>(phyxel)]) * glm::length(own);
    const double dt = static_cast<double>(work.substep_s);
    return row * dt * dt / kRowSum;
}

}  // namespace calot::deformation

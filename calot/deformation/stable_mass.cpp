#include "calot/deformation/stable_mass.h"

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

void refresh_pull(const tissue::Model& model, const tissue::State& state, Work& work, std::int64_t phyxel) {
    const auto i = static_cast<std::size_t>(phyxel);
    const Mat3 inverse = moment_inverse_per_m2(work, phyxel);
    Vec3 own(0.0);
    double lengths = 0.0;
    for_each_link(model.phyxels, state.links, phyxel, [&](std::int64_t, const Int3& step, double weight) {
        const Vec3 g = inverse * (weight * model.phyxels.spacing_m * Vec3(step));
        own -= g;
        lengths += glm::length(g);
    });
    const double modulus = static_cast<double>(work.lame_lambda_Pa[i] + 2.0f * work.lame_mu_Pa[i]);
    work.pull_N_per_m2[i] =
        static_cast<float>(static_cast<double>(work.volume_m3[i]) * modulus * (lengths + glm::length(own)));
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

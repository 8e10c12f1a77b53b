#pragma once
// Bodies for checks of elasticity: blocks, blocks with random holes and cuts, random displacements.

#include <cmath>

#include "calot/anatomy/block.h"
#include "calot/base/random.h"
#include "calot/deformation/ghosts.h"
#include "calot/deformation/integrate.h"
#include "calot/deformation/reference.h"
#include "calot/tissue/sampling.h"

namespace calot::deformation::rig {

inline constexpr double kSpacing_m = 2.4e-3;  ///< of phyxels, 4 hexels of 0.6 mm

/// A body and everything that moves it.
struct Body {
    tissue::Model model;
    tissue::State state;
    Work work;
    tissue::Exchange exchange;

    explicit Body(tissue::Model given) : model(std::move(given)), state(tissue::State::make(model)) {
        work = make_work(model, state);
    }
    /// After hexels or links were changed by hand.
    void refresh() { work = make_work(model, state); }
    void tick() {
        integrate(model, state, exchange, work);
        ++state.tick;
    }
    Vec3 displacement_m(std::int64_t p) const { return at(state.displacement_m, p); }
    Vec3 velocity_m_per_s(std::int64_t p) const { return at(state.velocity_m_per_s, p); }
    double mass_kg(std::int64_t p) const {
        const float inverse = work.inverse_mass_per_kg[static_cast<std::size_t>(p)];
        return inverse > 0.0f ? 1.0 / static_cast<double>(inverse) : 0.0;
    }
    Mat3 gradient(std::int64_t p) const {
        Mat3 g;
        for (int r = 0; r < 3; ++r)
            for (int c = 0; c < 3; ++c)
                g[c][r] = static_cast<double>(
                    work.gradient[static_cast<std::size_t>(3 * r + c)][static_cast<std::size_t>(p)]);
        return g;
    }
    void set_displacement(std::int64_t p, const Vec3& u) {
        for (int r = 0; r < 3; ++r)
            state.displacement_m[static_cast<std::size_t>(r)][static_cast<std::size_t>(p)] = static_cast<float>(u[r]);
    }
    void set_velocity(std::int64_t p, const Vec3& v) {
        for (int r = 0; r < 3; ++r)
            state.velocity_m_per_s[static_cast<std::size_t>(r)][static_cast<std::size_t>(p)] = static_cast<float>(v[r]);
    }
    template <class Visit>
    void for_each_phyxel(const Visit& visit) const {
        for (std::int64_t p = model.phyxels.first; p < model.phyxels.last; ++p)
            if (state.phyxel_present.test(p)) visit(p);
    }

  private:
    static Vec3 at(const std::array<Array<float>, 3>& field, std::int64_t p) {
        const auto i = static_cast<std::size_t>(p);
        return Vec3(field[0][i], field[1][i], field[2][i]);
    }
};

/// A block of nx x ny x nz phyxels of fat.
inline tissue::Model block(const Int3& phyxels, bool held, int hexels_per_edge = 4) {
    const double hexel = kSpacing_m / hexels_per_edge;
    return tissue::sample(anatomy::make_block({.size_m = kSpacing_m * Vec3(phyxels), .held_below = held}),
                          {.hexel_spacing_m = hexel, .hexels_per_edge = hexels_per_edge});
}

/// Takes away a share of the hexels and, on top, a share of the links.
inline void wound(Body& body, double hexel_share, double link_share, std::uint64_t seed) {
    Random random(seed);
    for (std::int64_t h = body.model.hexels.first; h < body.model.hexels.last; ++h)
        if (body.state.hexel_present.test(h) && random.uniform() < hexel_share) body.state.hexel_present.clear(h);
    for (auto& links : body.state.links)
        for (std::int64_t p = body.model.phyxels.first; p < body.model.phyxels.last; ++p)
            if (links.test(p) && random.uniform() < link_share) links.clear(p);
    body.refresh();
}

/// Random displacements up to `amplitude` spacings along each axis, about a rotation by `angle_rad` about (1, 2, 3).
inline void shake(Body& body, double amplitude, double angle_rad, std::uint64_t seed) {
    Random random(seed);
    const Mat3 turn = glm::mat3_cast(glm::angleAxis(angle_rad, glm::normalize(Vec3(1, 2, 3))));
    body.for_each_phyxel([&](std::int64_t p) {
        const Vec3 x = body.model.phyxels.centre_m(p);
        const Vec3 noise(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
        body.set_displacement(p, turn * x - x + amplitude * kSpacing_m * noise);
    });
    refresh_images(body.work);
    move_ghosts(body.state, body.work);
    update_gradients(body.model, body.state, body.work);
}

}  // namespace calot::deformation::rig

// Burning while the body moves: whatever shape is left, motion stays finite and dies away.
#include <gtest/gtest.h>

#include "calot/validation/elastic_rig.h"
#include "calot/deformation/topology.h"

namespace calot::deformation {

namespace {

using rig::Body;

/// Shaken, left alone: the energy must fall far below what it was.
void expect_calm(const Int3& size) {
    Body body(rig::block(size, true));
    rig::shake(body, 0.01, 0.0, 1);
    const double before_J = elastic_energy_J(body.model, body.state, body.work);
    for (int k = 0; k < 200; ++k) body.tick();
    ASSERT_TRUE(body.state.status.ok) << size.x << " x " << size.y << " x " << size.z;
    EXPECT_LT(elastic_energy_J(body.model, body.state, body.work), 1e-3 * before_J);
}

}  // namespace

TEST(Soak, SlenderHeldBlocksAreStable) {
    for (const Int3& size : {Int3(1, 1, 3), Int3(2, 1, 4), Int3(2, 2, 2), Int3(2, 2, 5), Int3(3, 2, 5), Int3(3, 3, 5)})
        expect_calm(size);
}

// Holes everywhere, gravity five times ours in a changing direction: thin bridges, lone phyxels, falling crumbs.
TEST(Soak, BurningInMotionStaysFinite) {
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        Body body(rig::block({6, 5, 4}, true));
        sever_initial_links(body.model, body.state);
        body.refresh();
        tissue::reserve_exchange(body.model, body.exchange);
        Random random(seed);
        for (int tick = 0; tick < 400; ++tick) {
            const double angle = 0.05 * tick;
            body.model.deformation.gravity_m_per_s2 =
                50.0 * Vec3(std::cos(angle), std::sin(angle), std::sin(0.3 * angle));
            body.exchange.removed_hexels.clear();
            const Vec3 centre =
                Vec3(body.model.hexels.size) * Vec3(random.uniform(), random.uniform(), random.uniform());
            for (std::int64_t h = body.model.hexels.first; h < body.model.hexels.last; ++h) {
                if (!body.state.hexel_present.test(h)) continue;
                const bool hit = glm::length(Vec3(body.model.hexels.coordinates(h)) - centre) < 1.5;
                if (!hit && random.uniform() > 0.002) continue;
                body.state.hexel_present.clear(h);
                body.exchange.removed_hexels.push_back(h);
            }
            sever_burnt_links(body.model, body.state, body.exchange, body.work);
            body.tick();
            ASSERT_TRUE(body.state.status.ok) << "seed " << seed << ", tick " << tick;
            body.for_each_phyxel([&](std::int64_t p) {  // faster than any wave means an unstable step
                ASSERT_LT(glm::length(body.velocity_m_per_s(p)), 5.0) << "seed " << seed << ", tick " << tick;
            });
        }
        EXPECT_LT(body.state.hexel_present.count(), body.model.hexel_initial.count() / 2);
        EXPECT_GT(body.state.hexel_present.count(), 0);
    }
}

}  // namespace calot::deformation

// Contact inside a substep: momentum, the spring it comes to in rest, friction, and the transpose of the embedding.

#include <gtest/gtest.h>

#include "calot/deformation/embedding.h"
#include "calot/validation/elastic_rig.h"

namespace calot::deformation::rig {

namespace {

/// Makes a contact at a hexel, which is where the embedding says.
void touch(Body& body, std::int64_t hexel, const Vec3& normal, double gap_m, const Vec3& tool_velocity) {
    tissue::NearHexel near;
    near.hexel = hexel;
    near.rest_m = Vec3f(body.model.hexels.centre_m(hexel));
    embed_points(body.model, body.state, body.work, {&near.rest_m, 1}, {&near.hexel, 1}, {&near.world_m, 1});
    body.exchange.near.push_back(near);
    body.exchange.contacts.push_back({static_cast<std::int32_t>(body.exchange.near.size() - 1),
                                      Vec3f(glm::normalize(normal)), static_cast<float>(gap_m), Vec3f(tool_velocity)});
}

void clear(Body& body) {
    body.exchange.near.clear();
    body.exchange.contacts.clear();
}

/// Surface hexels of the top of a block, every `stride`-th.
std::vector<std::int64_t> top_hexels(const Body& body, int stride) {
    std::vector<std::int64_t> found;
    const Int3 size = body.model.hexels.size;
    for (int y = 0; y < size.y; y += stride)
        for (int x = 0; x < size.x; x += stride)
            for (int z = size.z - 1; z >= 0; --z) {
                const std::int64_t h = body.model.hexels.index(x, y, z);
                if (!body.state.hexel_present.test(h)) continue;
                found.push_back(h);
                break;
            }
    return found;
}

struct Momentum {
    Vec3 linear{0.0}, angular{0.0};
};
Momentum momentum(const Body& body) {
    Momentum sum;
    body.for_each_phyxel([&](std::int64_t p) {
        const Vec3 mv = body.mass_kg(p) * body.velocity_m_per_s(p);
        sum.linear += mv;
        sum.angular += glm::cross(body.model.phyxels.centre_m(p) + body.displacement_m(p), mv);
    });
    return sum;
}

}  // namespace

// psi, the points' shares of phyxels, gives what embed_points gives.
TEST(Contact, PointsMoveWithTheEmbedding) {
    Body body(block({4, 4, 3}, true));
    wound(body, 0.2, 0.1, 9);
    shake(body, 0.05, 0.02, 2);
    for (const std::int64_t hexel : top_hexels(body, 3)) touch(body, hexel, Vec3(0, 0, 1), 0.0, Vec3(0));
    prepare_contacts(body.model, body.state, body.exchange, body.work);
    const ContactWork& contact = body.work.contact;
    ASSERT_LE(contact.points.size(), static_cast<std::size_t>(kMaxContactPoints));
    for (std::size_t c = 0; c < contact.points.size(); ++c) {
        const tissue::NearHexel& near = body.exchange.near[static_cast<std::size_t>(contact.points[c].near)];
        Vec3 u(0.0);
        double total = 0.0;
        for (std::size_t row = 0; row < contact.phyxel.size(); ++row) {
            const auto share = static_cast<double>(contact.psi[c * static_cast<std::size_t>(contact.stride) + row]);
            u += share * body.displacement_m(contact.phyxel[row]);
            total += std::abs(share);
        }
        // Rounding of floats of the size of a displacement, 0.05 spacings.
        EXPECT_LT(glm::length(u - Vec3(near.world_m - near.rest_m)), 1e-5 * kSpacing_m);
        EXPECT_LT(total, 5.0);
    }
}

// On a free, deformed, severed body: what the tissue gains is what the instrument loses, about any axis.
TEST(Contact, MomentumBalances) {
    tissue::Model model = block({4, 4, 3}, false);
    model.deformation.damping_per_s = 0.0;
    model.deformation.substeps = 1;
    model.tick_s /= 3.0;
    Body body(std::move(model));
    wound(body, 0.1, 0.1, 4);
    shake(body, 0.03, 0.6, 5);
    for (int k = 0; k < 30; ++k) body.tick();
    for (const std::int64_t hexel : top_hexels(body, 4))
        touch(body, hexel, Vec3(0.2, 0.1, -1), -2e-4, Vec3(0.1, 0, -0.2));
    const Momentum before = momentum(body);
    body.tick();
    const Momentum after = momentum(body);
    Vec3 linear(0.0), angular(0.0);
    for (std::size_t c = 0; c < body.work.contact.points.size(); ++c) {
        const ContactPoint& point = body.work.contact.points[c];
        const Vec3 impulse(point.impulse_Ns);
        linear += impulse;
        angular += glm::cross(Vec3(body.exchange.near[static_cast<std::size_t>(point.near)].world_m), impulse);
    }
    ASSERT_GT(glm::length(linear), 1e-6);
    // Floats of velocities and shares; the arm is the size of the body, some 10 mm.
    EXPECT_LT(glm::length(after.linear - before.linear - linear), 1e-5 * glm::length(linear));
    EXPECT_LT(glm::length(after.angular - before.angular - angular), 1e-5 * 0.01 * glm::length(linear));
    EXPECT_LT(glm::length(body.exchange.contact_force_N * body.model.tick_s + linear), 1e-6 * glm::length(linear));
}

// In rest a contact is the spring that its stiffness says, and the held face feels its force.
TEST(Contact, ComesToRestAsASpring) {
    tissue::Model model = block({5, 5, 4}, true);
    model.contact.friction = 0.0;
    Body body(std::move(model));
    const double plane_m = body.model.hexels.centre_m(top_hexels(body, 1).front()).z - 5e-4;
    for (int k = 0; k < 400; ++k) {
        clear(body);
        for (const std::int64_t hexel : top_hexels(body, 4)) {
            touch(body, hexel, Vec3(0, 0, -1), 0.0, Vec3(0));
            tissue::Contact& contact = body.exchange.contacts.back();
            contact.gap_m = static_cast<float>(plane_m - static_cast<double>(body.exchange.near.back().world_m.z));
        }
        body.tick();
    }
    double expected_N = 0.0;
    for (const tissue::Contact& contact : body.exchange.contacts)
        expected_N += body.model.contact.stiffness_N_per_m * std::max(0.0, -static_cast<double>(contact.gap_m));
    EXPECT_GT(body.exchange.contact_force_N.z, 0.01);
    EXPECT_NEAR(body.exchange.contact_force_N.z, expected_N, 1e-3 * expected_N);
    EXPECT_LT(std::abs(body.exchange.contact_force_N.x), 1e-3 * expected_N);
}

TEST(Contact, NeverPullsAndFrictionStaysInItsCone) {
    for (const double friction : {0.0, 0.15, 1.0}) {
        tissue::Model model = block({5, 5, 4}, true);
        model.contact.friction = friction;
        Body body(std::move(model));
        for (int k = 0; k < 20; ++k) {
            clear(body);
            for (const std::int64_t hexel : top_hexels(body, 3))
                touch(body, hexel, Vec3(0, 0, -1), -1e-4, Vec3(0.05, 0.02, 0));
            body.tick();
            for (const ContactPoint& point : body.work.contact.points) {
                const Vec3 impulse(point.impulse_Ns), along(point.normal);
                const double normal = glm::dot(impulse, along), tangential = glm::length(impulse - normal * along);
                EXPECT_GE(normal, 0.0);
                EXPECT_LE(tangential, friction * normal + 1e-6 * glm::length(impulse));
            }
        }
        // Drags the tissue along: the tool feels it the other way.
        const Vec3 force = body.exchange.contact_force_N;
        EXPECT_GT(force.z, 0.0);
        if (friction > 0.0) {
            EXPECT_LT(force.x, -1e-3 * force.z);
        }
        clear(body);
        for (const std::int64_t hexel : top_hexels(body, 3)) touch(body, hexel, Vec3(0, 0, -1), 1e-2, Vec3(0));
        body.tick();
        EXPECT_EQ(body.exchange.contact_force_N, Vec3(0.0));
    }
}

// Contacts a thousand times stiffer than explicit springs could be, on the lightest phyxels there are.
TEST(Contact, IsStableHoweverStiff) {
    tissue::Model model = block({4, 4, 3}, true);
    model.contact.stiffness_N_per_m = 1e5;
    Body body(std::move(model));
    wound(body, 0.6, 0.1, 8);
    for (int k = 0; k < 300; ++k) {
        clear(body);
        for (const std::int64_t hexel : top_hexels(body, 2)) {
            if (!body.state.hexel_present.test(hexel)) continue;
            touch(body, hexel, Vec3(0.3, 0, -1), 0.0, Vec3(0));
            body.exchange.contacts.back().gap_m = -2e-4f - body.exchange.near.back().world_m.z;
        }
        body.tick();
        ASSERT_TRUE(body.state.status.ok);
    }
    body.for_each_phyxel([&](std::int64_t p) { EXPECT_LT(glm::length(body.velocity_m_per_s(p)), 0.05); });
}

}  // namespace calot::deformation::rig

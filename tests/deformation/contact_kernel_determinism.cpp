// Contact's dense lines: every instruction set against the plain reference, bit for bit, on random points.

#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include "calot/base/random.h"
#include "calot/deformation/contact_kernel.h"
#include "calot/validation/elastic_rig.h"

namespace calot::deformation::rig {

namespace {

/// Random points, ranges and shares over `rows` phyxels; some of the points held.
ContactWork random_points(std::size_t points, std::int32_t rows, std::uint64_t seed) {
    static const tissue::Model model = block({12, 12, 6}, false);
    ContactWork contact = make_contact_work(model);
    Random random(seed);
    auto value = [&](double size) { return static_cast<float>(random.uniform(-size, size)); };
    auto vector = [&](double size) { return Vec3f(value(size), value(size), value(size)); };
    contact.stride = (rows + kContactLanes - 1) / kContactLanes * kContactLanes;
    for (std::int32_t row = 0; row < rows; ++row) {
        contact.phyxel.push_back(row);
        contact.inverse_mass_per_kg[static_cast<std::size_t>(row)] = 1e5f + 5e4f * value(1.0);
        for (auto& velocity : contact.row_velocity_m_per_s) velocity[static_cast<std::size_t>(row)] = value(0.1);
    }
    for (std::size_t c = 0; c < points; ++c) {
        ContactPoint point;
        const std::int32_t blocks = contact.stride / kContactLanes;
        const auto first = static_cast<std::int32_t>(random.uniform() * blocks);
        const auto length = 1 + static_cast<std::int32_t>(random.uniform() * (blocks - first));
        point.first = first * kContactLanes;
        point.end = std::min(contact.stride, (first + length) * kContactLanes);
        for (std::int32_t row = point.first; row < std::min(point.end, rows); ++row)
            contact.psi[c * static_cast<std::size_t>(contact.stride) + static_cast<std::size_t>(row)] = value(0.1);
        if (c % 3 != 0) point.normal = glm::normalize(vector(1.0) + Vec3f(0.0f, 0.0f, 2.0f));
        point.tool_velocity_m_per_s = vector(0.1);
        point.stiffness_N_per_m = 600.0f;
        point.gap_m = value(1e-3);
        point.away_m = vector(1e-3);
        point.most_force_N = 0.25f;
        point.impulse_Ns = point.held() ? vector(1e-5) : 1e-5f * point.normal;
        contact.points.push_back(point);
    }
    return contact;
}

std::vector<float> outcome(ContactWork contact, bool plain) {
    if (plain) {
        reference::couple_points(contact);
        reference::gather_point_velocities(contact);
        reference::push_all_points(contact);
        reference::sweep_points(contact, 5, 0.15f, 3e-4f);
        reference::spread_impulses(contact);
    } else {
        couple_points(contact);
        gather_point_velocities(contact);
        push_all_points(contact);
        sweep_points(contact, 5, 0.15f, 3e-4f);
        spread_impulses(contact);
    }
    std::vector<float> all;
    const std::size_t count = contact.points.size();
    for (std::size_t c = 0; c < count; ++c) {
        for (std::size_t d = 0; d < count; ++d) all.push_back(contact.coupling_per_kg[c * kMaxPoints + d]);
        for (int r = 0; r < 3; ++r) {
            all.push_back(contact.points[c].impulse_Ns[r]);
            all.push_back(contact.velocity_m_per_s[static_cast<std::size_t>(r)][c]);
        }
    }
    for (const auto& impulse : contact.row_impulse_Ns)
        all.insert(all.end(), impulse.begin(), impulse.begin() + contact.stride);
    return all;
}

}  // namespace

TEST(ContactKernel, GivesTheBytesOfTheReferenceOnEveryInstructionSet) {
    const std::vector<std::pair<std::size_t, std::int32_t>> sizes{{1, 7}, {5, 40}, {32, 300}, {48, 333}};
    for (const auto& [points, rows] : sizes) {
        const ContactWork start = random_points(points, rows, points);
        const std::vector<float> expected = outcome(start, true);
        for (const float value : expected) ASSERT_TRUE(std::isfinite(value));
        for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
            hwy::SetSupportedTargetsForTest(target);
            EXPECT_EQ(outcome(start, false), expected) << hwy::TargetName(target) << ", " << points << " points";
        }
        hwy::SetSupportedTargetsForTest(0);
    }
}

// More contacts than are solved: the chosen ones stand for all, phyxel by phyxel.
TEST(ContactChoice, KeepsTheDeepestOfEveryPhyxelAndTheSumOfStiffness) {
    Body body(block({5, 5, 4}, true));
    const Int3 size = body.model.hexels.size;
    double all = 0.0;
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
            int z = size.z - 1;
            while (z >= 0 && !body.state.hexel_present.test(body.model.hexels.index(x, y, z))) --z;
            if (z < 0) continue;
            tissue::NearHexel near;
            near.hexel = body.model.hexels.index(x, y, z);
            near.rest_m = Vec3f(body.model.hexels.centre_m(near.hexel));
            body.exchange.near.push_back(near);
            const auto depth = static_cast<float>((x * 7 + y * 3) % 16);
            body.exchange.contacts.push_back(
                {static_cast<std::int32_t>(body.exchange.near.size() - 1), Vec3f(0, 0, -1), -1e-5f * depth, Vec3f(0)});
            all += body.model.contact.stiffness_N_per_m;
        }
    ASSERT_GT(body.exchange.contacts.size(), static_cast<std::size_t>(kMaxContactPoints));
    prepare_contacts(body.model, body.state, body.exchange, body.work);
    const std::vector<ContactPoint>& points = body.work.contact.points;
    ASSERT_EQ(points.size(), static_cast<std::size_t>(kMaxContactPoints));
    double kept = 0.0;
    for (const ContactPoint& point : points) {
        kept += static_cast<double>(point.stiffness_N_per_m);
        const auto owner = [&](std::int64_t hexel) {
            return body.model.phyxel_of(body.model.hexels.coordinates(hexel));
        };
        int deeper = 0, chosen = 0;
        for (const tissue::Contact& other : body.exchange.contacts)
            deeper += owner(body.exchange.near[static_cast<std::size_t>(other.near)].hexel) == owner(point.hexel) &&
                              other.gap_m < point.gap_m
                          ? 1
                          : 0;
        for (const ContactPoint& other : points) chosen += owner(other.hexel) == owner(point.hexel) ? 1 : 0;
        EXPECT_LT(deeper, chosen);
    }
    EXPECT_NEAR(kept, all, 1e-4 * all);
}

}  // namespace calot::deformation::rig

// Deformation's kernels against the CPU's, on random bodies.

#include "gpu/twin.h"

namespace calot::gpu {
namespace {

using deformation::rig::block;
using deformation::rig::Body;
using deformation::rig::kSpacing_m;
using deformation::rig::shake;
using deformation::rig::wound;

tissue::Model random_model(tissue::ElasticLaw law, const Int3& size = {6, 7, 5}, int hexels_per_edge = 4) {
    tissue::Model model = block(size, true, hexels_per_edge);
    model.deformation.law = law;
    model.deformation.volume_stiffness_Pa = 4e3;
    model.deformation.gravity_m_per_s2 = Vec3(1.0, -9.81, 2.0);
    return model;
}

/// Surface hexels of the top, every `stride`-th along each axis.
std::vector<std::int64_t> top_hexels(const Body& body, int stride) {
    std::vector<std::int64_t> found;
    const Int3 size = body.model.hexels.size;
    for (int y = 0; y < size.y; y += stride)
        for (int x = 0; x < size.x; x += stride)
            for (int z = size.z - 1; z >= 0; --z) {
                if (!body.state.hexel_present.test(body.model.hexels.index(x, y, z))) continue;
                found.push_back(body.model.hexels.index(x, y, z));
                break;
            }
    return found;
}

/// Contacts at these hexels, pushed down and sideways by either instrument.
void touch(Body& body, tissue::Exchange& exchange, const std::vector<std::int64_t>& hexels) {
    Random random(8);
    exchange.near.clear();
    exchange.contacts.clear();
    for (const std::int64_t hexel : hexels) {
        tissue::NearHexel near;
        near.hexel = hexel;
        exchange.near.push_back(near);
        const Vec3 normal(random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), -1.0);
        exchange.contacts.push_back({static_cast<std::int32_t>(exchange.near.size() - 1), Vec3f(glm::normalize(normal)),
                                     static_cast<float>(random.uniform(-3e-4, 1e-4)), Vec3f(0.02f, 0.0f, -0.05f),
                                     random.uniform() < 0.5 ? tissue::Instrument::hook : tissue::Instrument::grasper});
    }
    static_cast<void>(body);
}

/// A rod that lies across the top.
tissue::Capsule rod_over(const Body& body, double depth_m) {
    const Lattice& hexels = body.model.hexels;
    const Vec3 top = hexels.centre_m(Int3(hexels.size.x / 2, hexels.size.y / 2, hexels.size.z - 1));
    tissue::Capsule rod;
    rod.a_m = top + Vec3(-6e-3, -1e-3, 1e-3 - depth_m);
    rod.b_m = top + Vec3(5e-3, 2e-3, 1e-3 - depth_m);
    rod.radius_m = 1e-3;
    return rod;
}

}  // namespace

TEST(GpuDeformation, MovesAsTheCpuDoes) {
    for (const auto law : {tissue::ElasticLaw::stable_neo_hookean, tissue::ElasticLaw::saint_venant_kirchhoff})
        for (const double severed : {0.0, 0.3}) {
            Body body(random_model(law));
            wound(body, 0.3, severed, 3);
            shake(body, 0.03, 0.05, 4);
            Twin twin(body);
            EXPECT_LE(twin.difference_of_motion(), twin.tolerance()) << "gradients of the displacements given";
            for (int tick = 0; tick < 4; ++tick) {
                body.tick();
                twin.advance();
                EXPECT_LE(twin.difference_of_motion(), twin.tolerance()) << "severed " << severed << ", tick " << tick;
            }
            double fastest = 0.0;
            body.for_each_phyxel(
                [&](std::int64_t p) { fastest = std::max(fastest, glm::length(body.velocity_m_per_s(p))); });
            EXPECT_GT(fastest, 1e-2);
            EXPECT_TRUE(twin.state.status.ok);
        }
}

// Far stretched: masses are raised.
TEST(GpuDeformation, RaisesMassesAsTheCpuDoes) {
    Body body(random_model(tissue::ElasticLaw::stable_neo_hookean));
    wound(body, 0.2, 0.2, 5);
    shake(body, 0.35, 0.3, 6);
    Twin twin(body);
    body.tick();
    twin.advance();
    EXPECT_GT(body.work.raised.size(), 10u);
    EXPECT_LE(twin.difference_of_motion(), twin.tolerance());
    EXPECT_LE(difference(body.work.inverse_mass_per_kg, twin.plane(twin.deformation.mass(), MASS_INVERSE)),
              twin.tolerance());
    EXPECT_LE(difference(body.work.gravity_share, twin.plane(twin.deformation.mass(), MASS_GRAVITY_SHARE)),
              twin.tolerance());
}

TEST(GpuDeformation, SaysWhereItGoesWrong) {
    Body body(block({4, 4, 4}, true));
    const std::int64_t cell = body.model.phyxels.index(2, 1, 2);
    body.set_velocity(cell, Vec3(1e30, 0, 0));
    Twin twin(body);
    for (int tick = 0; tick < 3; ++tick) {
        body.tick();
        twin.advance();
    }
    ASSERT_FALSE(body.state.status.ok);
    EXPECT_FALSE(twin.state.status.ok);
    EXPECT_STREQ(twin.state.status.field, "displacement_m");
    EXPECT_EQ(twin.state.status.cell, body.state.status.cell);
}

// Few points, many points, more than are solved.
TEST(GpuDeformation, TouchesAsTheCpuDoes) {
    for (const int stride : {8, 4, 1}) {
        Body body(random_model(tissue::ElasticLaw::stable_neo_hookean));
        wound(body, 0.1, 0.1, 9);
        shake(body, 0.02, 0.02, 2);
        Twin twin(body);
        const auto hexels = top_hexels(body, stride);
        for (int tick = 0; tick < 4; ++tick) {
            touch(body, body.exchange, hexels);
            touch(body, twin.exchange, hexels);
            body.tick();
            twin.advance();
            ASSERT_GT(glm::length(body.exchange.contact_force_N), 1e-3);
            // The host adds up impulses in double precision, the device in single with what rounding loses.
            EXPECT_LT(glm::length(body.exchange.contact_force_N - twin.exchange.contact_force_N),
                      1e-6 * glm::length(body.exchange.contact_force_N));
            EXPECT_LT(glm::length(body.exchange.grasper_contact_force_N - twin.exchange.grasper_contact_force_N),
                      1e-6 * glm::length(body.exchange.contact_force_N) + twin.tolerance());
            EXPECT_LE(twin.difference_of_motion(), twin.tolerance()) << "stride " << stride << ", tick " << tick;
            ASSERT_EQ(twin.state.contact.count, body.state.contact.count);
            for (std::size_t k = 0; k < static_cast<std::size_t>(body.state.contact.count); ++k) {
                EXPECT_EQ(twin.state.contact.hexel[k], body.state.contact.hexel[k]);
                const Vec3f impulse = body.state.contact.impulse_Ns[k];
                EXPECT_LE(glm::length(twin.state.contact.impulse_Ns[k] - impulse),
                          static_cast<float>(twin.tolerance()) * glm::length(impulse));
            }
        }
    }
}

TEST(GpuDeformation, FindsTheSameHexelsNear) {
    for (const int hexels_per_edge : {4, 2, 1}) {
        Body body(random_model(tissue::ElasticLaw::stable_neo_hookean, {7, 6, 4}, hexels_per_edge));
        wound(body, 0.2, 0.1, 7);
        shake(body, 0.05, 0.05, 8);
        Twin twin(body);
        tissue::Capsule bare = rod_over(body, 1e-3);
        bare.b_m = 0.5 * (bare.a_m + bare.b_m);
        bare.bare = true;
        // The second differs by instrument, the third finds more than are read at once: all of the body.
        for (const deformation::NearReach& reach :
             {deformation::NearReach(2e-3), deformation::NearReach(3e-3, 0.5e-3, 1e-3),
              deformation::NearReach(20e-3)}) {
            for (tissue::Exchange* exchange : {&body.exchange, &twin.exchange})
                exchange->capsules = {rod_over(body, 0.5e-3), bare};
            deformation::find_near(body.model, body.state, body.exchange, body.work, reach);
            twin.deformation.find_near(twin.exchange, reach);
            const auto &expected = body.exchange.near, &found = twin.exchange.near;
            ASSERT_GE(expected.size(), 3u);
            if (hexels_per_edge == 4 && reach.hook_m == 20e-3) {  // more than there is room for
                EXPECT_EQ(expected.size(), static_cast<std::size_t>(tissue::kNearCapacity));
            }
            ASSERT_EQ(found.size(), expected.size());
            const auto tolerance = static_cast<float>(twin.tolerance());
            for (std::size_t k = 0; k < found.size(); ++k) {
                ASSERT_EQ(found[k].hexel, expected[k].hexel);
                EXPECT_EQ(found[k].rest_m, expected[k].rest_m);
                EXPECT_LE(glm::length(found[k].world_m - expected[k].world_m), tolerance * 0.1f);
                EXPECT_LE(std::abs(found[k].distance_m - expected[k].distance_m), tolerance * 0.1f);
                EXPECT_LE(std::abs(found[k].bare_gap_m - expected[k].bare_gap_m), tolerance * 0.1f);
                EXPECT_LE(glm::length(found[k].outward - expected[k].outward), 10 * tolerance);
            }
        }
    }
}

// More phyxels than there is room for at first.
TEST(GpuDeformation, MakesRoomForAllThatIsNear) {
    Body body(block({13, 12, 9}, true));
    shake(body, 0.02, 0.1, 3);
    Twin twin(body);
    ASSERT_GT(body.state.phyxel_present.count(), 1200);
    for (tissue::Exchange* exchange : {&body.exchange, &twin.exchange}) exchange->capsules = {rod_over(body, 5e-3)};
    deformation::find_near(body.model, body.state, body.exchange, body.work, 50e-3);
    for (int time = 0; time < 2; ++time) {
        twin.deformation.find_near(twin.exchange, 50e-3);
        ASSERT_EQ(twin.exchange.near.size(), body.exchange.near.size());
        for (std::size_t k = 0; k < twin.exchange.near.size(); ++k)
            ASSERT_EQ(twin.exchange.near[k].hexel, body.exchange.near[k].hexel);
    }
}

TEST(GpuDeformation, FindsNothingNearWithoutInstruments) {
    Body body(block({3, 3, 3}, true));
    Twin twin(body);
    twin.exchange.near.resize(3);
    twin.deformation.find_near(twin.exchange, 2e-3);
    EXPECT_TRUE(twin.exchange.near.empty());
    tissue::Capsule away = rod_over(body, 0.0);
    away.a_m.z = away.b_m.z = 1.0;
    twin.exchange.capsules = {away};
    twin.deformation.find_near(twin.exchange, 2e-3);
    EXPECT_TRUE(twin.exchange.near.empty());
}

TEST(GpuDeformation, EmbedsPointsAsTheCpuDoes) {
    Body body(random_model(tissue::ElasticLaw::stable_neo_hookean));
    wound(body, 0.3, 0.2, 13);
    shake(body, 0.1, 0.2, 14);
    Twin twin(body);
    // Near surface hexels and far from them; also of cells whose phyxel is gone.
    Random random(15);
    std::vector<Vec3f> rest_m;
    std::vector<std::int64_t> owner;
    for (std::int64_t h = body.model.hexels.first; h < body.model.hexels.last; ++h) {
        const Int3 c = body.model.hexels.coordinates(h);
        if (!body.model.hexels.contains(c) || random.uniform() > 0.3) continue;
        const double away_m = random.uniform() < 0.05 ? 3.0 * kSpacing_m : 0.6e-3;
        rest_m.push_back(Vec3f(body.model.hexels.centre_m(c) +
                               away_m * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1))));
        owner.push_back(h);
    }
    std::vector<Vec3f> expected_m(rest_m.size()), found_m(rest_m.size());
    std::vector<Mat3f> expected_F(rest_m.size());
    deformation::embed_points(body.model, body.state, body.work, rest_m, owner, expected_m, expected_F);
    twin.deformation.embed_points(rest_m, owner, found_m);
    const auto tolerance = static_cast<float>(twin.tolerance());
    float furthest = 0.0f;
    for (std::size_t k = 0; k < rest_m.size(); ++k) {
        EXPECT_LE(glm::length(found_m[k] - expected_m[k]), tolerance * 0.1f);
        furthest = std::max(furthest, glm::length(expected_m[k] - rest_m[k]));
    }
    EXPECT_GT(furthest, 1e-3f);

    // On the device, with gradients and a count of its own, less than what there is room for.
    const auto count = static_cast<std::int32_t>(rest_m.size()) - 7;
    const std::vector<std::int32_t> owners(owner.begin(), owner.end());
    DeviceArray<float> rest(*twin.device, 3 * count + 21), world(*twin.device, 3 * count + 21),
        gradients(*twin.device, 9 * count + 63);
    DeviceArray<std::int32_t> owner_of(*twin.device, count + 7), number(*twin.device, 1);
    rest.upload(*twin.device, {&rest_m[0].x, 3 * rest_m.size()});
    owner_of.upload(*twin.device, std::span<const std::int32_t>(owners));
    number.upload(*twin.device, {&count, 1});
    twin.deformation.embed_points(rest, owner_of, number, count + 7, world, &gradients);
    const auto places = world.download(*twin.device), F = gradients.download(*twin.device);
    for (std::size_t k = 0; k < rest_m.size(); ++k)
        for (std::size_t r = 0; r < 3; ++r) {
            const bool counts = k < static_cast<std::size_t>(count);
            EXPECT_EQ(places[3 * k + r], counts ? found_m[k][static_cast<int>(r)] : 0.0f);
            for (std::size_t c = 0; c < 3 && counts; ++c)
                EXPECT_LE(std::abs(F[9 * k + 3 * c + r] - expected_F[k][static_cast<int>(c)][static_cast<int>(r)]),
                          10 * tolerance);
        }
}

}  // namespace calot::gpu

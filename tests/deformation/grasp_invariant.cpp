// What the grasper holds: taking, momentum, pull against force, the grip's limit, letting go, loss.

#include "calot/deformation/grasp.h"

#include <gtest/gtest.h>

#include "calot/base/parallel.h"
#include "calot/deformation/embedding.h"
#include "calot/deformation/tear.h"
#include "calot/deformation/topology.h"
#include "calot/validation/elastic_rig.h"

namespace calot::deformation::rig {

namespace {

/// A grasper that comes down onto a block's top and closes.
struct Hand {
    Body body;
    tissue::GrasperInput input;

    explicit Hand(bool held, const Int3& size = {7, 7, 5}) : body(block(size, held)) {
        sever_initial_links(body.model, body.state);
        body.refresh();
        tissue::reserve_exchange(body.model, body.exchange);
        input.present = true;
        input.pose.orientation = glm::angleAxis(3.14159265358979, Vec3(1, 0, 0));  // shaft upwards
        input.pose.position_m = Vec3(0.0, 0.0, top_m() - 3e-3);
    }
    double top_m() const { return body.model.hexels.centre_m(Int3(0, 0, body.model.hexels.size.z - 1)).z; }
    void tick() {
        const tissue::Pose before = body.state.grasper.present ? body.state.grasper.pose : input.pose;
        body.exchange.grasper = input;
        body.exchange.grasper.jaw = stopped_jaw(input, body.state.grasper.held);
        tissue::Capsule jaws;  // only to find what is near: nothing collides here
        jaws.a_m = input.pose.position_m;
        jaws.b_m = input.pose.position_m + Vec3(0, 0, 20e-3);
        jaws.radius_m = 4e-3;
        body.exchange.capsules.assign(1, jaws);
        find_near(body.model, body.state, body.exchange, body.work, 2e-3);
        update_grasp(body.model, body.state, body.exchange, {});
        if (!body.state.grasper.present) body.state.grasper.pose = before;
        integrate(body.model, body.state, body.exchange, body.work);
        body.exchange.removed_hexels.clear();
        tear_overstretched(body.model, body.state, body.exchange, body.work);
        sever_burnt_links(body.model, body.state, body.exchange, body.work);
        body.state.grasper.present = 1;
        body.state.grasper.pose = body.exchange.grasper.pose;
        body.state.grasper.jaw = body.exchange.grasper.jaw;
        body.state.grasper.force_N = body.exchange.grasper_contact_force_N;
        ++body.state.tick;
    }
    void close() {
        for (const double jaw : {1.0, 0.6, 0.2, 0.0}) {
            input.jaw = jaw;
            tick();
        }
    }
    void pull(const Vec3& by_m, int ticks) {
        for (int k = 0; k < ticks; ++k) {
            input.pose.position_m += by_m / static_cast<double>(ticks);
            tick();
        }
    }
    Vec3 force_N() const { return body.state.grasper.force_N; }
};

}  // namespace

TEST(Grasp, TakesWhatIsBetweenTheJawsAndLetsGo) {
    Hand hand(true);
    hand.input.jaw = 0.0;
    for (int k = 0; k < 3; ++k) hand.tick();
    EXPECT_EQ(hand.body.state.grasper.held, 0) << "jaws that come closed take nothing";
    hand.close();
    const tissue::GrasperState& grasper = hand.body.state.grasper;
    ASSERT_GT(grasper.held, 4);
    EXPECT_EQ(grasper.jaw, kTakeJaw) << "tissue is in between";
    for (std::int64_t k = 0; k < grasper.held; ++k) {
        const Vec3f place = grasper.place_m[static_cast<std::size_t>(k)];
        EXPECT_LE(std::abs(place.y), 2.3e-3f);
        EXPECT_LE(place.z, 1e-6f);
    }
    hand.pull(Vec3(0, 0, 4e-3), 100);
    EXPECT_LT(hand.force_N().z, -0.02) << "the tissue pulls back";
    hand.input.jaw = 1.0;
    hand.tick();
    EXPECT_EQ(hand.body.state.grasper.held, 0);
    EXPECT_EQ(hand.force_N(), Vec3(0.0));
    EXPECT_EQ(hand.body.state.grasper.hexel[0], 0) << "nothing is left behind";
}

// Linear for small pulls: twice as far, twice the force; and the tissue follows.
TEST(Grasp, ForceGrowsWithThePull) {
    Hand hand(true);
    hand.close();
    double before_N = 0.0;
    for (const double pull_m : {1e-3, 2e-3, 3e-3}) {
        hand.pull(Vec3(0, 0, 1e-3), 100);
        for (int k = 0; k < 300; ++k) hand.tick();
        const double force_N = -hand.force_N().z;
        if (before_N > 0.0) {
            const double step = pull_m / (pull_m - 1e-3);
            EXPECT_NEAR(force_N / before_N, step, 0.1 * step);
        }
        EXPECT_GT(force_N, before_N);
        before_N = force_N;
    }
    const auto hexel = hand.body.state.grasper.hexel[0];
    const auto rest = Vec3f(hand.body.model.hexels.centre_m(hexel));
    Vec3f world;
    embed_points(hand.body.model, hand.body.state, hand.body.work, {&rest, 1}, {&hexel, 1}, {&world, 1});
    EXPECT_NEAR(static_cast<double>(world.z - rest.z), 3e-3, 0.5e-3);
}

// On a free body what the tissue gains is what the hand loses, about any axis.
TEST(Grasp, MomentumBalances) {
    Hand hand(false, {5, 5, 4});
    hand.body.model.deformation.damping_per_s = 0.0;
    hand.close();
    ASSERT_GT(hand.body.state.grasper.held, 4);
    Vec3 given_Ns(0.0);
    auto momentum = [&] {
        Vec3 sum(0.0);
        hand.body.for_each_phyxel([&](std::int64_t p) { sum += hand.body.mass_kg(p) * hand.body.velocity_m_per_s(p); });
        return sum;
    };
    const Vec3 before = momentum();
    for (int k = 0; k < 40; ++k) {
        hand.pull(Vec3(4e-5, 1e-5, 6e-5), 1);
        given_Ns -= hand.force_N() * hand.body.model.tick_s;
    }
    ASSERT_GT(glm::length(given_Ns), 1e-5);
    EXPECT_LT(glm::length(momentum() - before - given_Ns), 1e-3 * glm::length(given_Ns));
}

// However far and fast the hand goes, it pulls with no more than its grip: tissue tears off or slips out.
TEST(Grasp, PullsNoHarderThanItsGripHoweverFast) {
    for (const double speed_m_per_s : {0.05, 0.3, 1.0}) {
        Hand hand(true);
        hand.close();
        double most_N = 0.0;
        for (int k = 0; k < static_cast<int>(60.0 / speed_m_per_s); ++k) {  // 60 mm
            hand.pull(Vec3(0, 0, speed_m_per_s * 1e-3), 1);
            ASSERT_TRUE(hand.body.state.status.ok) << speed_m_per_s << " m/s, tick " << k;
            most_N = std::max(most_N, glm::length(hand.force_N()));
        }
        EXPECT_EQ(hand.body.state.grasper.held, 0);
        EXPECT_GT(hand.body.state.hexels_fallen, 0) << "soft fat tears before it slips";
        EXPECT_GT(most_N, 0.1);
        EXPECT_LE(most_N, kGrip_N * (1.0 + 1e-5));
    }
}

TEST(Grasp, LosesWhatBurns) {
    Hand hand(true);
    hand.close();
    const std::int64_t held = hand.body.state.grasper.held, hexel = hand.body.state.grasper.hexel[0];
    hand.body.state.hexel_present.clear(hexel);
    hand.body.exchange.removed_hexels.assign(1, hexel);
    sever_burnt_links(hand.body.model, hand.body.state, hand.body.exchange, hand.body.work);
    hand.tick();
    EXPECT_EQ(hand.body.state.grasper.held, held - 1);
    EXPECT_NE(hand.body.state.grasper.hexel[0], hexel);
}

TEST(Grasp, GivesTheSameBytesForAnyNumberOfThreads) {
    std::uint64_t expected = 0;
    for (const int threads : {1, 4}) {
        const ThreadLimit limit(threads);
        Hand hand(true, {20, 20, 12});
        hand.close();
        hand.pull(Vec3(1e-3, 0, 4e-3), 40);
        const std::uint64_t hash = tissue::hash(hand.body.state);
        if (threads == 1) expected = hash;
        EXPECT_EQ(hash, expected);
    }
}

}  // namespace calot::deformation::rig

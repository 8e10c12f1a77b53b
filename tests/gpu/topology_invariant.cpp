// Burning, tearing and pulling while the body moves: the device's run stays the CPU's.

#include "calot/instruments/hook.h"
#include "gpu/twin.h"

namespace calot::gpu {
namespace {

using deformation::rig::block;
using deformation::rig::Body;

/// Both runs of a body that has come to where the rules of topology hold, with heat in its hexels.
struct Burning {
    Body body;
    std::unique_ptr<Twin> twin;
    Random random;

    Burning(tissue::Model model, std::uint64_t seed, bool in_double = true) : body(std::move(model)), random(seed) {
        deformation::sever_initial_links(body.model, body.state);
        body.refresh();
        for (float& enthalpy : body.state.enthalpy_J_per_m3) enthalpy = static_cast<float>(random.uniform(0.0, 1e8));
        twin = std::make_unique<Twin>(body, test_device(in_double));
    }

    /// Takes hexels away from both, as heat does.
    void remove(const std::vector<std::int64_t>& hexels) {
        body.exchange.removed_hexels.assign(hexels.begin(), hexels.end());
        twin->exchange.removed_hexels.assign(hexels.begin(), hexels.end());
        for (const std::int64_t h : hexels) {
            body.state.hexel_present.clear(h);
            twin->state.hexel_present.clear(h);
        }
        const BitArray& bits = twin->state.hexel_present;
        twin->arrays.hexel_present.upload(*twin->device, words_of(bits));
    }
    /// Those of a ball somewhere, and a share of all.
    void burn(double radius, double share) {
        std::vector<std::int64_t> hexels;
        const Vec3 centre = Vec3(body.model.hexels.size) * Vec3(random.uniform(), random.uniform(), random.uniform());
        for (std::int64_t h = body.model.hexels.first; h < body.model.hexels.last; ++h) {
            if (!body.state.hexel_present.test(h)) continue;
            const bool hit = glm::length(Vec3(body.model.hexels.coordinates(h)) - centre) < radius;
            if (!hit && random.uniform() > share) continue;
            hexels.push_back(h);
        }
        remove(hexels);
    }

    void tear_and_sever() {
        deformation::tear_overstretched(body.model, body.state, body.exchange, body.work);
        deformation::sever_burnt_links(body.model, body.state, body.exchange, body.work);
        twin->deformation.tear_and_sever(twin->state, twin->exchange);
    }

    void move() {
        body.tick();
        twin->advance();
        ++twin->state.tick;
    }

    /// Bits, counts and heat are the same whatever the device; what moves is, within its tolerance.
    void compare(int tick) {
        ASSERT_LE(twin->difference_of_motion(), 10.0 * twin->tolerance()) << tick;
        EXPECT_LE(twin->difference_of_rest(), twin->tolerance()) << tick;
        EXPECT_EQ(twin->wrong_words(), 0) << tick;
        EXPECT_EQ(twin->exchange.removed_hexels, body.exchange.removed_hexels) << tick;
        EXPECT_EQ(twin->exchange.changed_phyxels, body.exchange.changed_phyxels) << tick;
        const tissue::State all = twin->fetched();
        EXPECT_EQ(all.hexel_present.words(), body.state.hexel_present.words()) << tick;
        EXPECT_EQ(all.phyxel_present.words(), body.state.phyxel_present.words()) << tick;
        for (std::size_t d = 0; d < all.links.size(); ++d)
            EXPECT_EQ(all.links[d].words(), body.state.links[d].words()) << tick;
        EXPECT_EQ(all.enthalpy_J_per_m3, body.state.enthalpy_J_per_m3) << tick;
        EXPECT_EQ(all.energy_J.debris, body.state.energy_J.debris) << tick;
        EXPECT_EQ(all.hexels_fallen, body.state.hexels_fallen) << tick;
        EXPECT_EQ(all.links_severed, body.state.links_severed) << tick;
        EXPECT_EQ(twin->state.hexel_present.words(), body.state.hexel_present.words()) << "on the host, " << tick;
    }
};

}  // namespace

TEST(GpuTopology, BurnsInMotionAsTheCpuDoes) {
    struct Case {
        bool held;
        int hexels_per_edge;
    };
    for (const Case& c : {Case{true, 4}, {false, 4}, {true, 2}}) {
        Burning both(block({5, 5, 4}, c.held, c.hexels_per_edge), 3);
        for (int tick = 0; tick < 40; ++tick) {
            const double angle = 0.05 * tick;
            both.body.model.deformation.gravity_m_per_s2 = 50.0 * Vec3(std::cos(angle), std::sin(angle), 0.5);
            both.move();
            both.burn(c.hexels_per_edge, tick % 8 == 0 ? 0.02 : 0.0);
            both.tear_and_sever();
            if (tick % 4 == 3) both.compare(tick);
            if (testing::Test::HasFailure()) return;
        }
        EXPECT_GT(both.body.state.hexels_fallen, 0) << "crumbs";
        EXPECT_GT(both.body.state.links_severed, 50);
    }
}

// Without double precision on the device: bits are the same, rest properties within float's rounding.
TEST(GpuTopology, SeversInSinglePrecision) {
    Burning both(block({5, 5, 4}, true), 4, false);
    for (int tick = 0; tick < 20; ++tick) {
        both.burn(4.0, tick % 4 == 0 ? 0.02 : 0.0);
        both.tear_and_sever();
        if (tick % 5 == 4) both.compare(tick);
        if (testing::Test::HasFailure()) return;
    }
    EXPECT_GT(both.body.state.links_severed, 50);
    EXPECT_GT(both.twin->difference_of_rest(), 0.0) << "it is another precision";
}

TEST(GpuTopology, TearsAsTheCpuDoes) {
    Burning both(block({4, 4, 5}, true), 5);
    both.body.for_each_phyxel([&](std::int64_t p) {  // the upper part flies away
        if (both.body.model.phyxels.coordinates(p).z >= 3) both.body.set_velocity(p, Vec3(0, 0, 8.0));
    });
    both.twin->state = both.body.state;
    both.twin->arrays.upload(*both.twin->device, both.twin->state);
    for (int tick = 0; tick < 12; ++tick) {
        both.move();
        both.body.exchange.removed_hexels.clear();
        both.twin->exchange.removed_hexels.clear();
        both.tear_and_sever();
        both.compare(tick);
        if (testing::Test::HasFailure()) return;
    }
    EXPECT_GT(both.body.state.hexels_fallen, 300) << "more than a report tells at once, and what they held";
}

// A hook presses, drags and eats its way: every few ticks what its bare wire touches is gone.
TEST(GpuTopology, DissectsAsTheCpuDoes) {
    Burning both(block({8, 7, 4}, true), 7);
    Body& body = both.body;
    Twin& twin = *both.twin;
    const instruments::HookShape hook;
    double top_m = -1.0;
    for (std::int64_t h = body.model.hexels.first; h < body.model.hexels.last; ++h)
        if (body.state.hexel_present.test(h)) top_m = std::max(top_m, body.model.hexels.centre_m(h).z);
    tissue::Pose before;
    double hardest_N = 0.0;
    for (int tick = 0; tick < 250; ++tick) {
        tissue::Pose pose;
        pose.orientation = glm::angleAxis(3.14159265358979 - 0.4, Vec3(1, 0, 0));  // shaft upwards, a little aslant
        const double down_m = std::min(3e-3, 0.05e-3 * tick), along_m = std::max(0, tick - 80) * 0.03e-3;
        pose.position_m = Vec3(along_m - 2e-3, 0.3 * along_m, top_m + 1e-3 - down_m);
        if (tick == 0) before = pose;
        for (tissue::Exchange* exchange : {&body.exchange, &twin.exchange})
            instruments::place_hook(hook, pose, before, body.model.tick_s, exchange->capsules);
        before = pose;
        deformation::find_near(body.model, body.state, body.exchange, body.work, 2e-3);
        twin.deformation.find_near(twin.exchange, 2e-3);
        instruments::find_contacts(body.model, body.state, body.exchange);
        instruments::find_contacts(body.model, twin.state, twin.exchange);
        ASSERT_EQ(twin.exchange.near.size(), body.exchange.near.size()) << tick;
        ASSERT_EQ(twin.exchange.contacts.size(), body.exchange.contacts.size()) << tick;
        both.move();
        std::vector<std::int64_t> burnt;
        if (tick > 60 && tick % 3 == 0)
            for (const tissue::NearHexel& near : body.exchange.near)
                if (near.bare_gap_m < 0.6e-3f) burnt.push_back(near.hexel);
        both.remove(burnt);
        both.tear_and_sever();
        const Vec3 force_N = body.exchange.contact_force_N;
        EXPECT_LE(glm::length(twin.exchange.contact_force_N - force_N), 1e-6 * glm::length(force_N)) << tick;
        hardest_N = std::max(hardest_N, glm::length(force_N));
        if (tick % 25 == 24) both.compare(tick);
        if (testing::Test::HasFailure()) return;
    }
    EXPECT_GT(hardest_N, 0.02);
    EXPECT_GT(body.state.links_severed, 10);
}

// A grasper takes hold, pulls beyond its grip, and tears.
TEST(GpuTopology, PullsAsTheCpuDoes) {
    Burning both(block({6, 6, 5}, true), 6);
    Body& body = both.body;
    tissue::GrasperInput input;
    input.present = true;
    input.pose.orientation = glm::angleAxis(3.14159265358979, Vec3(1, 0, 0));  // shaft upwards
    const Int3 top(0, 0, body.model.hexels.size.z - 1);
    input.pose.position_m = Vec3(0.0, 0.0, body.model.hexels.centre_m(top).z - 3e-3);
    double most_N = 0.0, held = 0.0;
    for (int tick = 0; tick < 120; ++tick) {
        input.jaw = tick < 3 ? 1.0 - 0.4 * tick : 0.0;
        if (tick > 3) input.pose.position_m.z += 0.3e-3;
        auto set = [&](tissue::State& state, tissue::Exchange& exchange) {
            exchange.grasper = input;
            exchange.grasper.jaw = deformation::stopped_jaw(input, state.grasper.held);
            tissue::Capsule jaws;
            jaws.a_m = input.pose.position_m;
            jaws.b_m = input.pose.position_m + Vec3(0, 0, 20e-3);
            jaws.radius_m = 4e-3;
            exchange.capsules.assign(1, jaws);
            exchange.removed_hexels.clear();
        };
        auto remember = [&](tissue::State& state, const tissue::Exchange& exchange) {
            state.grasper.present = 1;
            state.grasper.pose = exchange.grasper.pose;
            state.grasper.jaw = exchange.grasper.jaw;
        };
        Twin& twin = *both.twin;
        if (tick == 0) body.state.grasper.pose = twin.state.grasper.pose = input.pose;
        set(body.state, body.exchange);
        set(twin.state, twin.exchange);
        deformation::find_near(body.model, body.state, body.exchange, body.work, 2e-3);
        twin.deformation.find_near(twin.exchange, 2e-3);
        deformation::update_grasp(body.model, body.state, body.exchange, {});
        deformation::update_grasp(body.model, twin.state, twin.exchange, {});
        both.move();
        both.tear_and_sever();
        remember(body.state, body.exchange);
        remember(twin.state, twin.exchange);
        ASSERT_EQ(twin.state.grasper.held, body.state.grasper.held) << tick;
        const Vec3 force_N = body.exchange.grasper_contact_force_N;
        EXPECT_LE(glm::length(twin.exchange.grasper_contact_force_N - force_N), 1e-6 * glm::length(force_N)) << tick;
        ASSERT_LE(twin.difference_of_motion(), 100.0 * twin.tolerance()) << tick;
        most_N = std::max(most_N, glm::length(force_N));
        held = std::max(held, static_cast<double>(body.state.grasper.held));
    }
    EXPECT_GT(held, 4.0);
    EXPECT_GT(most_N, 0.1);
    EXPECT_EQ(body.state.grasper.held, 0) << "torn off";
}

}  // namespace calot::gpu

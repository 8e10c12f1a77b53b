// The search for near hexels and what carries contact points: every instruction set gives the same bytes, and lists
// that last for a frame find what a search from nothing finds.

#include <cstring>
#include <functional>
#include <vector>

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include "calot/deformation/contact.h"
#include "calot/deformation/embedding.h"
#include "calot/deformation/kernel.h"
#include "calot/validation/elastic_rig.h"

namespace calot::deformation::rig {

namespace {

/// Two instruments that cross a wounded block with tissue out of place; `moved_m` moves both.
struct Scene {
    Body body;

    explicit Scene(int hexels_per_edge) : body(block({14, 9, 6}, true, hexels_per_edge)) {
        wound(body, 0.2, 0.1, 7);
        body.refresh();
        tissue::reserve_exchange(body.model, body.exchange);
        displace(3);
        place(Vec3(0.0));
    }
    void displace(std::uint64_t seed, const Vec3& drift_m = Vec3(0.0)) {
        Random random(seed);
        body.for_each_phyxel([&](std::int64_t p) {
            const Vec3 noise(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
            body.set_displacement(p, drift_m + 0.3e-3 * noise);
        });
        update_gradients(body.model, body.state, body.work);
    }
    void place(Vec3 moved_m) {
        using tissue::Instrument;
        moved_m.z -= 7e-3;  // the block's top is at 0
        body.exchange.capsules = {
            {.a_m = Vec3(-4e-3, 0.0, 5e-3) + moved_m,
             .b_m = Vec3(1e-3, 1e-3, 6e-3) + moved_m,
             .radius_m = 5e-4,
             .bare = true},
            {.a_m = Vec3(-4e-3, 0.0, 8e-3) + moved_m, .b_m = Vec3(-4e-3, 0.02, 0.3) + moved_m, .radius_m = 2.5e-3},
            {.a_m = Vec3(9e-3, 2e-3, 2e-3) + moved_m,
             .b_m = Vec3(12e-3, -4e-3, 20e-3) + moved_m,
             .radius_m = 1.2e-3,
             .instrument = Instrument::grasper},
            {.a_m = Vec3(5e-3, -8e-3, 9e-3) + moved_m,
             .b_m = Vec3(5e-3, -8e-3, 9e-3) + moved_m,
             .radius_m = 2e-3,
             .instrument = Instrument::grasper}};
    }
    const std::vector<tissue::NearHexel>& find() { return find(body.work); }
    const std::vector<tissue::NearHexel>& find(Work& work) {
        find_near(body.model, body.state, body.exchange, work, {2.5e-3, 0.7e-3, 3e-3});
        return body.exchange.near;
    }
};

/// All numbers of a hexel, without what lies between them in memory.
std::vector<float> numbers(const std::vector<tissue::NearHexel>& near) {
    std::vector<float> all;
    for (const tissue::NearHexel& n : near) {
        all.push_back(static_cast<float>(n.hexel));
        for (const Vec3f& v : {n.rest_m, n.world_m, n.outward}) all.insert(all.end(), {v.x, v.y, v.z});
        all.insert(all.end(), {n.bare_gap_m, n.distance_m});
    }
    return all;
}

/// What `result` gives on every instruction set is what it gives on the first.
void expect_same_on_all(const std::function<std::vector<float>()>& result) {
    std::vector<float> first;
    for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
        hwy::SetSupportedTargetsForTest(target);
        const std::vector<float> now = result();
        if (first.empty()) first = now;
        EXPECT_GT(now.size(), 100u);
        ASSERT_EQ(now.size(), first.size()) << hwy::TargetName(target);
        EXPECT_EQ(std::memcmp(now.data(), first.data(), first.size() * sizeof(float)), 0) << hwy::TargetName(target);
    }
    hwy::SetSupportedTargetsForTest(0);
}

}  // namespace

TEST(FindNear, GivesTheSameBytesOnEveryInstructionSet) {
    for (const int hexels_per_edge : {1, 2, 4}) {
        Scene scene(hexels_per_edge);
        expect_same_on_all([&] { return numbers(scene.find()); });
    }
}

TEST(FindNear, ListsOfAFrameMissNothing) {
    Scene scene(4);
    Body& body = scene.body;
    std::size_t found = 0;
    for (int tick = 0; tick < 40; ++tick) {
        body.state.tick = tick;
        // By a millimetre at most, and all of it at 0.6 m/s through the frame.
        scene.displace(static_cast<std::uint64_t>(tick / 2), Vec3(0.3e-3, 0.0, 0.5e-3) * static_cast<double>(tick % 8));
        // To and fro at 0.3 m/s, then somewhere else at once.
        const double t = 1e-3 * tick;
        scene.place(tick == 21 ? Vec3(-6e-3, 2e-3, 0.0) : Vec3(0.3 * std::fabs(t - 0.02) - 4e-3, 0.1 * t, 0.0));
        const std::vector<float> kept = numbers(scene.find());
        Work knows_nothing = body.work;
        knows_nothing.near.tick = -1;
        const std::vector<float> anew = numbers(scene.find(knows_nothing));
        EXPECT_EQ(kept, anew) << "tick " << tick;
        found += anew.size();
    }
    EXPECT_GT(found, 40u * 100u);
}

// A body that flies past the instrument at 3 m/s: three times its margin within a frame.
TEST(FindNear, ListsOfAFrameMissNothingThatIsFast) {
    Scene scene(4);
    Body& body = scene.body;
    scene.place(Vec3(18e-3, 0.0, 0.0));
    std::size_t found = 0;
    for (int tick = 1; tick < 16; ++tick) {  // a frame begins at 8
        body.state.tick = tick;
        const std::vector<float> kept = numbers(scene.find());
        Work knows_nothing = body.work;
        knows_nothing.near.tick = -1;
        const std::vector<float> anew = numbers(scene.find(knows_nothing));
        EXPECT_EQ(kept, anew) << "tick " << tick;
        found += anew.size();
        body.for_each_phyxel([&](std::int64_t p) { body.set_velocity(p, Vec3(3.0, 0.0, 0.0)); });
        KernelView view = KernelView::make(body.model, body.state, body.work);
        view.substep_s = 1e-3f;
        sweep_motion(view, body.work.groups);
    }
    EXPECT_GT(found, 1000u);
}

TEST(ContactShares, GiveTheSameBytesOnEveryInstructionSet) {
    Scene scene(4);
    Body& body = scene.body;
    const std::vector<tissue::NearHexel>& near = scene.find();
    for (std::size_t k = 0; k < near.size(); k += 5)
        body.exchange.contacts.push_back(
            {static_cast<std::int32_t>(k), Vec3f(0.0f, 0.0f, 1.0f), -1e-4f, Vec3f(0.0f), tissue::Instrument::hook});
    expect_same_on_all([&] {
        prepare_contacts(body.model, body.state, body.exchange, body.work);
        const ContactWork& contact = body.work.contact;
        return std::vector<float>(
            contact.psi.begin(),
            contact.psi.begin() +
                static_cast<std::ptrdiff_t>(contact.points.size() * static_cast<std::size_t>(contact.stride)));
    });
}

}  // namespace calot::deformation::rig

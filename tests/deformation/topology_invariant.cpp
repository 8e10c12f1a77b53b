// Random burning: after every tick the local update equals the rules applied to the whole lattice from scratch.
#include <gtest/gtest.h>

#include <cstring>

#include "calot/validation/elastic_rig.h"
#include "calot/deformation/topology.h"

namespace calot::deformation {

namespace {

using rig::Body;

struct BurningBody : Body {
    std::int64_t initial_hexels, burnt = 0;
    Random random;

    BurningBody(tissue::Model given, std::uint64_t seed) : Body(std::move(given)), random(seed) {
        sever_initial_links(model, state);
        refresh();
        initial_hexels = state.hexel_present.count();
        tissue::reserve_exchange(model, exchange);
        rig::shake(*this, 0.05, 0.0, 3);
    }
    /// Takes hexels out of State as thermal does: within a ball about a random place, or anywhere at random.
    void burn() {
        exchange.removed_hexels.clear();
        const Int3 size = model.hexels.size;
        const Vec3 centre(random.uniform(0, size.x), random.uniform(0, size.y), random.uniform(0, size.z));
        const double radius = random.uniform(1.0, 5.0), scattered = random.uniform() < 0.3 ? 0.05 : 0.0;
        for (std::int64_t h = model.hexels.first; h < model.hexels.last; ++h) {
            if (!state.hexel_present.test(h)) continue;
            if (glm::length(Vec3(model.hexels.coordinates(h)) - centre) > radius && random.uniform() >= scattered)
                continue;
            state.hexel_present.clear(h);
            exchange.removed_hexels.push_back(h);
            ++burnt;
        }
    }
};

std::int64_t live_links(const tissue::State& state) {
    std::int64_t count = 0;
    for (const BitArray& links : state.links) count += links.count();
    return count;
}

template <class T>
bool same_bytes(const Array<T>& a, const Array<T>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

void expect_same_topology(const tissue::State& a, const tissue::State& b) {
    EXPECT_EQ(a.hexel_present.words(), b.hexel_present.words());
    EXPECT_EQ(a.phyxel_present.words(), b.phyxel_present.words());
    for (std::size_t d = 0; d < a.links.size(); ++d)
        EXPECT_EQ(a.links[d].words(), b.links[d].words()) << "direction " << d;
}

void expect_same_work(const Work& a, const Work& b) {
    EXPECT_TRUE(same_bytes(a.occupancy, b.occupancy));
    EXPECT_TRUE(same_bytes(a.volume_m3, b.volume_m3));
    EXPECT_TRUE(same_bytes(a.inverse_mass_per_kg, b.inverse_mass_per_kg));
    EXPECT_TRUE(same_bytes(a.hourglass, b.hourglass));
    for (std::size_t k = 0; k < 6; ++k) EXPECT_TRUE(same_bytes(a.moment_inverse[k], b.moment_inverse[k]));
    for (std::size_t k = 0; k < 9; ++k) EXPECT_TRUE(same_bytes(a.gradient[k], b.gradient[k])) << "gradient " << k;
    for (std::size_t k = 0; k < 9; ++k)
        EXPECT_TRUE(same_bytes(a.moment_stress[k], b.moment_stress[k])) << "moment " << k;
}

void burn_down(bool held, int hexels_per_edge, std::uint64_t seed) {
    BurningBody body(rig::block({5, 4, 3}, held, hexels_per_edge), seed);
    const std::int64_t initial_links = live_links(body.state);
    const auto* removed = body.exchange.removed_hexels.data();
    const auto* changed = body.exchange.changed_phyxels.data();
    for (int tick = 0; tick < 120 && !::testing::Test::HasFailure(); ++tick) {
        SCOPED_TRACE(tick);
        body.burn();
        tissue::State reference = tissue::State::make(body.model);
        reference.hexel_present = body.state.hexel_present;
        sever_initial_links(body.model, reference);
        sever_burnt_links(body.model, body.state, body.exchange, body.work);

        expect_same_topology(body.state, reference);
        expect_same_work(body.work, make_work(body.model, body.state));
        EXPECT_EQ(body.state.hexels_fallen, body.initial_hexels - body.burnt - body.state.hexel_present.count());
        EXPECT_EQ(body.state.links_severed, initial_links - live_links(body.state));
        EXPECT_EQ(body.work.changed.count(), 0);
        EXPECT_EQ(body.exchange.removed_hexels.data(), removed) << "must not grow";
        EXPECT_EQ(body.exchange.changed_phyxels.data(), changed) << "must not grow";
        std::int64_t in_words = 0;
        for (const std::uint64_t word : body.work.occupancy) in_words += __builtin_popcountll(word);
        EXPECT_EQ(in_words, body.state.hexel_present.count());
        for (std::int64_t h : body.exchange.removed_hexels) EXPECT_FALSE(body.state.hexel_present.test(h));
    }
    EXPECT_LT(body.state.hexel_present.count(), body.initial_hexels / 2);
}

}  // namespace

TEST(TopologyInvariant, LocalUpdatesEqualTheWholeRulesHeld) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) burn_down(true, 4, seed);
}
TEST(TopologyInvariant, LocalUpdatesEqualTheWholeRulesFree) {
    burn_down(false, 4, 4);
}
TEST(TopologyInvariant, LocalUpdatesEqualTheWholeRulesCoarse) {
    burn_down(true, 2, 5);
    burn_down(true, 1, 6);
}

}  // namespace calot::deformation

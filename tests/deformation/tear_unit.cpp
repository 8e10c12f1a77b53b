#include "calot/deformation/tear.h"

#include <gtest/gtest.h>

#include "calot/anatomy/block.h"
#include "calot/deformation/topology.h"
#include "calot/tissue/sampling.h"

namespace calot::deformation {

namespace {

class Tear : public ::testing::Test {
  protected:
    Tear()
        : model(tissue::sample(anatomy::make_block({.size_m = Vec3(0.0096)}), {})), state(tissue::State::make(model)) {
        sever_initial_links(model, state);
        tissue::reserve_exchange(model, exchange);
        work = make_work(model, state);
        phyxel = model.phyxels.index(2, 2, 4);  // a corner of the top layer
    }
    /// F of the phyxel, diagonal.
    void stretch(float x, float y, float z) {
        work.gradient[0][static_cast<std::size_t>(phyxel)] = x - 1.0f;
        work.gradient[4][static_cast<std::size_t>(phyxel)] = y - 1.0f;
        work.gradient[8][static_cast<std::size_t>(phyxel)] = z - 1.0f;
    }

    void tear() { tear_overstretched(model, state, exchange, work); }

    tissue::Model model;
    tissue::State state;
    tissue::Exchange exchange;
    Work work;
    std::int64_t phyxel = 0;
};

}  // namespace

TEST_F(Tear, OverstretchedTissueFallsWithItsHeat) {
    ASSERT_TRUE(state.phyxel_present.test(phyxel));
    const std::int64_t before = state.hexel_present.count();
    const auto all = static_cast<std::int64_t>(__builtin_popcountll(work.occupancy[static_cast<std::size_t>(phyxel)]));
    for (float& h : state.enthalpy_J_per_m3) h = 1e6f;
    stretch(2.6f, 0.62f, 0.62f);
    tear();
    EXPECT_EQ(static_cast<std::int64_t>(exchange.removed_hexels.size()), all);
    sever_burnt_links(model, state, exchange, work);
    EXPECT_FALSE(state.phyxel_present.test(phyxel));
    EXPECT_EQ(before - state.hexel_present.count(), state.hexels_fallen);
    EXPECT_NEAR(state.energy_J.debris, 1e6 * model.hexel_volume_m3() * static_cast<double>(state.hexels_fallen), 1e-12);
}

TEST_F(Tear, LimitIsTheStretchNotTheRotation) {
    stretch(2.4f, 0.64f, 0.64f);
    tear();
    stretch(-1.0f, -1.0f, 1.0f);  // half a turn
    tear();
    EXPECT_TRUE(exchange.removed_hexels.empty());
}

}  // namespace calot::deformation

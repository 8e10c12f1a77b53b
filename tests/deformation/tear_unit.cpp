#include "calot/deformation/tear.h"

#include <gtest/gtest.h>

#include "calot/anatomy/block.h"
#include "calot/deformation/integrate.h"
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
    }
    /// The whole body, with F diagonal.
    void stretch(float x, float y, float z) {
        const Vec3 f(x, y, z);
        for (std::int64_t p = model.phyxels.first; p < model.phyxels.last; ++p) {
            if (!state.phyxel_present.test(p) && !model.phyxel_ghost.test(p)) continue;
            const Vec3 u = (f - Vec3(1.0)) * model.phyxels.centre_m(p);
            for (std::size_t r = 0; r < 3; ++r)
                state.displacement_m[r][static_cast<std::size_t>(p)] = static_cast<float>(u[static_cast<int>(r)]);
        }
        update_gradients(model, state, work);
    }

    void tear() { tear_overstretched(model, state, exchange, work); }

    tissue::Model model;
    tissue::State state;
    tissue::Exchange exchange;
    Work work;
};

}  // namespace

TEST_F(Tear, OverstretchedTissueFallsWithItsHeat) {
    const std::int64_t before = state.hexel_present.count();
    for (float& h : state.enthalpy_J_per_m3) h = 1e6f;
    stretch(2.6f, 0.62f, 0.62f);
    tear();
    EXPECT_EQ(static_cast<std::int64_t>(exchange.removed_hexels.size()), before);
    sever_burnt_links(model, state, exchange, work);
    EXPECT_EQ(state.phyxel_present.count(), 0);
    EXPECT_EQ(state.hexels_fallen, before);
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

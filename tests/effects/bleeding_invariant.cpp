// Arteries bleed when their wall burns, less when it is coagulated; what bled can be washed and drawn off.

#include "calot/effects/bleeding.h"

#include <gtest/gtest.h>

#include <numeric>

#include "calot/anatomy/shapes.h"
#include "calot/tissue/phase.h"
#include "calot/tissue/sampling.h"

namespace calot::effects {
namespace {

/// Fat with an artery at its surface.
class Bleed : public ::testing::Test {
  protected:
    Bleed() {
        anatomy.field = {Vec3(-0.01), Vec3(0.01)};
        anatomy.tissues.push_back(
            {"fat", "fat", anatomy::make_box(Vec3(-0.009, -0.009, -0.006), Vec3(0.009, 0.009, 0.0))});
        anatomy.tissues.push_back(
            {"cystic_artery", "cystic_artery", anatomy::make_box(Vec3(-0.009, -0.001, -0.002), Vec3(0.009, 0.001, 0.0))});
        model = tissue::sample(anatomy, {});
        state = tissue::State::make(model);
        tissue::reserve_exchange(model, exchange);
    }
    /// Takes a hexel of the wall near the middle of the artery.
    void burn(int count = 1) {
        for (std::int64_t hexel = 0; hexel < model.hexels.cells && count > 0; ++hexel) {
            if (!state.hexel_present.test(hexel)) continue;
            const auto material = model.hexel_material[static_cast<std::size_t>(hexel)];
            if (model.materials[material].name != "cystic_artery") continue;
            const Vec3 at = model.hexels.centre_m(hexel);
            if (std::abs(at.x) > 0.001 || at.z < -0.0007) continue;
            state.hexel_present.clear(hexel);
            exchange.removed_hexels.push_back(hexel);
            --count;
        }
        ASSERT_EQ(count, 0);
    }
    void run(Bleeding& bleeding, int ticks, bool suction = false, bool irrigation = false) {
        tissue::Input input;
        input.hook = hook;
        input.suction = suction;
        input.irrigation = irrigation;
        for (int tick = 0; tick < ticks; ++tick) {
            bleeding.step(model, state, exchange, input);
            exchange.removed_hexels.clear();
            ++state.tick;
        }
    }
    double film_m(const Bleeding& bleeding) const {
        return std::accumulate(bleeding.film_m().begin(), bleeding.film_m().end(), 0.0);
    }

    anatomy::Anatomy anatomy;
    tissue::Model model;
    tissue::State state;
    tissue::Exchange exchange;
    tissue::Pose hook{Vec3(0.0, 0.0, 0.002), Quat(0.0, 1.0, 0.0, 0.0)};
};

TEST_F(Bleed, whole_arteries_do_not_bleed) {
    Bleeding bleeding(model);
    run(bleeding, 500);
    EXPECT_EQ(bleeding.lost_m3(), 0.0);
    EXPECT_TRUE(bleeding.drops().empty());
}

TEST_F(Bleed, breached_ones_spurt_with_the_pulse_and_wet_what_is_about) {
    Bleeding bleeding(model);
    burn(4);
    double least = 1.0, most = 0.0;
    for (int k = 0; k < 100; ++k) {
        run(bleeding, 20);
        least = std::min(least, bleeding.flow_m3_per_s());
        most = std::max(most, bleeding.flow_m3_per_s());
    }
    EXPECT_GT(most, 2.0 * least);
    EXPECT_GT(bleeding.lost_m3(), 0.2e-6);  // 2 s at some tenths of a millilitre a second
    EXPECT_LT(bleeding.lost_m3(), 2.0e-6);
    EXPECT_GT(film_m(bleeding), 1e-3);
    for (std::int64_t hexel = 0; hexel < model.hexels.cells; ++hexel)
        if (bleeding.film_m()[static_cast<std::size_t>(hexel)] > 0.0f) {
            EXPECT_TRUE(state.hexel_present.test(hexel));
        }
}

TEST_F(Bleed, same_run_same_blood) {
    const tissue::State before = state;
    auto bleed = [&] {
        state = before;
        Bleeding bleeding(model);
        burn(3);
        run(bleeding, 700);
        return std::pair(film_m(bleeding), bleeding.drops().size());
    };
    EXPECT_EQ(bleed(), bleed());
}

TEST_F(Bleed, coagulation_stops_it) {
    Bleeding bleeding(model);
    burn(3);
    run(bleeding, 100);
    ASSERT_GT(bleeding.flow_m3_per_s(), 0.0);
    // All about the hole at 90 C for two seconds.
    for (std::int64_t hexel = 0; hexel < model.hexels.cells; ++hexel)
        if (state.hexel_present.test(hexel)) state.enthalpy_J_per_m3[static_cast<std::size_t>(hexel)] = 1.7e8f;
    for (std::int64_t hexel = 0; hexel < model.hexels.cells; ++hexel)
        if (state.hexel_present.test(hexel)) {
            ASSERT_GT(tissue::temperature_K(model, state, hexel), 350.0f);
            break;
        }
    run(bleeding, 2000);
    EXPECT_EQ(bleeding.flow_m3_per_s(), 0.0);
}

TEST_F(Bleed, suction_and_irrigation_clean) {
    const tissue::State before = state;
    auto left = [&](bool suction, bool irrigation) {
        state = before;
        Bleeding bleeding(model);
        burn(2);
        run(bleeding, 1500);
        hook.position_m = Vec3(0.0, 0.0, 0.002);
        run(bleeding, 500, suction, irrigation);
        return film_m(bleeding);
    };
    const double untouched = left(false, false);
    EXPECT_LT(left(true, false), 0.6 * untouched);
    EXPECT_LT(left(false, true), 0.8 * untouched);
}

TEST_F(Bleed, memory_is_bounded_and_reserved) {
    Bleeding bleeding(model);
    burn(4);
    run(bleeding, 4000, false, true);
    EXPECT_LE(bleeding.drops().size(), Bleeding::kMostDrops);
}

}  // namespace
}  // namespace calot::effects

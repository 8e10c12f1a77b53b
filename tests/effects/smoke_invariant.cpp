// Smoke: mass is accounted for, the count is bounded, the same gas gives the same smoke.

#include <cmath>

#include <gtest/gtest.h>

#include "calot/base/hash.h"
#include "calot/base/random.h"
#include "calot/effects/smoke.h"
#include "calot/effects/turbulence.h"

namespace calot::effects {

namespace {

constexpr double kTick_s = 1e-3;

/// One tick of a burn that wanders: `rate_kg_per_s` in a few events.
void burn(Smoke& smoke, std::int64_t tick, double rate_kg_per_s) {
    Random random(42, static_cast<std::uint64_t>(tick));
    tissue::Exchange exchange;
    std::vector<Vec3f> world_m;
    for (int k = 0; k < 3 && rate_kg_per_s > 0.0; ++k) {
        tissue::GasEvent event;
        event.steam_kg = static_cast<float>(rate_kg_per_s * kTick_s / 3.0 * random.uniform(0.0, 1.2));
        event.smoke_kg = static_cast<float>(rate_kg_per_s * kTick_s / 3.0 * random.uniform(0.0, 0.8));
        event.temperature_K = 400.0f;
        exchange.gas.push_back(event);
        world_m.push_back(Vec3f(0.01 * std::sin(1e-3 * static_cast<double>(tick)), random.uniform(-1e-3, 1e-3), 0.0));
    }
    smoke.step(exchange, world_m, tick, kTick_s);
}

double accounted_kg(const Smoke& smoke) {
    return smoke.pending_kg() + smoke.particles_kg() + smoke.drawn_off_kg() + smoke.faded_kg();
}

}  // namespace

// Twenty seconds of ordinary burning, then as long of a hundred times as much: nothing lost, never too many, memory
// stays put.
TEST(Smoke, MassIsAccountedForAndCountIsBounded) {
    Smoke smoke;
    std::size_t most = 0;
    const SmokeParticle* memory = nullptr;
    for (std::int64_t tick = 0; tick < 40'000; ++tick) {
        burn(smoke, tick, tick < 20'000 ? 25e-6 : 2.5e-3);
        most = std::max(most, smoke.particles().size());
        if (tick == 10) memory = smoke.particles().data();
        if (tick == 19'999) {
            EXPECT_GT(most, 300u);
            EXPECT_LT(most, 1500u) << "an ordinary burn leaves room";
        }
        if (tick % 5'000 == 0) {
            ASSERT_NEAR(accounted_kg(smoke), smoke.emitted_kg(), 1e-6 * smoke.emitted_kg() + 1e-15) << tick;
        }
    }
    EXPECT_LE(most, SmokeParameters().max_particles);
    EXPECT_EQ(smoke.particles().data(), memory) << "no growth";
    EXPECT_GT(smoke.drawn_off_kg(), 0.2 * smoke.emitted_kg());
    // When the burning ends, the view clears.
    for (std::int64_t tick = 40'000; tick < 55'000; ++tick) burn(smoke, tick, 0.0);
    EXPECT_EQ(smoke.particles().size(), 0u);
    EXPECT_NEAR(accounted_kg(smoke), smoke.emitted_kg(), 1e-6 * smoke.emitted_kg());
}

// Without evaporation and ageing, suction alone draws off 1 - exp(-rate t).
TEST(Smoke, SuctionDrawsOffItsShare) {
    SmokeParameters parameters;
    parameters.suction_per_s = 2.0;
    Smoke smoke(parameters);
    tissue::Exchange exchange;
    exchange.gas.push_back({0, 0.0f, 4e-7f, 500.0f});
    smoke.step(exchange, {Vec3f(0.0f)}, 0, kTick_s);
    exchange.gas.clear();
    ASSERT_LT(smoke.pending_kg(), 1e-6 * smoke.emitted_kg());  // float rounding of the puffs
    for (std::int64_t tick = 1; tick <= 1000; ++tick) smoke.step(exchange, {}, tick, kTick_s);
    EXPECT_NEAR(smoke.drawn_off_kg() / smoke.emitted_kg(), 1.0 - std::exp(-2.0), 1e-3);  // steps of ten ticks
    EXPECT_EQ(smoke.faded_kg(), 0.0);
}

TEST(Smoke, RisesGrowsAndThins) {
    Smoke smoke;
    tissue::Exchange exchange;
    exchange.gas.push_back({0, 1e-7f, 1e-7f, 373.0f});
    smoke.step(exchange, {Vec3f(0.0f)}, 0, kTick_s);
    exchange.gas.clear();
    ASSERT_FALSE(smoke.particles().empty());
    const SmokeParticle before = smoke.particles()[0];
    for (std::int64_t tick = 1; tick <= 1000; ++tick) smoke.step(exchange, {}, tick, kTick_s);
    const SmokeParticle after = smoke.particles()[0];
    EXPECT_EQ(after.seed, before.seed);
    EXPECT_NEAR(after.age_s, 1.0, 1e-3);
    EXPECT_GT(after.position_m.z, 0.02f);
    EXPECT_LT(after.position_m.z, 0.5f);
    // Variance of a diffusing puff grows by 2 D t.
    const double grown = static_cast<double>(after.radius_m * after.radius_m - before.radius_m * before.radius_m);
    EXPECT_NEAR(grown / (2.0 * 2.5e-5), 1.0, 1e-3);
    EXPECT_LT(optical_depth(after).smoke, optical_depth(before).smoke);
    EXPECT_LT(optical_depth(after).steam / optical_depth(after).smoke,
              optical_depth(before).steam / optical_depth(before).smoke)
        << "fog evaporates, smoke does not";
    // A puff's optical depth, integrated over its picture, is its extinction area.
    const OpticalDepth depth = optical_depth(after);
    const float area = 2.0f * static_cast<float>(M_PI) * after.radius_m * after.radius_m;
    EXPECT_NEAR(depth.smoke * area / (kSmokeExtinction_m2_per_kg * after.smoke), 1.0, 1e-5);
}

TEST(Smoke, SameGasSameSmoke) {
    auto hash_after = [] {
        Smoke smoke;
        for (std::int64_t tick = 0; tick < 3'000; ++tick) burn(smoke, tick, 50e-6);
        EXPECT_GT(smoke.particles().size(), 100u);
        return hash_bytes(smoke.particles().data(), smoke.particles().size() * sizeof(SmokeParticle));
    };
    EXPECT_EQ(hash_after(), hash_after());
}

// Gas at two places far apart does not meet in the middle.
TEST(Smoke, PuffsStayWithTheirSources) {
    Smoke smoke;
    tissue::Exchange exchange;
    exchange.gas.push_back({0, 1e-8f, 1e-8f, 373.0f});
    exchange.gas.push_back({1, 1e-8f, 5e-8f, 373.0f});
    smoke.step(exchange, {Vec3f(-0.02f, 0.0f, 0.0f), Vec3f(0.02f, 0.0f, 0.0f)}, 0, kTick_s);
    ASSERT_EQ(smoke.particles().size(), 2u);
    EXPECT_NEAR(smoke.particles()[0].position_m.x, -0.02f, 1e-3f);
    EXPECT_NEAR(smoke.particles()[1].position_m.x, 0.02f, 1e-3f);
}

TEST(Smoke, NoneWanted) {
    SmokeParameters parameters;
    parameters.max_particles = 0;
    Smoke smoke(parameters);
    for (std::int64_t tick = 0; tick < 100; ++tick) burn(smoke, tick, 1e-3);
    EXPECT_EQ(smoke.particles().size(), 0u);
    EXPECT_NEAR(accounted_kg(smoke), smoke.emitted_kg(), 1e-6 * smoke.emitted_kg());
}

// Differences over a small step: the swirls neither make nor swallow gas, and are smooth across lattice faces.
TEST(Turbulence, HasNoSources) {
    Random random(9);
    double speed = 0.0;
    for (int k = 0; k < 200; ++k) {
        const Vec3f p(random.uniform(-9.0, 9.0), random.uniform(-9.0, 9.0), random.uniform(-9.0, 9.0));
        const float h = 2e-3f;
        float divergence = 0.0f;
        for (int axis = 0; axis < 3; ++axis) {
            Vec3f step(0.0f);
            step[axis] = h;
            divergence += (curl_noise(p + step)[axis] - curl_noise(p - step)[axis]) / (2.0f * h);
        }
        EXPECT_LT(std::abs(divergence), 0.02f);  // float differences over 4e-3, against gradients of about 5
        speed += static_cast<double>(glm::length(curl_noise(p))) / 200.0;
    }
    EXPECT_GT(speed, 0.3);
    EXPECT_LT(speed, 2.0);
}

}  // namespace calot::effects

// Whole burns on the device: the budget closes, and what is left is what the host leaves.

#include "gpu/heat_rig.h"

namespace calot::gpu {
namespace {

/// The burn of thermal's tests with a hot wire on the tissue, on both sides; heat for the first 1.2 of 1.6 s.
struct Burns {
    thermal::HeatRun host;
    GpuHeatRun device;
    explicit Burns(tissue::PhaseModel phase) : host(burning_body({40, 34, 22}, phase)), device(host.model, host.state) {
        host.state.tip.temperature_K = device.state.tip.temperature_K = 380.0;
    }
    void tick() {
        const std::int64_t tick = host.state.tick;
        if (tick >= 1200)
            host.exchange.joule.size = Int3(0);
        else if (tick % 8 == 0)
            burn_spot(host, tick);
        device.follow(host.exchange);
        lay_wire(host.model, host.state, host.exchange);
        lay_wire(device.model, device.state, device.exchange);
        host.tick();
        device.tick();
    }
};

double imbalance_J(const tissue::Model& model, const tissue::State& state) {
    return state.energy_J.delivered - state.energy_J.accounted() - thermal::stored_J(model, state);
}

void expect_alike(double device, double host, double share, const char* what) {
    EXPECT_NEAR(device, host, share * std::abs(host)) << what;
}

void compare_burns(tissue::PhaseModel phase) {
    Burns burns(phase);
    while (burns.host.state.tick < 1600) {
        burns.tick();
        if (burns.host.state.tick % 400 != 0) continue;
        burns.device.fetch();
        const tissue::State &a = burns.device.state, &b = burns.host.state;
        ASSERT_TRUE(a.status.ok);
        EXPECT_LT(std::abs(imbalance_J(burns.device.model, a)), 1e-6 * a.energy_J.delivered);
        ASSERT_GT(b.hexels_burnt, 50);
        // A hexel that is gas goes some ticks earlier or later than on the host.
        std::int64_t differ = 0;
        for (std::size_t w = 0; w < a.hexel_present.words().size(); ++w)
            differ += __builtin_popcountll(a.hexel_present.words()[w] ^ b.hexel_present.words()[w]);
        EXPECT_LE(differ, 3) << "of " << b.hexels_burnt << " at tick " << b.tick;
        const tissue::EnergyBudget &e = a.energy_J, &f = b.energy_J;
        expect_alike(e.delivered, f.delivered, 1e-3, "delivered");
        expect_alike(e.gas, f.gas, 1e-3, "gas");
        expect_alike(e.latent, f.latent, 1e-3, "latent");
        expect_alike(e.surface, f.surface, 1e-3, "surface");
        expect_alike(e.perfusion, f.perfusion, 1e-3, "perfusion");
        EXPECT_NEAR(e.tip, f.tip, 1e-3);
        EXPECT_NEAR(a.tip.temperature_K, b.tip.temperature_K, 0.05);
        const auto injured = thermal::injuries(burns.device.model, a),
                   expected = thermal::injuries(burns.host.model, b);
        for (std::size_t m = 0; m < expected.size(); ++m) {
            const auto damaged = static_cast<double>(expected[m].damaged_hexels);
            EXPECT_NEAR(static_cast<double>(injured[m].damaged_hexels), damaged, 1.0 + 1e-3 * damaged);
            EXPECT_NEAR(injured[m].peak_temperature_K, expected[m].peak_temperature_K, 0.1);
        }
    }
}

TEST(GpuBurn, IsTheHostsWithWaterThenSolids) {
    compare_burns(tissue::PhaseModel::water_then_solids);
}
TEST(GpuBurn, IsTheHostsWithAThreshold) {
    compare_burns(tissue::PhaseModel::threshold);
}

// A device goes on from a state that the host made in the middle of a burn, and the other way round.
TEST(GpuBurn, GoesOnFromAnotherState) {
    Burns burns(tissue::PhaseModel::water_then_solids);
    while (burns.host.state.tick < 400) burns.tick();
    burns.device.state = burns.host.state;
    burns.device.start();
    while (burns.host.state.tick < 480) burns.tick();
    burns.device.fetch();
    EXPECT_LE(std::abs(burns.device.state.hexels_burnt - burns.host.state.hexels_burnt), 3);
    EXPECT_LT(std::abs(imbalance_J(burns.device.model, burns.device.state)),
              1e-6 * burns.device.state.energy_J.delivered);
    burns.host.state = burns.device.state;
    burns.host.start();
    while (burns.host.state.tick < 560) burns.tick();
    burns.device.fetch();
    EXPECT_LE(std::abs(burns.device.state.hexels_burnt - burns.host.state.hexels_burnt), 3);
    EXPECT_LT(std::abs(imbalance_J(burns.host.model, burns.host.state)), 1e-6 * burns.host.state.energy_J.delivered);
}

// The same bytes from run to run.
TEST(GpuBurn, IsDeterministic) {
    std::uint64_t first = 0;
    for (int run = 0; run < 2; ++run) {
        Burns burns(tissue::PhaseModel::water_then_solids);
        while (burns.host.state.tick < 200) burns.tick();
        burns.device.fetch();
        const std::uint64_t hash = tissue::hash(burns.device.state);
        if (run == 0) first = hash;
        EXPECT_EQ(hash, first);
    }
}

}  // namespace
}  // namespace calot::gpu

// The same bytes for any number of threads, whether cold blocks are skipped or not, and from a snapshot.

#include <hwy/targets.h>

#include "calot/base/parallel.h"
#include "thermal/burn_bodies.h"

namespace calot::thermal {

namespace {

constexpr int kTicks = 800;

void expect_same(const tissue::State& a, const tissue::State& b) {
    const auto fields = tissue::fields(const_cast<tissue::State&>(a));
    const auto hash_a = tissue::hash_fields(a), hash_b = tissue::hash_fields(b);
    for (std::size_t k = 0; k < fields.size(); ++k) {
        if (std::string(fields[k].name) == "energy") continue;  // summed over other blocks: see the callers
        EXPECT_EQ(hash_a[k], hash_b[k]) << fields[k].name;
    }
    EXPECT_NEAR(a.energy_J.surface, b.energy_J.surface, 1e-9 * std::abs(a.energy_J.surface));
    EXPECT_NEAR(a.energy_J.gas, b.energy_J.gas, 1e-9 * std::abs(a.energy_J.gas));
}

tissue::State burn(int threads, bool dense = false) {
    const ThreadLimit limit(threads);
    HeatRun run(burn_model());
    run.work.dense = dense;
    while (run.state.tick < kTicks) burn_tick(run);
    return run.state;
}

}  // namespace

TEST(HeatDeterminism, ThreadsGiveTheSameBytes) {
    const std::uint64_t one = tissue::hash(burn(1));
    EXPECT_EQ(tissue::hash(burn(2)), one);
    EXPECT_EQ(tissue::hash(burn(4)), one);
}

TEST(HeatDeterminism, InstructionSetsGiveTheSameBytes) {
    const std::uint64_t widest = tissue::hash(burn(1));
    const std::int64_t all = hwy::SupportedTargets();
    int compared = 0;
    for (std::int64_t target = 1; target > 0 && target <= all; target <<= 1) {
        if ((all & target) == 0) continue;
        hwy::SetSupportedTargetsForTest(target);
        hwy::GetChosenTarget().Update(hwy::SupportedTargets());
        EXPECT_EQ(tissue::hash(burn(1)), widest) << hwy::TargetName(target);
        ++compared;
    }
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    EXPECT_GT(compared, 0);
}

TEST(HeatDeterminism, SkippingColdBlocksChangesNothing) {
    expect_same(burn(1, false), burn(1, true));
}

TEST(HeatDeterminism, SnapshotsGoOnWithTheSameBytes) {
    HeatRun run(burn_model());
    while (run.state.tick < kTicks) {
        burn_tick(run);
        if (run.state.tick % 40 == 8) run.start();  // as after loading: only State is known, and the heat it gets
    }
    EXPECT_EQ(tissue::hash(run.state), tissue::hash(burn(1)));
}

TEST(HeatDeterminism, OnlyWarmBlocksWork) {
    HeatRun run(burn_model({120, 100, 60}));
    while (run.state.tick < 100) burn_tick(run);
    EXPECT_GT(run.work.active.count(), 0);
    EXPECT_LT(run.work.active.count(), run.work.populated.count() / 4);
}

namespace {

/// Random states, boiling, dry and spent hexels and holes among them; one step by both kernels.
void compare_kernels(tissue::PhaseModel phase, std::uint64_t seed) {
    tissue::Model model = burn_model({33, 29, 21}, phase);
    model.thermal.refresh_ticks = 1;
    HeatRun wide(std::move(model));
    Random random(seed);
    const Lattice& lattice = wide.model.hexels;
    for (std::int64_t i = lattice.first; i < lattice.last; ++i) {
        const auto h = static_cast<std::size_t>(i);
        if (!wide.state.hexel_present.test(i)) continue;
        if (random.uniform() < 0.1) wide.state.hexel_present.clear(i);
        if (random.uniform() < 0.3) wide.state.water_kg_per_m3[h] *= static_cast<float>(random.uniform());
        if (random.uniform() < 0.1) wide.state.water_kg_per_m3[h] = 0.0f;
        wide.state.enthalpy_J_per_m3[h] = static_cast<float>(random.uniform(-2e7, 6e8));
    }
    wide.start();
    HeatRun plain(wide.model);
    plain.state = wide.state;
    plain.start();
    plain.work.scalar = true;
    for (HeatRun* run : {&wide, &plain}) {
        heat_spot(*run, 0);
        run->exchange.gas.clear();
        conduct(run->model, run->state, run->exchange, run->work);
    }
    ASSERT_EQ(wide.exchange.gas.size(), plain.exchange.gas.size());
    for (std::size_t k = 0; k < wide.exchange.gas.size(); ++k) {
        EXPECT_EQ(wide.exchange.gas[k].hexel, plain.exchange.gas[k].hexel);
        EXPECT_NEAR(wide.exchange.gas[k].steam_kg, plain.exchange.gas[k].steam_kg, 1e-13);
    }
    for (std::int64_t i = lattice.first; i < lattice.last; ++i) {
        const auto h = static_cast<std::size_t>(i);
        if (!wide.state.hexel_present.test(i)) continue;
        // Kernels differ in the order of sums within a hexel: a few of the last digits of H, w and T.
        ASSERT_NEAR(wide.state.enthalpy_J_per_m3[h], plain.state.enthalpy_J_per_m3[h], 600.0f) << i;
        ASSERT_NEAR(wide.state.water_kg_per_m3[h], plain.state.water_kg_per_m3[h], 2e-4f) << i;
        ASSERT_NEAR(wide.work.temperature_K[h], plain.work.temperature_K[h], 4e-4f) << i;
        ASSERT_NEAR(wide.state.peak_temperature_K[h], plain.state.peak_temperature_K[h], 4e-4f) << i;
        ASSERT_NEAR(wide.state.damage[h], plain.state.damage[h], 1e-6f + 2e-4f * plain.state.damage[h]) << i;
    }
    const tissue::EnergyBudget &a = wide.state.energy_J, &b = plain.state.energy_J;
    EXPECT_NEAR(a.delivered, b.delivered, 1e-7 * std::abs(b.delivered));  // wide sums are of floats
    EXPECT_NEAR(a.surface, b.surface, 1e-5 * std::abs(b.surface));
    EXPECT_NEAR(a.perfusion, b.perfusion, 1e-5 * std::abs(b.perfusion));
    EXPECT_NEAR(a.gas, b.gas, 1e-5 * std::abs(b.gas));
    EXPECT_NEAR(a.latent, b.latent, 1e-5 * std::abs(b.latent));
    remove_vaporised(wide.model, wide.state, wide.exchange, wide.work);
    remove_vaporised(plain.model, plain.state, plain.exchange, plain.work);
    EXPECT_FALSE(wide.exchange.removed_hexels.empty());
    EXPECT_EQ(wide.exchange.removed_hexels, plain.exchange.removed_hexels);
}

}  // namespace

TEST(HeatKernels, WideIsScalarOnRandomStates) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) compare_kernels(tissue::PhaseModel::water_then_solids, seed);
}
TEST(HeatKernels, WideIsScalarWithAThreshold) {
    compare_kernels(tissue::PhaseModel::threshold, 11);
}

}  // namespace calot::thermal

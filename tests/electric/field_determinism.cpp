// The same bytes for any number of threads, for every instruction set, and from the plain loops.

#include <cmath>

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include "calot/base/hash.h"
#include "calot/base/parallel.h"
#include "calot/base/random.h"
#include "calot/validation/electric_rig.h"

namespace calot::electric {

namespace {

/// Hash of potential and heat after two solves of a block with random holes and conductivities over four decades.
std::uint64_t hash_of_rough_solve(int window, const Kernels& kernels) {
    tissue::Model model = tissue::sample(anatomy::make_block({.size_m = Vec3(0.0312, 0.0264, 0.0192)}), {});
    model.electric.window_cells = window;
    Rig rig(std::move(model), kernels);
    Random random(5);
    for (std::int64_t hexel = rig.model.hexels.first; hexel < rig.model.hexels.last; ++hexel) {
        rig.work->hexel_conductivity_S_per_m[static_cast<std::size_t>(hexel)] *=
            static_cast<float>(std::pow(10.0, random.uniform(-4.0, 0.0)));
        if (random.uniform() < 0.2 && rig.state.hexel_present.test(hexel)) rig.state.hexel_present.clear(hexel);
        // Some hexels are warm, some of them have lost water.
        const auto h = static_cast<std::size_t>(hexel);
        if (random.uniform() < 0.3) rig.state.enthalpy_J_per_m3[h] = static_cast<float>(random.uniform(0.0, 3e8));
        if (random.uniform() < 0.1) rig.state.water_kg_per_m3[h] *= static_cast<float>(random.uniform());
    }
    for (int x = 20; x < 30; ++x)
        for (int z = 33; z < 36; ++z) rig.touch({x, 22, z});
    rig.solve();
    rig.exchange.near.resize(9);  // the window follows what is left of the contact
    rig.solve();
    EXPECT_GT(rig.state.generator.power_W, 0.0);
    const std::uint64_t field = hash_bytes(rig.state.potential.data(), rig.state.potential.size() * sizeof(float));
    return hash_bytes(rig.state.joule_S_per_m3.data(), rig.state.joule_S_per_m3.size() * sizeof(float), field) ^
           hash_bytes(&rig.state.generator, sizeof(rig.state.generator)) ^
           hash_bytes(&rig.state.stray, sizeof(rig.state.stray));
}

}  // namespace

TEST(FieldDeterminism, AnyNumberOfThreads) {
    std::uint64_t one = 0;
    for (const int threads : {1, 2, 4}) {
        const ThreadLimit limit(threads);
        const std::uint64_t hash = hash_of_rough_solve(48, wide_kernels());
        if (threads == 1) one = hash;
        EXPECT_EQ(hash, one) << threads << " threads";
    }
}

// Odd and even windows, so that rows end inside and at the end of a vector and aggregates are cut.
TEST(FieldDeterminism, PlainLoopsAndEveryInstructionSetAgree) {
    for (const int window : {32, 27, 40}) {
        const std::uint64_t plain = hash_of_rough_solve(window, reference_kernels());
        for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
            hwy::SetSupportedTargetsForTest(target);
            EXPECT_EQ(hash_of_rough_solve(window, wide_kernels()), plain)
                << hwy::TargetName(target) << ", window " << window;
            hwy::SetSupportedTargetsForTest(0);
        }
    }
}

}  // namespace calot::electric

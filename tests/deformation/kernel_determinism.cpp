// The production kernels against the scalar reference, against themselves on other instruction sets, and over threads.

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include "calot/base/hash.h"
#include "calot/base/parallel.h"
#include "calot/deformation/kernel.h"
#include "calot/deformation/stable_mass.h"
#include "calot/validation/elastic_rig.h"

namespace calot::deformation::rig {

using tissue::ElasticLaw;

namespace {

Body random_body(ElasticLaw law, double severed, const Int3& size = {9, 7, 8}) {
    tissue::Model model = block(size, true);
    model.deformation.law = law;
    model.deformation.volume_stiffness_Pa = 4e3;
    model.deformation.gravity_m_per_s2 = Vec3(1.0, -9.81, 2.0);
    Body body(std::move(model));
    wound(body, 0.3, severed, 3);
    shake(body, 0.03, 0.05, 4);
    return body;
}

std::uint64_t hash_of(Body& body) {
    std::uint64_t hash = tissue::hash(body.state);
    for (const auto& component : body.work.gradient)
        hash = hash_bytes(component.data(), component.size() * sizeof(float), hash);
    for (const auto& component : body.work.moment_stress)
        hash = hash_bytes(component.data(), component.size() * sizeof(float), hash);
    return hash;
}

}  // namespace

// Float rounding in different orders: some tens of roundings of 6e-8 relative to the largest value.
TEST(Kernel, AgreesWithTheScalarReference) {
    constexpr double kTolerance = 1e-5;
    for (const ElasticLaw law : {ElasticLaw::stable_neo_hookean, ElasticLaw::saint_venant_kirchhoff})
        for (const double severed : {0.0, 0.3, 0.5}) {
            Body body = random_body(law, severed);
            raise_masses(body.model, body.state, body.work);  // as a tick does first
            Reference<double> reference(body.model, body.state, body.work);
            reference.update_gradients();
            double stress_error = 0.0, stress = 0.0, gradient_error = 0.0;
            for (std::int64_t p = body.model.phyxels.first; p < body.model.phyxels.last; ++p) {
                const auto i = static_cast<std::size_t>(p);
                for (int r = 0; r < 3; ++r)
                    for (int c = 0; c < 3; ++c) {
                        const auto e = static_cast<std::size_t>(3 * r + c);
                        const double m = reference.moment_stress[i][c][r], g = reference.gradient[i][c][r];
                        stress_error =
                            std::max(stress_error, std::abs(m - static_cast<double>(body.work.moment_stress[e][i])));
                        stress = std::max(stress, std::abs(m));
                        gradient_error =
                            std::max(gradient_error, std::abs(g - static_cast<double>(body.work.gradient[e][i])));
                    }
            }
            EXPECT_LT(gradient_error, kTolerance);
            EXPECT_LT(stress_error, kTolerance * stress);

            const double dt = static_cast<double>(body.work.substep_s);
            for (int k = 0; k < body.work.substeps; ++k) reference.advance(dt);
            body.tick();
            double error = 0.0, fastest = 0.0;
            body.for_each_phyxel([&](std::int64_t p) {
                const Vec3 v = reference.velocity_m_per_s[static_cast<std::size_t>(p)];
                error = std::max(error, glm::length(v - body.velocity_m_per_s(p)));
                fastest = std::max(fastest, glm::length(v));
            });
            EXPECT_GT(fastest, 1e-3);
            EXPECT_LT(error, kTolerance * fastest) << "severed " << severed;
        }
}

TEST(Kernel, GivesTheSameBytesOnEveryInstructionSet) {
    std::uint64_t expected = 0;
    for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
        hwy::SetSupportedTargetsForTest(target);
        hwy::GetChosenTarget().Update(hwy::SupportedTargets());
        Body body = random_body(ElasticLaw::stable_neo_hookean, 0.2);
        for (int k = 0; k < 5; ++k) body.tick();
        if (expected == 0) expected = hash_of(body);
        EXPECT_EQ(hash_of(body), expected) << hwy::TargetName(target);
    }
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

TEST(Kernel, OnePassOverMemoryGivesTheBytesOfTwo) {
    Body apart = random_body(ElasticLaw::stable_neo_hookean, 0.1, {26, 24, 26}), together(apart);
    const auto view = KernelView::make(apart.model, apart.state, apart.work);
    sweep_gradients(view, apart.work.groups);
    sweep_motion(view, apart.work.groups);

    const auto other = KernelView::make(together.model, together.state, together.work);
    const Groups all(together.work.groups);
    const auto count = static_cast<std::int64_t>(all.size());
    constexpr std::int64_t kChunk = 300;
    std::vector<GroupRange> inner;
    for (std::int64_t low = 0; low < count; low += kChunk) {
        const GroupRange gradients{low, std::min(low + kChunk, count)};
        inner.push_back(inner_groups(other, all, gradients));
        sweep_both(other, all, gradients, inner.back());
    }
    ASSERT_GE(inner.size(), 3u);
    for (std::size_t k = 1; k < inner.size(); ++k) {
        const std::int64_t low = inner[k - 1].end, high = inner[k].begin;
        EXPECT_LT(low, high);
        sweep_motion(other, all.subspan(static_cast<std::size_t>(low), static_cast<std::size_t>(high - low)));
    }
    EXPECT_EQ(hash_of(together), hash_of(apart));
}

TEST(Integrate, GivesTheSameBytesForAnyNumberOfThreads) {
    std::uint64_t expected = 0;
    for (const int threads : {1, 2, 4}) {
        const ThreadLimit limit(threads);
        Body body = random_body(ElasticLaw::stable_neo_hookean, 0.1, {26, 24, 26});
        ASSERT_GT(body.work.groups.size(), 1024u);  // several chunks
        for (int k = 0; k < 5; ++k) body.tick();
        if (expected == 0) expected = hash_of(body);
        EXPECT_EQ(hash_of(body), expected) << threads << " threads";
    }
}

}  // namespace calot::deformation::rig

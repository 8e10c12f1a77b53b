// The scalar reference against its own energy and against closed forms, in double precision.

#include <gtest/gtest.h>

#include "calot/validation/elastic_rig.h"

namespace calot::deformation::rig {

using tissue::ElasticLaw;

class EveryLaw : public testing::TestWithParam<ElasticLaw> {
  protected:
    void set_law(tissue::Model& model) const {
        model.deformation.law = GetParam();
        model.deformation.volume_stiffness_Pa = 4e3;
    }
};
INSTANTIATE_TEST_SUITE_P(Reference, EveryLaw,
                         testing::Values(ElasticLaw::stable_neo_hookean, ElasticLaw::saint_venant_kirchhoff));

// Central differences at h = 1e-5 spacings: truncation ~h^2 and rounding ~1e-16 U / h stay below 1e-7 of the force.
TEST_P(EveryLaw, ForceIsMinusTheDerivativeOfEnergy) {
    tissue::Model model = block({4, 3, 4}, true);
    set_law(model);
    for (const double severed : {0.0, 0.2, 0.5}) {
        Body body(model);
        wound(body, 0.3, severed, 7);
        shake(body, 0.15, 0.7, 11);
        Reference<double> reference(body.model, body.state, body.work);
        reference.update_gradients();
        reference.update_forces();
        double error = 0.0, scale = 0.0;
        const double h = 1e-5 * kSpacing_m;
        body.for_each_phyxel([&](std::int64_t p) {
            const auto i = static_cast<std::size_t>(p);
            for (int r = 0; r < 3; ++r) {
                const Vec3 force = reference.force_N[i];
                const double there = reference.displacement_m[i][r];
                double energy[2];
                for (int side = 0; side < 2; ++side) {
                    reference.displacement_m[i][r] = there + (side == 0 ? -h : h);
                    reference.update_gradients();
                    energy[side] = reference.energy_J();
                }
                reference.displacement_m[i][r] = there;
                error = std::max(error, std::abs(force[r] + (energy[1] - energy[0]) / (2.0 * h)));
                scale = std::max(scale, std::abs(force[r]));
            }
        });
        EXPECT_LT(error, 1e-6 * scale) << "with a share of " << severed << " of the links severed";
    }
}

TEST_P(EveryLaw, RigidMotionCostsNothing) {
    tissue::Model model = block({4, 3, 4}, false);
    set_law(model);
    Body body(model);
    wound(body, 0.2, 0.2, 5);
    Reference<double> reference(body.model, body.state, body.work);
    // What the same body feels when it is strained by 1 %, for scale.
    auto move = [&](const Mat3& f, const Vec3& shift) {
        body.for_each_phyxel([&](std::int64_t p) {
            const Vec3 x = body.model.phyxels.centre_m(p);
            reference.displacement_m[static_cast<std::size_t>(p)] = f * x - x + shift;
        });
        reference.update_gradients();
        reference.update_forces();
        double largest = 0.0;
        for (const Vec3& f_N : reference.force_N) largest = std::max(largest, glm::length(f_N));
        return largest;
    };
    const double strained = move(Mat3(1.01), Vec3(0.0));
    EXPECT_LT(move(Mat3(1.0), Vec3(0.01, -0.02, 0.03)), 1e-10 * strained);
    for (const double angle : {0.1, 1.0, 3.0}) {
        const Mat3 turn = glm::mat3_cast(glm::angleAxis(angle, glm::normalize(Vec3(3, -1, 2))));
        EXPECT_LT(move(turn, Vec3(0.01)), 1e-10 * strained) << angle;
        EXPECT_LT(std::abs(reference.energy_J()), 1e-15);
    }
}

// Patch test: any affine deformation is met exactly, and leaves phyxels with all their neighbours in equilibrium.
TEST_P(EveryLaw, AffineDeformationIsExact) {
    tissue::Model model = block({5, 5, 5}, false);
    set_law(model);
    Body body(model);
    Reference<double> reference(body.model, body.state, body.work);
    const Mat3 g(0.05, 0.10, -0.08, 0.20, -0.10, 0.02, -0.04, 0.07, 0.15);
    body.for_each_phyxel([&](std::int64_t p) {
        reference.displacement_m[static_cast<std::size_t>(p)] = g * body.model.phyxels.centre_m(p);
    });
    reference.update_gradients();
    reference.update_forces();
    double interior = 0.0, boundary = 0.0;
    body.for_each_phyxel([&](std::int64_t p) {
        const auto i = static_cast<std::size_t>(p);
        for (int c = 0; c < 3; ++c) EXPECT_LT(glm::length(reference.gradient[i][c] - g[c]), 1e-12);
        int links = 0;
        bool deep = true;  // all neighbours have all their neighbours too, and so the same volume and moments
        for_each_link(model.phyxels, body.state.links, p, [&](std::int64_t other, const Int3&, double) {
            ++links;
            int of_other = 0;
            for_each_link(model.phyxels, body.state.links, other,
                          [&](std::int64_t, const Int3&, double) { ++of_other; });
            deep &= of_other == 18;
        });
        double& largest = links == 18 && deep ? interior : boundary;
        largest = std::max(largest, glm::length(reference.force_N[i]));
    });
    EXPECT_GT(boundary, 0.0);
    EXPECT_LT(interior, 1e-12 * boundary);
}

TEST_P(EveryLaw, LinearisesToLame) {
    const double mu = 1700.0, lambda = 15500.0, size = 1e-6;
    const Law<double> law{GetParam(), 0.0};
    const Mat3 g = size * Mat3(0.3, 0.1, -0.8, 0.2, -0.6, 0.2, -0.4, 0.7, 0.5);
    const Mat3 strain = 0.5 * (g + glm::transpose(g));
    const Mat3 expected = 2.0 * mu * strain + Mat3(lambda * (g[0][0] + g[1][1] + g[2][2]));
    const Mat3 stress = law.stress_Pa(g, mu, lambda);
    for (int c = 0; c < 3; ++c)  // second order terms are size^2 lambda
        EXPECT_LT(glm::length(stress[c] - expected[c]), 10.0 * size * size * lambda);
}

}  // namespace calot::deformation::rig

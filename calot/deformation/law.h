#pragma once
// Elastic laws, plainly (docs/physics.md section 2). kernel_simd.cpp has them again, a vector at a time.
//
// Both are written in G = F - 1 and not in F, so that small strains do not drown in the rounding of F.

#include "calot/base/vec.h"
#include "calot/tissue/model.h"

namespace calot::deformation {

template <class Real>
struct Law {
    using Mat = glm::mat<3, 3, Real>;

    tissue::ElasticLaw kind = tissue::ElasticLaw::stable_neo_hookean;
    Real volume_stiffness_Pa = 0;

    /// J - 1 = tr G + tr cof G + det G.
    static Real volume_change(const Mat& g, const Mat& cofactor_g) {
        return trace(g) + trace(cofactor_g) + glm::dot(g[0], cofactor_g[0]);
    }
    static Real trace(const Mat& a) { return a[0][0] + a[1][1] + a[2][2]; }
    static Mat cofactor(const Mat& a) {
        return Mat(glm::cross(a[1], a[2]), glm::cross(a[2], a[0]), glm::cross(a[0], a[1]));
    }

    /// First Piola-Kirchhoff stress P(1 + G) [Pa].
    Mat stress_Pa(const Mat& g, Real mu, Real lambda) const {
        const Mat cofactor_g = cofactor(g);
        const Real change = volume_change(g, cofactor_g);
        // F - cof F = G + G^T - tr(G) 1 - cof G
        const Mat difference = g + glm::transpose(g) - Mat(trace(g)) - cofactor_g;
        const Mat cofactor_f = Mat(Real(1)) + g - difference;
        if (kind == tissue::ElasticLaw::stable_neo_hookean) {
            // P = mu F + l (J - 1 - mu/l) cof F, l = lambda + mu (Smith et al. 2018): Lame's constants at small strain.
            return mu * difference + ((lambda + mu) * change) * cofactor_f;
        }
        // Saint Venant-Kirchhoff: P = F (lambda tr(E) 1 + 2 mu E) + k_v (J - 1) cof F (Pan et al. 2019, Eq. 5-8).
        // Departure: E = (F^T F - 1) / 2; F^T F - 1, as printed, is four times too stiff.
        const Mat strain = Real(0.5) * (g + glm::transpose(g) + glm::transpose(g) * g);
        const Mat second = Mat(lambda * trace(strain)) + (2 * mu) * strain;
        return second + g * second + (volume_stiffness_Pa * change) * cofactor_f;
    }

    /// Energy per rest volume [J/m^3], zero at rest; stress_Pa is its derivative.
    Real energy_J_per_m3(const Mat& g, Real mu, Real lambda) const {
        const Mat cofactor_g = cofactor(g);
        const Real change = volume_change(g, cofactor_g);
        Real squares = 0;
        for (int c = 0; c < 3; ++c) squares += glm::dot(g[c], g[c]);
        if (kind == tissue::ElasticLaw::stable_neo_hookean) {
            // mu/2 (I_C - 3) + l/2 (J - 1)^2 - mu (J - 1)
            const Real invariant = 2 * trace(g) + squares;
            return mu * (Real(0.5) * invariant - change) + Real(0.5) * (lambda + mu) * change * change;
        }
        const Mat strain = Real(0.5) * (g + glm::transpose(g) + glm::transpose(g) * g);
        Real strain_squares = 0;
        for (int c = 0; c < 3; ++c) strain_squares += glm::dot(strain[c], strain[c]);
        return Real(0.5) * lambda * trace(strain) * trace(strain) + mu * strain_squares +
               Real(0.5) * volume_stiffness_Pa * change * change;
    }
};

}  // namespace calot::deformation

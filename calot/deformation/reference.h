#pragma once
// The plain reference of the elastic kernels: one phyxel at a time, in float or double, no tricks. Tests compare the
// production kernels with it, and it with the derivatives of its own energy.
//
//   B_i = sum_j w u_ij X_ij^T        G_i = B_i A_i^-1        M_i = v_i P(1 + G_i) A_i^-1 - kappa_i G_i
//   f_i = sum_j w [ (M_i + M_j) X_ij + (kappa_i + kappa_j) u_ij ]
//
// f_i is minus the derivative by u_i of
//
//   U = sum_i [ v_i Psi(1 + G_i) + kappa_i / 2 sum_j w |u_ij - G_i X_ij|^2 ]
//
// where ghosts are images of phyxels (ghosts.h); (the second term needs no derivative of G: G_i is the very matrix that
// makes it least). Departure from Pan et al. 2019, Eq. 4: the outer product is transposed there, which does not survive
// rotation.

#include <algorithm>
#include <cmath>
#include <vector>

#include "calot/deformation/law.h"
#include "calot/deformation/links.h"
#include "calot/deformation/rest.h"
#include "calot/deformation/work.h"

namespace calot::deformation {

template <class Real>
class Reference {
  public:
    using Vec = glm::vec<3, Real>;
    using Mat = glm::mat<3, 3, Real>;

    Reference(const tissue::Model& model, const tissue::State& state, const Work& work)
        : model_(model),
          links_(state.links),
          mirrors_(work.mirrors),
          face_m_(work.face_m),
          law_{model.deformation.law, static_cast<Real>(model.deformation.volume_stiffness_Pa)},
          displacement_m(static_cast<std::size_t>(model.phyxels.cells), Vec(0)),
          velocity_m_per_s(displacement_m),
          force_N(displacement_m),
          gradient(displacement_m.size(), Mat(Real(0))),
          moment_stress(gradient),
          inverse_mass_per_kg(displacement_m.size(), 0),
          gravity_share(inverse_mass_per_kg),
          rest(displacement_m.size()) {
        for (std::int64_t p = model.phyxels.first; p < model.phyxels.last; ++p) {
            const auto cell = static_cast<std::size_t>(p);
            rest[cell] = phyxel_rest(model, state, work, p);
            inverse_mass_per_kg[cell] = static_cast<Real>(work.inverse_mass_per_kg[cell]);
            gravity_share[cell] = static_cast<Real>(work.gravity_share[cell]);
            for (int axis = 0; axis < 3; ++axis) {
                displacement_m[cell][axis] = static_cast<Real>(state.displacement_m[axis][cell]);
                velocity_m_per_s[cell][axis] = static_cast<Real>(state.velocity_m_per_s[axis][cell]);
            }
        }
    }

    /// Displacements of ghosts from those of the phyxels, then G and M of all from displacements.
    void update_gradients() {
        for (std::size_t n = 0; n < mirrors_.size(); ++n) {
            const Mirror& mirror = mirrors_[n];
            const Vec face(face_m_[0][n], face_m_[1][n], face_m_[2][n]);
            Vec sum(0);
            for (int k = 0; k < mirror.count; ++k) sum += displacement_m[mirrored(mirror, k)];
            displacement_m[static_cast<std::size_t>(mirror.ghost)] =
                mirror.count > 0 ? Real(2) * face - sum / static_cast<Real>(mirror.count) : face;
        }
        for (std::int64_t p = model_.phyxels.first; p < model_.phyxels.last; ++p) {
            const auto i = static_cast<std::size_t>(p);
            const Mat inverse(rest[i].moment_inverse_per_m2);
            Mat b(Real(0));
            for_each_link(model_.phyxels, links_, p, [&](std::int64_t other, const Int3& step, double w) {
                const Vec u = displacement_m[static_cast<std::size_t>(other)] - displacement_m[i];
                b += static_cast<Real>(w) * glm::outerProduct(u, x(step));
            });
            const Mat g = b * inverse;
            const Mat stress =
                law_.stress_Pa(g, static_cast<Real>(rest[i].mu_Pa), static_cast<Real>(rest[i].lambda_Pa));
            gradient[i] = g;
            moment_stress[i] = static_cast<Real>(rest[i].volume_m3) * stress * inverse - hourglass(i) * g;
        }
    }

    /// Elastic and hourglass forces from displacements, G and M.
    void update_forces() {
        for (std::int64_t p = model_.phyxels.first; p < model_.phyxels.last; ++p) {
            const auto i = static_cast<std::size_t>(p);
            Vec f(0);
            for_each_link(model_.phyxels, links_, p, [&](std::int64_t other, const Int3& step, double w) {
                const auto j = static_cast<std::size_t>(other);
                f += static_cast<Real>(w) * ((moment_stress[i] + moment_stress[j]) * x(step) +
                                             (hourglass(i) + hourglass(j)) * (displacement_m[j] - displacement_m[i]));
            });
            force_N[i] = f;
        }
        for (const Mirror& mirror : mirrors_) {
            Vec& f = force_N[static_cast<std::size_t>(mirror.ghost)];
            for (int k = 0; k < mirror.count; ++k) force_N[mirrored(mirror, k)] -= f / static_cast<Real>(mirror.count);
            f = Vec(0);
        }
    }

    /// U [J]; gradients must be current.
    Real energy_J() const {
        Real total = 0;
        for (std::int64_t p = model_.phyxels.first; p < model_.phyxels.last; ++p) {
            const auto i = static_cast<std::size_t>(p);
            Real misfit = 0;
            for_each_link(model_.phyxels, links_, p, [&](std::int64_t other, const Int3& step, double w) {
                const Vec d =
                    displacement_m[static_cast<std::size_t>(other)] - displacement_m[i] - gradient[i] * x(step);
                misfit += static_cast<Real>(w) * glm::dot(d, d);
            });
            const Real density = law_.energy_J_per_m3(gradient[i], static_cast<Real>(rest[i].mu_Pa),
                                                      static_cast<Real>(rest[i].lambda_Pa));
            total += static_cast<Real>(rest[i].volume_m3) * density + Real(0.5) * hourglass(i) * misfit;
        }
        return total;
    }

    /// One substep without contact: forces, velocities, displacements, gradients (as integrate.cpp does it).
    void advance(Real dt_s) {
        update_forces();
        const Real decay = static_cast<Real>(std::exp(-model_.deformation.damping_per_s * static_cast<double>(dt_s)));
        const Vec gravity(model_.deformation.gravity_m_per_s2);
        for (std::size_t i = 0; i < rest.size(); ++i) {
            if (inverse_mass_per_kg[i] == 0) continue;
            const Vec acceleration = inverse_mass_per_kg[i] * force_N[i] + gravity_share[i] * gravity;
            velocity_m_per_s[i] = decay * (velocity_m_per_s[i] + dt_s * acceleration);
            displacement_m[i] += dt_s * velocity_m_per_s[i];
        }
        update_gradients();
    }

  private:
    static std::size_t mirrored(const Mirror& mirror, int k) {
        return static_cast<std::size_t>(mirror.phyxel[static_cast<std::size_t>(k)]);
    }
    Vec x(const Int3& step) const { return static_cast<Real>(model_.phyxels.spacing_m) * Vec(step); }
    Real hourglass(std::size_t i) const { return static_cast<Real>(rest[i].hourglass_N_per_m); }

    const tissue::Model& model_;
    const std::array<BitArray, 9>& links_;
    const std::vector<Mirror>& mirrors_;
    const std::array<std::vector<float>, 3>& face_m_;
    Law<Real> law_;

  public:
    // [phyxels.cells]
    std::vector<Vec> displacement_m, velocity_m_per_s, force_N;
    std::vector<Mat> gradient, moment_stress;
    std::vector<Real> inverse_mass_per_kg, gravity_share;
    std::vector<PhyxelRest> rest;
};

}  // namespace calot::deformation

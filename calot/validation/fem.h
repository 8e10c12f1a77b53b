#pragma once
// Small-strain finite elements to compare with: a box of equal hexahedra, trilinear, with the B-bar (mean dilatation)
// method against volumetric locking (Hughes 1980), held on its z = 0 face, loaded by a uniform body force or pressed by
// a rigid paraboloid from above. With `quarter`, the planes x = 0 and y = 0 are planes of symmetry.

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <Eigen/Sparse>
#include <Eigen/SparseCholesky>

#include "calot/base/vec.h"

namespace calot::deformation::rig {

class ClampedBox {
  public:
    /// A box of `size_m` in `elements` hexahedra, one corner at the origin. body_force_N_per_m3 = density * gravity.
    ClampedBox(const Vec3& size_m, const Int3& elements, double youngs_Pa, double poisson,
               const Vec3& body_force_N_per_m3, bool quarter = false)
        : size_(size_m), elements_(elements), quarter_(quarter) {
        const double mu = youngs_Pa / (2.0 * (1.0 + poisson));
        const double lambda = 2.0 * mu * poisson / (1.0 - 2.0 * poisson);
        const Vec3 edge = size_ / Vec3(elements_);
        const Eigen::Matrix<double, 24, 24> stiffness = element_stiffness(edge, mu, lambda);
        const int free_nodes = (elements_.x + 1) * (elements_.y + 1) * elements_.z;
        Eigen::VectorXd load = Eigen::VectorXd::Zero(3 * free_nodes);
        std::vector<Eigen::Triplet<double>> entries;
        for (int z = 0; z < elements_.z; ++z)
            for (int y = 0; y < elements_.y; ++y)
                for (int x = 0; x < elements_.x; ++x)
                    for (int a = 0; a < 8; ++a) {
                        const Int3 row_node = Int3(x, y, z) + corner(a);
                        const int row = unknown(row_node);
                        if (row < 0) continue;
                        for (int r = 0; r < 3; ++r)
                            if (!fixed(row_node, r)) load[row + r] += body_force_N_per_m3[r] * edge.x * edge.y * edge.z / 8.0;
                        for (int b = 0; b < 8; ++b) {
                            const Int3 column_node = Int3(x, y, z) + corner(b);
                            const int column = unknown(column_node);
                            if (column < 0 || column > row) continue;  // lower triangle, in blocks
                            for (int r = 0; r < 3; ++r)
                                for (int c = 0; c < 3; ++c)
                                    if ((!fixed(row_node, r) && !fixed(column_node, c)) || row + r == column + c)
                                        entries.emplace_back(row + r, column + c, stiffness(3 * a + r, 3 * b + c));
                        }
                    }
        Eigen::SparseMatrix<double> matrix(3 * free_nodes, 3 * free_nodes);
        matrix.setFromTriplets(entries.begin(), entries.end());
        solver_.compute(matrix);
        solution_ = solver_.solve(load);
    }

    /// Force [N] on the quarter from a rigid paraboloid z = x^2 + y^2 / (2 radius), its apex `depth_m` below the top:
    /// without friction, 0 <= force and 0 <= gap at every node of the top within `reach_m`, one of them zero.
    double press(double radius_m, double depth_m, double reach_m) const {
        std::vector<int> rows;
        std::vector<double> gap;
        for (int y = 0; y <= elements_.y; ++y)
            for (int x = 0; x <= elements_.x; ++x) {
                const Vec3 at = size_ / Vec3(elements_) * Vec3(x, y, 0);
                if (glm::length(at) > reach_m) continue;
                rows.push_back(unknown(Int3(x, y, elements_.z)) + 2);
                gap.push_back(glm::dot(at, at) / (2.0 * radius_m) - depth_m);
            }
        const auto n = static_cast<Eigen::Index>(rows.size());
        Eigen::MatrixXd compliance(n, n);
        for (Eigen::Index k = 0; k < n; ++k) {
            const Eigen::VectorXd u =
                solver_.solve(Eigen::VectorXd::Unit(solution_.size(), rows[static_cast<std::size_t>(k)]));
            for (Eigen::Index j = 0; j < n; ++j) compliance(j, k) = u[rows[static_cast<std::size_t>(j)]];
        }
        Eigen::VectorXd force = Eigen::VectorXd::Zero(n);
        for (int sweep = 0; sweep < 4000; ++sweep)  // projected Gauss-Seidel
            for (Eigen::Index k = 0; k < n; ++k) {
                const double open = gap[static_cast<std::size_t>(k)] + compliance.row(k).dot(force);
                force[k] = std::max(0.0, force[k] - open / compliance(k, k));
            }
        return force.sum();
    }

    Vec3 displacement_m(const Vec3& position_m) const {
        const Vec3 at = position_m / size_ * Vec3(elements_);
        const Int3 low = glm::clamp(Int3(glm::floor(at)), Int3(0), elements_ - 1);
        const Vec3 t = at - Vec3(low);
        Vec3 sum(0.0);
        for (int a = 0; a < 8; ++a) {
            const Int3 c = corner(a);
            const int row = unknown(low + c);
            if (row < 0) continue;
            const double weight = (c.x ? t.x : 1.0 - t.x) * (c.y ? t.y : 1.0 - t.y) * (c.z ? t.z : 1.0 - t.z);
            sum += weight * Vec3(solution_[row], solution_[row + 1], solution_[row + 2]);
        }
        return sum;
    }

  private:
    static Int3 corner(int a) { return Int3(a & 1, (a >> 1) & 1, a >> 2); }
    /// First of the three unknowns of a node, -1 where it is held.
    int unknown(const Int3& node) const {
        if (node.z == 0) return -1;
        return 3 * (node.x + (elements_.x + 1) * (node.y + (elements_.y + 1) * (node.z - 1)));
    }
    /// Whether symmetry holds a component of a node.
    bool fixed(const Int3& node, int axis) const { return quarter_ && axis < 2 && node[axis] == 0; }
    static std::array<Vec3, 8> gradients_at(const Vec3& edge, const Vec3& t) {
        std::array<Vec3, 8> gradients;
        for (int a = 0; a < 8; ++a) {
            const Vec3 sign = 2.0 * Vec3(corner(a)) - 1.0;
            const Vec3 n = 0.5 + sign * (t - 0.5);
            gradients[static_cast<std::size_t>(a)] = sign * Vec3(n.y * n.z, n.x * n.z, n.x * n.y) / edge;
        }
        return gradients;
    }
    static Eigen::Matrix<double, 24, 24> element_stiffness(const Vec3& edge, double mu, double lambda) {
        const std::array<Vec3, 8> centre = gradients_at(edge, Vec3(0.5));  // = the mean over a box
        Eigen::Matrix<double, 24, 24> sum = Eigen::Matrix<double, 24, 24>::Zero();
        const double offset = 0.5 / std::sqrt(3.0);
        for (int point = 0; point < 8; ++point) {
            const std::array<Vec3, 8> gradients = gradients_at(edge, 0.5 + offset * (2.0 * Vec3(corner(point)) - 1.0));
            Eigen::Matrix<double, 6, 24> b = Eigen::Matrix<double, 6, 24>::Zero();  // xx yy zz yz xz xy
            for (int a = 0; a < 8; ++a) {
                const Vec3 g = gradients[static_cast<std::size_t>(a)];
                for (int r = 0; r < 3; ++r) {
                    for (int k = 0; k < 3; ++k) b(k, 3 * a + r) = (centre[static_cast<std::size_t>(a)][r] - g[r]) / 3.0;
                    b(r, 3 * a + r) += g[r];
                    const int s = (r + 1) % 3, t = (r + 2) % 3;
                    b(3 + s, 3 * a + r) = g[t];
                    b(3 + t, 3 * a + r) = g[s];
                }
            }
            Eigen::Matrix<double, 6, 6> law = Eigen::Matrix<double, 6, 6>::Zero();
            law.topLeftCorner<3, 3>().setConstant(lambda);
            for (int k = 0; k < 3; ++k) law(k, k) += 2.0 * mu;
            for (int k = 3; k < 6; ++k) law(k, k) = mu;
            sum += b.transpose() * law * b * (edge.x * edge.y * edge.z / 8.0);
        }
        return sum;
    }

    Vec3 size_;
    Int3 elements_;
    bool quarter_;
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower> solver_;
    Eigen::VectorXd solution_;
};

}  // namespace calot::deformation::rig

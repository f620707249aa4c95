#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <vector>

#include "tests/support/cloth_scenes.h"

namespace percale::test {

/// One step of backward Euler with damping as a length rate, as the minimum over v of
///   1/2 |v - v_n|_M^2 + sum 1/2 ks (l - l0)^2 + kd (l - l_n)^2/(2 dt) - sum m g . q,   q = q_n + dt v,
/// written densely with its own derivatives. Prescribed vertices stay where they are.
class DenseBackwardEuler {
public:
    explicit DenseBackwardEuler(const SolverScene& scene)
        : springs_(scene.model.springs),
          mass_(scene.model.mass),
          positions_(scene.state.points),
          dt_(scene.settings.time_step),
          gravity_(scene.settings.gravity) {
        start_.resize(3 * static_cast<Eigen::Index>(mass_.size()));
        for (std::size_t i = 0; i < mass_.size(); ++i) {
            start_.segment<3>(3 * static_cast<Eigen::Index>(i)) = scene.state.velocities.at(static_cast<int>(i));
            for (int axis = 0; axis < 3 && scene.script.free[i] > 0.0; ++axis) rows_.push_back(3 * static_cast<int>(i) + axis);
        }
    }

    const Eigen::VectorXd& start() const { return start_; }

    double objective(const Eigen::VectorXd& v) const {
        double sum = 0.0;
        for (std::size_t i = 0; i < mass_.size(); ++i) {
            const Vec3 change = at(v, i) - at(start_, i);
            sum += mass_[i] * (0.5 * change.squaredNorm() - gravity_.dot(place(v, static_cast<int>(i))));
        }
        for (int k = 0; k < springs_.size(); ++k) {
            const double l = substep(v, k).norm(), stretch = l - springs_.rest_length[k], growth = l - start_substep(k).norm();
            sum += 0.5 * springs_.stiffness[k] * stretch * stretch + 0.5 * springs_.damping[k] * growth * growth / dt_;
        }
        return sum;
    }

    /// Zero at prescribed vertices.
    Eigen::VectorXd gradient(const Eigen::VectorXd& v) const {
        Eigen::VectorXd sum = Eigen::VectorXd::Zero(v.size()), free = sum;
        for (std::size_t i = 0; i < mass_.size(); ++i) {
            sum.segment<3>(3 * static_cast<Eigen::Index>(i)) = mass_[i] * (at(v, i) - at(start_, i) - dt_ * gravity_);
        }
        for (int k = 0; k < springs_.size(); ++k) {
            const Vec3 x = substep(v, k), pull = dt_ * tension(k, x.norm()) * x.normalized();
            sum.segment<3>(3 * springs_.first[k]) += pull;
            sum.segment<3>(3 * springs_.second[k]) -= pull;
        }
        for (const int row : rows_) free[row] = sum[row];
        return free;
    }

    /// Newton with each spring's Hessian projected to its positive part, and steps halved until the objective falls.
    Eigen::VectorXd solve() const {
        Eigen::VectorXd v = start_;
        for (int iteration = 0; iteration < 500; ++iteration) {
            const Eigen::VectorXd g = gradient(v);
            if (g.norm() <= 1e-13 * gradient(start_).norm()) break;
            Eigen::VectorXd move = Eigen::VectorXd::Zero(v.size());
            move(rows_) = -hessian(v)(rows_, rows_).ldlt().solve(g(rows_));
            double fraction = 1.0;
            while (objective(v + fraction * move) > objective(v) && fraction > 1e-3) fraction *= 0.5;
            v += fraction * move;
        }
        return v;
    }

private:
    static Vec3 at(const Eigen::VectorXd& v, std::size_t i) { return v.segment<3>(3 * static_cast<Eigen::Index>(i)); }
    Vec3 place(const Eigen::VectorXd& v, int i) const { return positions_[i] + dt_ * at(v, i); }
    Vec3 substep(const Eigen::VectorXd& v, int k) const { return place(v, springs_.first[k]) - place(v, springs_.second[k]); }
    Vec3 start_substep(int k) const { return positions_[springs_.first[k]] - positions_[springs_.second[k]]; }
    double tension(int k, double l) const {
        return springs_.stiffness[k] * (l - springs_.rest_length[k]) + springs_.damping[k] * (l - start_substep(k).norm()) / dt_;
    }

    Eigen::MatrixXd hessian(const Eigen::VectorXd& v) const {
        Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(v.size(), v.size());
        for (std::size_t i = 0; i < mass_.size(); ++i) {
            sum.block<3, 3>(3 * i, 3 * i) = mass_[i] * Eigen::Matrix3d::Identity();
        }
        for (int k = 0; k < springs_.size(); ++k) {
            const Vec3 x = substep(v, k), d = x.normalized();
            const Eigen::Matrix3d along = d * d.transpose(), across = Eigen::Matrix3d::Identity() - along;
            const Eigen::Matrix3d block = dt_ * dt_ *
                                          ((springs_.stiffness[k] + springs_.damping[k] / dt_) * along +
                                           std::max(0.0, tension(k, x.norm()) / x.norm()) * across);
            const int i = 3 * springs_.first[k], j = 3 * springs_.second[k];
            sum.block<3, 3>(i, i) += block;
            sum.block<3, 3>(j, j) += block;
            sum.block<3, 3>(i, j) -= block;
            sum.block<3, 3>(j, i) -= block;
        }
        return sum;
    }

    SpringNetwork springs_;
    std::vector<double> mass_;
    std::vector<Vec3> positions_;
    double dt_;
    Vec3 gravity_;
    Eigen::VectorXd start_;
    std::vector<int> rows_;
};

}  // namespace percale::test

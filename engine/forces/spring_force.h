#pragma once

#include <Eigen/Core>
#include <vector>

#include "model/adjacency.h"
#include "model/spring_network.h"
#include "model/vectors.h"
#include "percale/settings.h"

namespace percale {

/// What the springs are during one step: tension T = k (l - l_rest) + c (v_ij . d), with d = x_ij / |x_ij|.
struct StepSprings {
    std::vector<double> stiffness;    // k, N/m
    std::vector<double> rest_length;  // l_rest, m
    std::vector<double> damping;      // c, N s/m
};

/// DampingForm::velocity: k = ks, l_rest = l0, c = kd.
/// DampingForm::length_rate: damping as the rate of the length over the step, kd (l - l_n)/dt, makes each spring exactly one with
/// k = ks + kd/dt, l_rest = (ks l0 + kd l_n/dt)/k and c = 0: an exact potential with a symmetric Hessian.
/// `positions` are those at the start of the step (l_n).
void set_step_springs(const SpringNetwork& network, const Vectors& positions, DampingForm form, double dt, StepSprings& springs);

/// What each spring does in one state; one more entry at the end, all zero, for the padding of Adjacency.
struct SpringTerms {
    std::vector<double> fx, fy, fz;     // N, on the spring's first vertex; the second feels the opposite
    std::vector<double> a, wx, wy, wz;  // kg: -dt^2 Jq - dt Jv between the two vertices, made positive definite, is a I + w w^T
};

/// The state that springs see; dt in s scales the matrix terms.
struct SpringMotion {
    const Vectors& positions;
    const Vectors& velocities;
    double dt;
};

/// Forces f = -T d and, with `with_matrix`, the matrix terms. Along d the matrix is dt^2 k + dt c, across it dt^2 T/l, which is
/// taken as 0 where the spring is compressed (T < 0) and capped where damping makes it exceed the first.
/// A spring of no length has no direction: it exerts no force, its matrix is (dt^2 k + dt c) I.
/// Returns the potential sum 1/2 k (l - l_rest)^2, J.
double evaluate_springs(const SpringNetwork& network, const StepSprings& springs, const SpringMotion& motion, bool with_matrix,
                        SpringTerms& terms);

/// forces += the springs' forces on their vertices. Sums in the order of the adjacency: same bits for any partition.
void add_spring_forces(const Adjacency& adjacency, const SpringTerms& terms, Vectors& forces);

/// Elastic energy sum 1/2 ks (l - l0)^2 of the network, J.
double elastic_energy(const SpringNetwork& network, const Vectors& positions);

/// Largest (l - l0)/l0 over structural springs; 0 without any.
double largest_strain(const SpringNetwork& network, const Vectors& positions);

/// The exact Jacobians of the force on the first vertex of one spring with velocity damping, by the positions and velocities of
/// that vertex, symmetrised nowhere: Jq = df/dx (N/m), Jv = df/dv (N s/m). Baraff and Witkin 1998 style derivation, damping along
/// the spring. `x` = x_i - x_j != 0 (m), `v` = v_i - v_j (m/s).
struct SpringJacobians {
    Eigen::Matrix3d by_position, by_velocity;
};
SpringJacobians spring_jacobians(const Vec3& x, const Vec3& v, double rest_length, double stiffness, double damping);

}  // namespace percale

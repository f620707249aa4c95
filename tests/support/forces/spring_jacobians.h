#pragma once

#include <Eigen/Core>

#include "percale/mesh.h"

namespace percale::test {

/// The exact Jacobians of the force on the first vertex of one spring with velocity damping, by the positions and velocities of
/// that vertex, symmetrised nowhere: Jq = df/dx (N/m), Jv = df/dv (N s/m). Baraff and Witkin 1998 style derivation, damping along
/// the spring.
struct SpringJacobians {
    Eigen::Matrix3d by_position, by_velocity;
};

/// `x` = x_i - x_j != 0 (m), `v` = v_i - v_j (m/s); rest length m, stiffness N/m, damping N s/m.
inline SpringJacobians spring_jacobians(const Vec3& x, const Vec3& v, double rest_length, double stiffness, double damping) {
    const double l = x.norm();
    const Vec3 d = x / l;
    const double rate = v.dot(d);
    const Eigen::Matrix3d along = d * d.transpose();
    const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - along;
    // f = -T d with T = ks (l - l0) + kd (v . d):  df/dx = -d (dT/dx)^T - T dd/dx,  dd/dx = (I - d d^T)/l,
    // dT/dx = ks d + kd (I - d d^T) v / l
    const double tension = stiffness * (l - rest_length) + damping * rate;
    const Vec3 tension_slope = stiffness * d + damping * (across * v) / l;
    return {.by_position = -d * tension_slope.transpose() - (tension / l) * across, .by_velocity = -damping * along};
}

}  // namespace percale::test

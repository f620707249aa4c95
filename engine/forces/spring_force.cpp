#include "spring_force.h"

#include <algorithm>
#include <cmath>

namespace percale {
namespace {

double length(const SpringNetwork& network, const Vectors& x, int k) {
    return (x.at(network.first[k]) - x.at(network.second[k])).norm();
}

}  // namespace

void set_step_springs(const SpringNetwork& network, const Vectors& positions, DampingForm form, double dt, StepSprings& springs) {
    if (form == DampingForm::velocity) {
        springs.stiffness = network.stiffness;
        springs.rest_length = network.rest_length;
        springs.damping = network.damping;
        return;
    }
    springs.stiffness.resize(network.size());
    springs.rest_length.resize(network.size());
    springs.damping.assign(network.size(), 0.0);
    for (int k = 0; k < network.size(); ++k) {
        const double rate = network.damping[k] / dt;
        const double stiffness = network.stiffness[k] + rate;
        springs.stiffness[k] = stiffness;
        springs.rest_length[k] =
            (network.stiffness[k] * network.rest_length[k] + rate * length(network, positions, k)) / stiffness;
    }
}

double evaluate_springs(const SpringNetwork& network, const StepSprings& springs, const SpringMotion& motion, bool with_matrix,
                        SpringTerms& terms) {
    const auto& [positions, velocities, dt] = motion;
    const std::size_t count = static_cast<std::size_t>(network.size());
    for (auto* list : {&terms.fx, &terms.fy, &terms.fz, &terms.a, &terms.wx, &terms.wy, &terms.wz}) list->resize(count + 1, 0.0);
    double energy = 0.0;
    for (std::size_t k = 0; k < count; ++k) {
        const int i = network.first[k], j = network.second[k];
        const double x = positions.x[i] - positions.x[j];
        const double y = positions.y[i] - positions.y[j];
        const double z = positions.z[i] - positions.z[j];
        const double l = std::sqrt(x * x + y * y + z * z);
        const double inverse = l > 0.0 ? 1.0 / l : 0.0;
        const double dx = x * inverse, dy = y * inverse, dz = z * inverse;
        const double rate = dx * (velocities.x[i] - velocities.x[j]) + dy * (velocities.y[i] - velocities.y[j]) +
                            dz * (velocities.z[i] - velocities.z[j]);
        const double stretch = l - springs.rest_length[k];
        const double tension = springs.stiffness[k] * stretch + springs.damping[k] * rate;
        energy += 0.5 * springs.stiffness[k] * stretch * stretch;
        terms.fx[k] = -tension * dx;
        terms.fy[k] = -tension * dy;
        terms.fz[k] = -tension * dz;
        if (!with_matrix) continue;
        // -dt^2 Jq - dt Jv = along d d^T + across (I - d d^T) = across I + (along - across) d d^T
        const double along = dt * dt * springs.stiffness[k] + dt * springs.damping[k];
        const double across = l > 0.0 ? std::clamp(dt * dt * tension * inverse, 0.0, along) : along;
        const double root = std::sqrt(along - across);
        terms.a[k] = across;
        terms.wx[k] = root * dx;
        terms.wy[k] = root * dy;
        terms.wz[k] = root * dz;
    }
    return energy;
}

void add_spring_forces(const Adjacency& adjacency, const SpringTerms& terms, Vectors& forces) {
    constexpr int lanes = Vectors::lanes;
    for (int s = 0; s < adjacency.slices(); ++s) {
        double* fx = &forces.x[static_cast<std::size_t>(s) * lanes];
        double* fy = &forces.y[static_cast<std::size_t>(s) * lanes];
        double* fz = &forces.z[static_cast<std::size_t>(s) * lanes];
        for (int e = adjacency.start[s]; e < adjacency.start[s + 1]; e += lanes) {
            for (int lane = 0; lane < lanes; ++lane) {
                const int spring = adjacency.spring[e + lane];
                const double sign = adjacency.sign[e + lane];
                fx[lane] += sign * terms.fx[spring];
                fy[lane] += sign * terms.fy[spring];
                fz[lane] += sign * terms.fz[spring];
            }
        }
    }
}

double elastic_energy(const SpringNetwork& network, const Vectors& positions) {
    double energy = 0.0;
    for (int k = 0; k < network.size(); ++k) {
        const double stretch = length(network, positions, k) - network.rest_length[k];
        energy += 0.5 * network.stiffness[k] * stretch * stretch;
    }
    return energy;
}

double largest_strain(const SpringNetwork& network, const Vectors& positions) {
    double largest = 0.0;
    for (int k = 0; k < network.size(); ++k) {
        if (network.kind[k] != SpringKind::structural) continue;
        largest = std::max(largest, length(network, positions, k) / network.rest_length[k] - 1.0);
    }
    return largest;
}

SpringJacobians spring_jacobians(const Vec3& x, const Vec3& v, double rest_length, double stiffness, double damping) {
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

}  // namespace percale

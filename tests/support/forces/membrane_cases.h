#pragma once

#include <Eigen/Dense>
#include <vector>

#include "engine/forces/membrane_springs.h"
#include "engine/linear/block_matrix.h"
#include "tests/support/cloth_scenes.h"
#include "tests/support/dense_system.h"

namespace percale::test {

/// Cloth of given moduli, without damping.
inline Fabric moduli_fabric(double warp, double weft, std::optional<double> shear, double poisson_ratio) {
    Fabric fabric{.spring_damping = 0.0};
    fabric.stretch_stiffness = {warp, weft};
    fabric.shear_stiffness = shear;
    fabric.poisson_ratio = poisson_ratio;
    return fabric;
}

/// Woven: all four moduli differ.
inline Fabric woven_fabric() { return moduli_fabric(200.0, 120.0, 15.0, 0.25); }

/// A model in a state, with the forces and energies of its springs and triangles there.
struct Strained {
    static constexpr double dt = 1.0 / 60.0;

    ClothModel model;
    Vec3Arrays positions, velocities, forces;
    SpringTerms terms;
    double energy = 0.0;

    Strained(ClothModel cloth, const std::vector<Vec3>& places) : model(std::move(cloth)), positions(to_vec3_arrays(places)) {
        velocities.resize(model.vertex_count());
        evaluate(compute);
    }
    Strained(const Strained&) = delete;
    Strained& operator=(const Strained&) = delete;

    void evaluate(const Compute& with) {
        StepSprings springs;
        set_step_springs(with, {model.adjacency, positions, DampingForm::velocity, dt}, springs);
        forces.resize(model.vertex_count());
        energy = evaluate_springs(with, springs, {positions, velocities, dt}, true, forces, terms);
        energy += evaluate_membrane(with, model.adjacency, {positions, velocities, dt}, true, forces, terms);
    }

    double energy_at(const Vec3Arrays& places) const { return membrane_energy(model.membrane, places); }

    /// -dt^2 Jq as in the solver, without masses.
    Eigen::MatrixXd matrix() const {
        BlockMatrix block;
        set_pattern(compute, model.adjacency, model.mass, block);
        fill_matrix(terms, {}, no_blocks, block);
        const int count = model.vertex_count();
        Eigen::MatrixXd dense(3 * count, 3 * count);
        AlignedVector<double> points;
        Vec3Arrays y;
        y.resize(count);
        for (int k = 0; k < 3 * count; ++k) {
            multiply(block, from_dense(Eigen::VectorXd::Unit(3 * count, k)), points, y);
            dense.col(k) = to_dense(y, count);
            dense(k, k) -= model.mass[k / 3];
        }
        return dense;
    }
};

/// Vertices moved at random by up to `reach`, m, after a stretch of all lengths.
inline std::vector<Vec3> disturbed(const std::vector<Vec3>& places, double stretch, double reach, unsigned seed) {
    Random random(seed);
    std::vector<Vec3> result;
    for (const Vec3& x : places) result.push_back(stretch * x + random.point(reach));
    return result;
}

/// The image of places in the plane y = 0 under x -> F x, (x, z) the coordinates there.
inline std::vector<Vec3> deformed(const std::vector<Vec3>& places, const Eigen::Matrix2d& gradient) {
    std::vector<Vec3> result;
    for (const Vec3& x : places) {
        const Eigen::Vector2d image = gradient * Eigen::Vector2d(x.x(), x.z());
        result.emplace_back(image.x(), 0.0, image.y());
    }
    return result;
}

/// E_xx, E_zz, 2 E_xz of Green's strain (F^T F - I)/2.
inline Eigen::Vector3d green_strain(const Eigen::Matrix2d& gradient) {
    const Eigen::Matrix2d strain = 0.5 * (gradient.transpose() * gradient - Eigen::Matrix2d::Identity());
    return {strain(0, 0), strain(1, 1), 2.0 * strain(0, 1)};
}

}  // namespace percale::test

#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <vector>

#include "engine/linear/block_matrix.h"
#include "tests/support/cloth_scenes.h"

namespace percale::test {

inline Vec3Arrays from_dense(const Eigen::VectorXd& x) {
    Vec3Arrays vectors;
    vectors.resize(static_cast<int>(x.size()) / 3);
    for (int i = 0; i < x.size() / 3; ++i) vectors.set(i, x.segment<3>(3 * i));
    return vectors;
}

inline Eigen::VectorXd to_dense(const Vec3Arrays& vectors, int count) {
    Eigen::VectorXd x(3 * count);
    for (int i = 0; i < count; ++i) x.segment<3>(3 * i) = vectors.at(i);
    return x;
}

inline Eigen::Matrix3d full_block(const std::array<double, 6>& k) {
    Eigen::Matrix3d m;
    m << k[0], k[1], k[2], k[1], k[3], k[4], k[2], k[4], k[5];
    return m;
}

inline Eigen::Matrix3d full_block(const SpringBlock& block) {
    return block.a * Eigen::Matrix3d::Identity() + block.w * block.w.transpose();
}

/// A random network in a random state, with contacts and prescribed vertices: the engine's matrix and its components.
struct RandomSystem {
    Random random;
    ClothModel model;
    Vec3Arrays positions, velocities;
    SpringTerms terms;
    std::vector<CoupledBlock> contacts;
    ForceBlocks blocks;
    BlockMatrix matrix;

    explicit RandomSystem(unsigned seed, int count) : random(seed) {
        model = linked_masses(random_masses(random, count), random_links(random, count, 4 * count));
        positions = to_vec3_arrays(random_points(random, count, 0.7));
        velocities = to_vec3_arrays(random_points(random, count, 1.0));
        evaluate();
        for (int i = 0; i < count / 2; ++i) contacts.push_back(random_contact(count));
        set_pattern(compute, model.adjacency, model.mass, matrix);
        for (int i = 0; i < count / 5; ++i) matrix.free[random.index(count)] = 0.0;
        fill();
    }
    RandomSystem(const RandomSystem&) = delete;
    RandomSystem& operator=(const RandomSystem&) = delete;

    void fill() { fill_matrix(terms, contacts, blocks, matrix); }

    /// An outer block of vertices that follow each other.
    void add_outer(int vertices, double size) {
        const int first = random.index(model.vertex_count());
        const OuterBlocks::NewBlock block = blocks.outer.add(vertices);
        for (int k = 0; k < vertices; ++k) {
            block.vertex[k] = (first + k) % model.vertex_count();
            block.gradient[k] = random.point(size);
        }
    }

    void evaluate() {
        StepSprings springs;
        set_step_springs(compute, {model.adjacency, positions, DampingForm::length_rate, 1.0 / 60.0}, springs);
        Vec3Arrays forces;
        forces.resize(model.vertex_count());
        evaluate_springs(compute, springs, {positions, velocities, 1.0 / 60.0}, true, forces, terms);
    }

    /// Removes all but masses and contacts; the matrix is to be filled anew.
    void slacken() {
        for (auto* list : {&model.springs.stiffness, &model.springs.damping}) std::fill(list->begin(), list->end(), 0.0);
        finish_model(model);
        evaluate();
    }

    CoupledBlock random_contact(int count) {
        CoupledBlock block{.vertex = {-1, -1, -1, -1}, .weight = {}, .k = {}};
        const int corners = std::min(count, 1 + random.index(3)), first = random.index(count);
        double sum = 0.0;
        for (int k = 0; k < corners; ++k) {
            block.vertex[k] = (first + k) % count;
            sum += block.weight[k] = random.number(0.1, 1.0);
        }
        for (double& weight : block.weight) weight /= sum;
        const Vec3 n = random.unit(), t = random.unit();
        const double normal = random.decades(1e-3, 10.0), tangent = random.decades(1e-3, 1.0);
        int entry = 0;
        for (int a = 0; a < 3; ++a) {
            for (int b = a; b < 3; ++b) block.k[entry++] = normal * n[a] * n[b] + tangent * t[a] * t[b];
        }
        return block;
    }

    Eigen::VectorXd random_vector() {
        Eigen::VectorXd x(3 * model.vertex_count());
        for (double& value : x) value = random.number(-1.0, 1.0);
        return x;
    }

    /// Random values where vertices are prescribed, 0 elsewhere.
    Eigen::VectorXd prescribed_values() {
        Eigen::VectorXd x = random_vector();
        for (int i = 0; i < x.size(); ++i) x[i] *= 1.0 - matrix.free[i / 3];
        return x;
    }

    /// Assembled block by block from springs and contacts, without the pattern.
    Eigen::MatrixXd dense() const {
        const int count = model.vertex_count();
        Eigen::MatrixXd result = Eigen::MatrixXd::Zero(3 * count, 3 * count);
        const auto add = [&](int i, int j, const Eigen::Matrix3d& block) { result.block<3, 3>(3 * i, 3 * j) += block; };
        for (int i = 0; i < count; ++i) add(i, i, model.mass[i] * Eigen::Matrix3d::Identity());
        for (int k = 0; k < model.springs.size(); ++k) {
            const int i = model.springs.first[k], j = model.springs.second[k];
            const Eigen::Matrix3d block = full_block(spring_block(model.adjacency, terms, k));
            add(i, i, block);
            add(j, j, block);
            add(i, j, -block);
            add(j, i, -block);
        }
        for (const CoupledBlock& contact : contacts) {
            for (int k = 0; k < 4 && contact.vertex[k] >= 0; ++k) {
                for (int l = 0; l < 4 && contact.vertex[l] >= 0; ++l) {
                    add(contact.vertex[k], contact.vertex[l], contact.weight[k] * contact.weight[l] * full_block(contact.k));
                }
            }
        }
        for (int number = 0; number < blocks.outer.size(); ++number) {
            const OuterBlocks::Block block = blocks.outer[number];
            for (std::size_t k = 0; k < block.vertex.size(); ++k) {
                for (std::size_t l = 0; l < block.vertex.size(); ++l)
                    add(block.vertex[k], block.vertex[l], block.gradient[k] * block.gradient[l].transpose());
            }
        }
        return result;
    }

    /// The solution with prescribed entries of `x` kept, by a dense factorisation of the free rows.
    Eigen::VectorXd solve_dense(const Eigen::VectorXd& b, Eigen::VectorXd x) const {
        std::vector<int> rows;
        for (int i = 0; i < 3 * model.vertex_count(); ++i) {
            if (matrix.free[i / 3] > 0.0) rows.push_back(i);
        }
        for (const int i : rows) x[i] = 0.0;
        const Eigen::MatrixXd a = dense();
        const Eigen::VectorXd right = b - a * x;
        const Eigen::VectorXd solution = a(rows, rows).ldlt().solve(right(rows));
        for (std::size_t i = 0; i < rows.size(); ++i) x[rows[i]] = solution[static_cast<Eigen::Index>(i)];
        return x;
    }
};

}  // namespace percale::test

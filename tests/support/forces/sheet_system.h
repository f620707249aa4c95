#pragma once

#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "engine/linear/block_matrix.h"
#include "tests/support/cloth_scenes.h"

namespace percale::test {

/// The step matrix of cloth in some state, mostly a square sheet, 1 m a side: the system of one linear solve of a step.
struct SheetSystem {
    static constexpr double dt = 1.0 / 60.0;

    Random random;
    ClothModel model;
    std::vector<CoupledBlock> contacts;
    ForceBlocks blocks;
    SpringTerms terms;
    BlockMatrix matrix;
    Vec3Arrays right;  // dt f, kg m/s

    /// Stretched along its axes, then vertices moved at random by up to `noise` times their distance; two corners pinned.
    SheetSystem(unsigned seed, int side, double noise, const Vec3& stretch = Vec3::Ones())
        : SheetSystem(seed, cloth_model(make_grid(1.0, 1.0, side, side), sheet_fabric()), noise / (side - 1), stretch) {
        for (const int corner : {0, side - 1}) matrix.free[corner] = 0.0;
        fill();
    }

    /// Any cloth, stretched along its axes, then vertices moved at random by up to `reach` (m); all free.
    SheetSystem(unsigned seed, ClothModel cloth, double reach, const Vec3& stretch = Vec3::Ones())
        : random(seed), model(std::move(cloth)) {
        std::vector<Vec3> places = model.rest;
        for (Vec3& x : places) x = x.cwiseProduct(stretch) + random.point(reach);
        const Vec3Arrays positions = to_vec3_arrays(places), start = to_vec3_arrays(model.rest);
        StepSprings springs;
        set_step_springs(compute, {model.adjacency, start, DampingForm::length_rate, dt}, springs);
        right.resize(model.vertex_count());
        evaluate_springs(compute, springs, {positions, start, dt}, true, right, terms);
        for (int i = 0; i < model.vertex_count(); ++i) right.set(i, dt * (right.at(i) + Vec3(0.0, -9.81 * model.mass[i], 0.0)));
        set_pattern(compute, model.adjacency, model.mass, matrix);
        fill();
    }
    SheetSystem(const SheetSystem&) = delete;
    SheetSystem& operator=(const SheetSystem&) = delete;

    int count() const { return model.vertex_count(); }
    void fill() { fill_matrix(terms, contacts, blocks, matrix); }

    void pin_share(double share) {
        for (int i = 0; i < count(); ++i) {
            if (random.number(0.0, 1.0) < share) matrix.free[i] = 0.0;
        }
        fill();
    }

    /// stiffness n n^T
    static SymmetricBlock along(const Vec3& n, double stiffness) {
        SymmetricBlock block;
        int entry = 0;
        for (int a = 0; a < 3; ++a) {
            for (int b = a; b < 3; ++b) block[entry++] = stiffness * n[a] * n[b];
        }
        return block;
    }

    /// The area of each triangle resists by an outer block, `factor` times as stiff as the diagonal block of its first vertex.
    void hold_areas(double factor) {
        for (const Triangle& t : model.triangles) {
            const Vec3 n = (model.rest[t[1]] - model.rest[t[0]]).cross(model.rest[t[2]] - model.rest[t[0]]).normalized();
            const OuterBlocks::NewBlock block = blocks.outer.add(3);
            const double length = (model.rest[t[2]] - model.rest[t[1]]).norm();
            for (int k = 0; k < 3; ++k) {
                block.vertex[k] = t[k];
                block.gradient[k] = n.cross(model.rest[t[(k + 2) % 3]] - model.rest[t[(k + 1) % 3]]) *
                                    (std::sqrt(factor * matrix.diagonal[0][t[0]]) / length);
            }
        }
        fill();
    }

    /// Contacts along random directions, stiffer than the vertex's own block by a random factor.
    void add_contacts(double share, double min_factor, double max_factor) {
        for (int i = 0; i < count(); ++i) {
            if (random.number(0.0, 1.0) >= share) continue;
            const double size = matrix.diagonal[0][i] + matrix.diagonal[3][i] + matrix.diagonal[5][i];
            const double stiffness = random.decades(min_factor, max_factor) * size / 3.0;
            const Vec3 n = random.unit();
            CoupledBlock block{.vertex = {i, -1, -1, -1}, .weight = {1.0, 0.0, 0.0, 0.0}, .k = {}};
            block.k = along(n, stiffness);
            contacts.push_back(block);
        }
        fill();
    }

    /// A contact along the y axis that holds a vertex on a point of three others, by the user's numbers; `factor` times as stiff
    /// as the vertex's own block.
    void lay_upon(int vertex, const std::array<int, 3>& others, const std::array<double, 3>& shares, double factor) {
        const auto number = [&](int user_vertex) { return model.cloths[0].index_of(user_vertex); };
        const int i = number(vertex);
        CoupledBlock block{.vertex = {i, number(others[0]), number(others[1]), number(others[2])},
                           .weight = {1.0, -shares[0], -shares[1], -shares[2]},
                           .k = {}};
        block.k[3] = factor * (matrix.diagonal[0][i] + matrix.diagonal[3][i] + matrix.diagonal[5][i]) / 3.0;
        contacts.push_back(block);
    }

    /// Contacts between parts of the cloth, each of one vertex and three others somewhere, along random directions.
    void add_self_contacts(int rows, double factor) {
        for (int row = 0; row < rows; ++row) {
            const Vec3 n = random.unit();
            const auto any = [&] { return random.index(count()); };
            CoupledBlock block{
                .vertex = {any(), any(), any(), any()}, .weight = {1.0, -0.5, -0.3, row % 7 == 0 ? 0.0 : -0.2}, .k = {}};
            const int i = block.vertex[0];
            const double size = matrix.diagonal[0][i] + matrix.diagonal[3][i] + matrix.diagonal[5][i];
            block.k = along(n, factor * size);
            contacts.push_back(block);
        }
        fill();
    }

    Vec3Arrays zeros() const {
        Vec3Arrays x;
        x.resize(count());
        return x;
    }

    /// Random on the free vertices, 0 at the others and in the padding.
    Vec3Arrays random_vector() {
        Vec3Arrays x = zeros();
        for (int i = 0; i < count(); ++i) {
            const Vec3 value = random.point(1.0);
            if (matrix.free[i] > 0.0) x.set(i, value);
        }
        return x;
    }

    /// |b - A x| on the free vertices.
    double residual(const Vec3Arrays& b, const Vec3Arrays& x) const {
        AlignedVector<double> points;
        Vec3Arrays product = x, rest = b;
        multiply(matrix, x, points, product);
        filter(matrix, rest);
        add_scaled(rest, -1.0, product);
        return std::sqrt(dot(compute, rest, rest));
    }

    /// sqrt(x . A x)
    double energy_norm(const Vec3Arrays& x) const {
        AlignedVector<double> points;
        Vec3Arrays product = x;
        return std::sqrt(multiply(matrix, x, points, product));
    }
};

inline Vec3Arrays difference(const Vec3Arrays& a, const Vec3Arrays& b) {
    Vec3Arrays result = a;
    add_scaled(result, -1.0, b);
    return result;
}

}  // namespace percale::test

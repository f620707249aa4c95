#include "block_matrix.h"

#include <algorithm>
#include <cmath>

#include "tolerances.h"

namespace percale {
namespace {

/// Adds the product of the coupled blocks to y at free vertices; returns its contribution to x . y.
double add_coupled_product(const BlockMatrix& matrix, const Vec3Arrays& x, Vec3Arrays& y) {
    double sum = 0.0;
    for (std::size_t number = 0; number < matrix.coupled.size(); ++number) {
        const CoupledBlock& block = matrix.coupled[number];
        Vec3 u = Vec3::Zero();
        for (int k = 0; k < 4 && block.vertex[k] >= 0; ++k) u += block.weight[k] * x.at(block.vertex[k]);
        const Vec3 f = block_times(block.k, u);
        for (int k = 0; k < 4 && block.vertex[k] >= 0; ++k) {
            const int i = block.vertex[k];
            const Vec3 part = matrix.free[i] * block.weight[k] * f;
            y.add(i, part);
            sum += part.dot(x.at(i));
        }
    }
    return sum;
}

CornerProduct corner_product(const BlockMatrix& matrix, const SpringTerms& springs) {
    return {matrix.pattern->membrane.corners(), springs.corners.data()};
}

/// sum |weight|: the factor that makes |w_k| K at each vertex an upper bound of the constraint.
double bound_factor(const CoupledBlock& block) { return between_cloths(block) ? 2.0 : 1.0; }

VertexBlocks& blocks_of(BlockMatrix& matrix, int vertex) {
    int& slot = matrix.slot[vertex];
    if (slot < 0) {
        slot = static_cast<int>(matrix.by_vertex.size());
        matrix.by_vertex.push_back({.vertex = vertex});
    }
    return matrix.by_vertex[slot];
}

void gather_coupled(BlockMatrix& matrix) {
    for (std::size_t number = 0; number < matrix.coupled.size(); ++number) {
        const CoupledBlock& block = matrix.coupled[number];
        const double factor = bound_factor(block);
        for (int k = 0; k < 4 && block.vertex[k] >= 0; ++k) {
            const int i = block.vertex[k];
            const double weight = factor * std::abs(block.weight[k]);
            if (weight == 0.0 || matrix.free[i] == 0.0) continue;
            SymmetricBlock& sum = blocks_of(matrix, i).coupled;
            for (int entry = 0; entry < 6; ++entry) sum[entry] += weight * block.k[entry];
        }
    }
}

void expand(const OuterBlocks::Block& block, std::size_t padded, Vec3Arrays& gradient) {
    gradient.resize(static_cast<int>(padded));
    for (std::size_t k = 0; k < block.vertex.size(); ++k) gradient.set(block.vertex[k], block.gradient[k]);
}

void gather_outer(BlockMatrix& matrix) {
    const OuterBlocks& blocks = matrix.of_forces->outer;
    std::size_t wide = 0;
    for (int number = 0; number < blocks.size(); ++number) {
        const OuterBlocks::Block block = blocks[number];
        if (!is_local(block)) {
            if (wide == matrix.wide_outer.size()) matrix.wide_outer.emplace_back();
            expand(block, matrix.padded(), matrix.wide_outer[wide++]);
            continue;
        }
        matrix.local_outer.push_back(number);
        double length = 0.0;
        for (const Vec3& g : block.gradient) length += g.norm();
        for (std::size_t k = 0; k < block.vertex.size(); ++k) {
            const Vec3& g = block.gradient[k];
            if (matrix.free[block.vertex[k]] == 0.0 || g.isZero(0.0)) continue;
            add_normal_block(blocks_of(matrix, block.vertex[k]).outer, length / g.norm(), g);
        }
    }
    matrix.wide_outer.resize(wide);
}

void invert_diagonal(BlockMatrix& matrix) {
    const std::size_t padded = matrix.padded();
    const int vertices = static_cast<int>(matrix.by_vertex.size());
    parallel_for_chunks(*matrix.compute, vertices, constraint_grain, vertices >= min_shared_constraints,
                        [&](int first, int last, int) {
                            for (int c = first; c < last; ++c) {
                                const VertexBlocks& blocks = matrix.by_vertex[c];
                                SymmetricBlock block = matrix.diagonal.block(blocks.vertex);
                                for (int k = 0; k < 6; ++k) block[k] += blocks.coupled[k] + blocks.outer[k];
                                const SymmetricBlock inverse = inverse_block(block);
                                for (int k = 0; k < 6; ++k)
                                    matrix.inverse[k * padded + blocks.vertex] = static_cast<float>(inverse[k]);
                            }
                        });
    for_each_vertex(*matrix.compute, matrix.slices(), [&](std::size_t i) {
        if (matrix.free[i] > 0.0) return;
        for (int k = 0; k < 6; ++k) matrix.inverse[k * padded + i] = 0.0f;
    });
}

}  // namespace

bool between_cloths(const CoupledBlock& block) {
    return std::any_of(block.weight.begin(), block.weight.end(), [](double w) { return w < 0.0; });
}

SymmetricBlock inverse_block(const SymmetricBlock& m) {
    const auto& [xx, xy, xz, yy, yz, zz] = m;
    const double cxx = yy * zz - yz * yz, cxy = xz * yz - xy * zz, cxz = xy * yz - xz * yy;
    const double scale = 1.0 / (xx * cxx + xy * cxy + xz * cxz);
    return {scale * cxx,
            scale * cxy,
            scale * cxz,
            scale * (xx * zz - xz * xz),
            scale * (xy * xz - xx * yz),
            scale * (xx * yy - xy * xy)};
}

void set_pattern(const Compute& compute, const Adjacency& pattern, std::span<const double> mass, BlockMatrix& matrix) {
    matrix.pattern = &pattern;
    matrix.compute = &compute;
    const std::size_t padded = static_cast<std::size_t>(pattern.slices()) * slice_lanes;
    matrix.mass.assign(padded, 1.0);
    std::copy(mass.begin(), mass.end(), matrix.mass.begin());
    matrix.free.assign(padded, 0.0);
    std::fill_n(matrix.free.begin(), pattern.vertex_count, 1.0);
    matrix.slot.assign(padded, -1);
    matrix.by_vertex.clear();
    matrix.coupled = {};
    matrix.of_forces = nullptr;
    matrix.springs = nullptr;
}

void fill_diagonal(const BlockMatrix& matrix, const SpringTerms& springs, DiagonalBlocks& diagonal,
                   AlignedVector<float>& inverse) {
    if (diagonal.padded != matrix.padded()) diagonal.resize(matrix.padded());
    inverse.resize(6 * matrix.padded());
    const DiagonalPass pass{.pattern = matrix.pattern->pattern(),
                            .values = springs.values.data(),
                            .ground = matrix.mass.data(),
                            .blocks = nullptr,
                            .diagonal = diagonal.data.data(),
                            .inverse = inverse.data(),
                            .padded = matrix.padded()};
    for_chunks(*matrix.compute, matrix.slices(), [&](Slices range) { matrix.compute->kernels->fine_diagonal(pass, range); });
    if (springs.corners.empty()) return;
    const CornerProduct corners = corner_product(matrix, springs);
    const DiagonalSums sums{diagonal.data.data(), inverse.data(), matrix.padded()};
    for_chunks(*matrix.compute, matrix.slices(),
               [&](Slices range) { matrix.compute->kernels->corner_diagonal(corners, sums, range); });
}

void set_blocks(std::span<const CoupledBlock> contacts, const ForceBlocks& of_forces, BlockMatrix& matrix) {
    matrix.coupled = {of_forces.coupled, contacts};
    matrix.of_forces = &of_forces;
    for (const VertexBlocks& blocks : matrix.by_vertex) matrix.slot[blocks.vertex] = -1;
    matrix.by_vertex.clear();
    matrix.local_outer.clear();
    gather_coupled(matrix);
    gather_outer(matrix);
}

void fill_matrix(const SpringTerms& springs, std::span<const CoupledBlock> contacts, const ForceBlocks& of_forces,
                 BlockMatrix& matrix) {
    matrix.springs = &springs;
    fill_diagonal(matrix, springs, matrix.diagonal, matrix.inverse);
    set_blocks(contacts, of_forces, matrix);
    invert_diagonal(matrix);
}

double multiply(const BlockMatrix& matrix, const Vec3Arrays& x, AlignedVector<double>& points, Vec3Arrays& y) {
    pack_points(*matrix.compute, *matrix.pattern, x, points);
    return multiply_placed(matrix, x, points, y);
}

double multiply_placed(const BlockMatrix& matrix, const Vec3Arrays& x, const AlignedVector<double>& points, Vec3Arrays& y) {
    const Compute& compute = *matrix.compute;
    const BlockPass pass{
        .pattern = matrix.pattern->pattern(), .values = matrix.springs->values.data(), .ground = matrix.mass.data()};
    double sum = sum_chunks(compute, matrix.slices(), [&](Slices range) {
        return compute.kernels->multiply(pass, x.axes(), points.data(), matrix.free.data(), y.axes(), range);
    });
    if (!matrix.springs->corners.empty()) {
        const CornerProduct corners = corner_product(matrix, *matrix.springs);
        const WideProduct product{.x = x.axes(), .points = points.data(), .free = matrix.free.data(), .y = y.axes()};
        sum += sum_chunks(compute, matrix.slices(),
                          [&](Slices range) { return compute.kernels->multiply_corners(corners, product, range); });
    }
    sum += add_coupled_product(matrix, x, y);
    if (matrix.of_forces->outer.size() == 0 && matrix.of_forces->loads.empty()) return sum;
    add_force_product(matrix, x, y);
    filter(matrix, y);
    return dot(compute, x, y);
}

void add_force_product(const BlockMatrix& matrix, const Vec3Arrays& x, Vec3Arrays& y) {
    for (const int number : matrix.local_outer) {
        const OuterBlocks::Block block = matrix.of_forces->outer[number];
        const double along = dot(block, x);
        for (std::size_t k = 0; k < block.vertex.size(); ++k) y.add(block.vertex[k], along * block.gradient[k]);
    }
    for (const Vec3Arrays& gradient : matrix.wide_outer) {
        const double along = dot(*matrix.compute, gradient, x);
        set_each(*matrix.compute, y, gradient, y, [along](double value, double g) { return value + along * g; });
    }
    for (const auto& [vertex, first, second] : matrix.of_forces->loads) {
        const Vec3 a = x.at(vertex[0]);
        const Vec3 change = (x.at(vertex[1]) - a).cross(second) + first.cross(x.at(vertex[2]) - a);
        for (const int corner : vertex) y.add(corner, change);
    }
}

void set_residual(const BlockMatrix& matrix, const Vec3Arrays& b, const Vec3Arrays& x, AlignedVector<double>& points,
                  Vec3Arrays& r) {
    multiply(matrix, x, points, r);
    for_each_vertex(*matrix.compute, matrix.slices(), [&](std::size_t i) {
        r.x[i] = matrix.free[i] * b.x[i] - r.x[i];
        r.y[i] = matrix.free[i] * b.y[i] - r.y[i];
        r.z[i] = matrix.free[i] * b.z[i] - r.z[i];
    });
}

void precondition(const BlockMatrix& matrix, const Vec3Arrays& r, Vec3Arrays& z, Slices range) {
    matrix.compute->kernels->jacobi(matrix.inverse.data(), matrix.padded(), r.axes(), z.axes(), range);
}

void filter(const BlockMatrix& matrix, Vec3Arrays& x) {
    for (auto* axis : {&x.x, &x.y, &x.z}) {
        for (std::size_t i = 0; i < axis->size(); ++i) (*axis)[i] *= matrix.free[i];
    }
}

}  // namespace percale

#include "block_matrix.h"

#include <algorithm>
#include <cmath>

#include "block_product.h"
#include "tolerances.h"

namespace percale {
namespace {

/// Adds the contacts' product to y at free vertices; returns its contribution to x . y.
double add_contact_product(const BlockMatrix& matrix, const Vec3Arrays& x, Vec3Arrays& y) {
    double sum = 0.0;
    for (const CoupledBlock& block : matrix.contacts) {
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

void gather_contacts(BlockMatrix& matrix) {
    for (const VertexContact& contact : matrix.contacts_by_vertex) matrix.contact_slot[contact.vertex] = -1;
    matrix.contacts_by_vertex.clear();
    for (const CoupledBlock& block : matrix.contacts) {
        const double factor = bound_factor(block);
        for (int k = 0; k < 4 && block.vertex[k] >= 0; ++k) {
            const int i = block.vertex[k];
            const double weight = factor * std::abs(block.weight[k]);
            if (weight == 0.0 || matrix.free[i] == 0.0) continue;
            int& slot = matrix.contact_slot[i];
            if (slot < 0) {
                slot = static_cast<int>(matrix.contacts_by_vertex.size());
                matrix.contacts_by_vertex.push_back({.vertex = i, .k = {}});
            }
            for (int entry = 0; entry < 6; ++entry) matrix.contacts_by_vertex[slot].k[entry] += weight * block.k[entry];
        }
    }
}

void invert_with_contacts(BlockMatrix& matrix) {
    const std::size_t padded = matrix.padded();
    const int vertices = static_cast<int>(matrix.contacts_by_vertex.size());
    parallel_for_chunks(*matrix.compute, vertices, constraint_grain, vertices >= min_shared_constraints,
                        [&](int first, int last, int) {
                            for (int c = first; c < last; ++c) {
                                const VertexContact& contact = matrix.contacts_by_vertex[c];
                                std::array<double, 6> block;
                                for (int k = 0; k < 6; ++k) block[k] = matrix.diagonal[k][contact.vertex] + contact.k[k];
                                const std::array<double, 6> inverse = inverse_block(block);
                                for (int k = 0; k < 6; ++k)
                                    matrix.inverse[k * padded + contact.vertex] = static_cast<float>(inverse[k]);
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

std::array<double, 6> inverse_block(const std::array<double, 6>& m) {
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
    matrix.contact_slot.assign(padded, -1);
    matrix.contacts_by_vertex.clear();
    matrix.contacts = {};
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

void fill_matrix(const SpringTerms& springs, std::span<const CoupledBlock> contacts, BlockMatrix& matrix) {
    matrix.springs = &springs;
    matrix.contacts = contacts;
    matrix.pressure_blocks = {};
    fill_diagonal(matrix, springs, matrix.diagonal, matrix.inverse);
    gather_contacts(matrix);
    invert_with_contacts(matrix);
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
    sum += add_contact_product(matrix, x, y);
    if (matrix.pressure_blocks.empty()) return sum;
    add_pressure_product(matrix, x, y);
    filter(matrix, y);
    return dot(compute, x, y);
}

void add_pressure_product(const BlockMatrix& matrix, const Vec3Arrays& x, Vec3Arrays& y) {
    const Vec3Arrays& q = *matrix.positions;
    for (const PressureBlock& block : matrix.pressure_blocks) {
        if (block.stiffness > 0.0) add_scaled(y, block.stiffness * dot(*matrix.compute, block.gradient, x), block.gradient);
        // The change of the gradient (b - a) x (c - a)/6 that each corner has.
        const double factor = -block.load / 6.0;
        for (const auto& [i, j, k] : block.triangles) {
            const Vec3 a = q.at(i), u = x.at(i);
            const Vec3 change = factor * ((x.at(j) - u).cross(q.at(k) - a) + (q.at(j) - a).cross(x.at(k) - u));
            for (const int vertex : {i, j, k}) y.add(vertex, change);
        }
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

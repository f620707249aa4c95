#include "direct_solver.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <vector>

namespace percale {
namespace {

using Sparse = Eigen::SparseMatrix<double>;
using Triplets = std::vector<Eigen::Triplet<double>>;

/// Adds the lower part of a block; blocks off the diagonal are given once, in either order.
void add_block(int i, int j, const std::array<double, 6>& block, Triplets& entries) {
    for (int a = 0; a < 3; ++a) {
        for (int b = 0; b < 3; ++b) {
            const int row = 3 * std::max(i, j) + a, column = 3 * std::min(i, j) + b;
            if (row >= column) entries.emplace_back(row, column, block[symmetric_entry[a][b]]);
        }
    }
}

void add_springs(const BlockMatrix& matrix, Triplets& entries) {
    const Adjacency& pattern = *matrix.pattern;
    for (int s = 0; s < pattern.slices(); ++s) {
        for (int e = pattern.start[s]; e < pattern.start[s + 1]; ++e) {
            const int i = s * slice_lanes + (e - pattern.start[s]) % slice_lanes, j = pattern.other[e];
            if (j <= i || matrix.free[i] == 0.0 || matrix.free[j] == 0.0) continue;
            const auto [a, w] = spring_block(pattern, *matrix.springs, pattern.spring[e]);
            add_block(
                i, j,
                {-a - w.x() * w.x(), -w.x() * w.y(), -w.x() * w.z(), -a - w.y() * w.y(), -w.y() * w.z(), -a - w.z() * w.z()},
                entries);
        }
    }
}

/// What a corner of a membrane's triangle adds between its vertex i and the two others: with y_i = -(u_p p + u_q q),
/// u_p = pq q.dq + pr r.dr, u_q = pq p.dp + qr r.dr (MembraneCorners).
struct CornerBlocks {
    Eigen::Matrix3d first, second;

    explicit CornerBlocks(const float* value) {
        const auto edge = [&](int k) {
            return Vec3(value[k * slice_lanes], value[(k + 1) * slice_lanes], value[(k + 2) * slice_lanes]);
        };
        const Vec3 p = edge(0), q = edge(3), r = edge(6);
        const double pq = value[9 * slice_lanes], pr = value[10 * slice_lanes], qr = value[11 * slice_lanes];
        first = pr * p * r.transpose() + q * (qr * r - pq * p).transpose();
        second = -p * (pq * q + pr * r).transpose() - qr * q * r.transpose();
    }
};

/// A block in the lower part, not on the diagonal, and not symmetric.
void add_full_block(const BlockMatrix& matrix, int i, int j, const Eigen::Matrix3d& block, Triplets& entries) {
    if (j >= i || matrix.free[i] == 0.0 || matrix.free[j] == 0.0) return;
    for (int a = 0; a < 3; ++a) {
        for (int b = 0; b < 3; ++b) entries.emplace_back(3 * i + a, 3 * j + b, block(a, b));
    }
}

void add_membrane(const BlockMatrix& matrix, Triplets& entries) {
    if (matrix.springs->corners.empty()) return;
    const MembraneCorners corners = matrix.pattern->membrane.corners();
    for (int s = 0; s < matrix.pattern->slices(); ++s) {
        for (int e = corners.start[s]; e < corners.start[s + 1]; ++e) {
            const int lane = (e - corners.start[s]) % slice_lanes, i = s * slice_lanes + lane;
            const CornerBlocks blocks(&matrix.springs->corners[corner_values * static_cast<std::size_t>(e - lane) + lane]);
            add_full_block(matrix, i, corners.other[0][e], blocks.first, entries);
            add_full_block(matrix, i, corners.other[1][e], blocks.second, entries);
        }
    }
}

void add_contact(const BlockMatrix& matrix, const CoupledBlock& contact, Triplets& entries) {
    for (int k = 0; k < 4 && contact.vertex[k] >= 0; ++k) {
        for (int l = 0; l <= k; ++l) {
            const int i = contact.vertex[k], j = contact.vertex[l];
            if (matrix.free[i] == 0.0 || matrix.free[j] == 0.0) continue;
            std::array<double, 6> block = contact.k;
            for (double& entry : block) entry *= contact.weight[k] * contact.weight[l];
            add_block(i, j, block, entries);
        }
    }
}

/// Free rows and columns of the matrix; 1 on the diagonal of the others.
void assemble(const BlockMatrix& matrix, Triplets& entries) {
    entries.clear();
    for (int i = 0; i < matrix.pattern->vertex_count; ++i) {
        std::array<double, 6> block = {1.0, 0.0, 0.0, 1.0, 0.0, 1.0};
        for (int k = 0; k < 6 && matrix.free[i] > 0.0; ++k) block[k] = matrix.diagonal[k][i];
        add_block(i, i, block, entries);
    }
    add_springs(matrix, entries);
    add_membrane(matrix, entries);
    for (const CoupledBlock& contact : matrix.contacts) add_contact(matrix, contact, entries);
}

}  // namespace

struct DirectSolver::Factor {
    Eigen::SimplicialLDLT<Sparse> ldlt;
    Sparse matrix;
    Triplets entries;
    std::vector<int> columns, rows;  // of the matrix that was analysed
    Vectors residual, step;
    AlignedVector<double> points;

    void factorise(const BlockMatrix& from) {
        assemble(from, entries);
        const Eigen::Index size = 3 * from.pattern->vertex_count;
        matrix.resize(size, size);
        matrix.setFromTriplets(entries.begin(), entries.end());
        const std::vector<int> new_columns(matrix.outerIndexPtr(), matrix.outerIndexPtr() + size + 1);
        const std::vector<int> new_rows(matrix.innerIndexPtr(), matrix.innerIndexPtr() + matrix.nonZeros());
        if (new_columns != columns || new_rows != rows) ldlt.analyzePattern(matrix);
        columns = new_columns;
        rows = new_rows;
        ldlt.factorize(matrix);
    }
};

DirectSolver::DirectSolver() : factor_(std::make_unique<Factor>()) {}
DirectSolver::~DirectSolver() = default;
DirectSolver::DirectSolver(DirectSolver&&) noexcept = default;
DirectSolver& DirectSolver::operator=(DirectSolver&&) noexcept = default;

bool DirectSolver::factorise(const BlockMatrix& matrix) {
    factor_->factorise(matrix);
    return factor_->ldlt.info() == Eigen::Success && (factor_->ldlt.vectorD().array() > 0.0).all();
}

void DirectSolver::apply(const BlockMatrix& matrix, const Vectors& r, Vectors& x) const {
    const int count = matrix.pattern->vertex_count;
    Eigen::VectorXd right(3 * count);
    for (int i = 0; i < count; ++i) right.segment<3>(3 * i) = r.at(i);
    const Eigen::VectorXd solution = factor_->ldlt.solve(right);
    x.resize(static_cast<int>(r.padded_size()));
    for (int i = 0; i < count; ++i) {
        if (matrix.free[i] > 0.0) x.set(i, solution.segment<3>(3 * i));
    }
}

bool DirectSolver::solve(const BlockMatrix& matrix, const Vectors& b, Vectors& x) {
    if (!factorise(matrix)) return false;
    Factor& factor = *factor_;
    factor.residual.resize(static_cast<int>(x.padded_size()));
    set_residual(matrix, b, x, factor.points, factor.residual);
    apply(matrix, factor.residual, factor.step);
    add_scaled(x, 1.0, factor.step);
    return true;
}

}  // namespace percale

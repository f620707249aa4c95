#include "direct_solver.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <vector>

#include "matrix_entries.h"

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

/// Adds the blocks of springs and membranes below the diagonal of row i, which need not be symmetric.
void add_row(const BlockMatrix& matrix, int i, Triplets& entries) {
    if (matrix.free[i] == 0.0) return;
    for_each_entry(matrix, i, [&](int j, const Eigen::Matrix3d& block) {
        if (j >= i || matrix.free[j] == 0.0) return;
        for (int a = 0; a < 3; ++a) {
            for (int b = 0; b < 3; ++b) entries.emplace_back(3 * i + a, 3 * j + b, block(a, b));
        }
    });
}

void add_coupled(const BlockMatrix& matrix, const CoupledBlock& coupled, Triplets& entries) {
    for (int k = 0; k < 4 && coupled.vertex[k] >= 0; ++k) {
        for (int l = 0; l <= k; ++l) {
            const int i = coupled.vertex[k], j = coupled.vertex[l];
            if (matrix.free[i] == 0.0 || matrix.free[j] == 0.0) continue;
            std::array<double, 6> block = coupled.k;
            for (double& entry : block) entry *= coupled.weight[k] * coupled.weight[l];
            add_block(i, j, block, entries);
        }
    }
}

void add_outer(const BlockMatrix& matrix, const OuterBlocks::Block& block, Triplets& entries) {
    for (std::size_t k = 0; k < 3 * block.vertex.size(); ++k) {
        for (std::size_t l = 0; l < 3 * block.vertex.size(); ++l) {
            const int i = block.vertex[k / 3], j = block.vertex[l / 3];
            const int row = 3 * i + static_cast<int>(k % 3), column = 3 * j + static_cast<int>(l % 3);
            if (row < column || matrix.free[i] == 0.0 || matrix.free[j] == 0.0) continue;
            entries.emplace_back(row, column, block.gradient[k / 3][k % 3] * block.gradient[l / 3][l % 3]);
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
    for (int i = 0; i < matrix.pattern->vertex_count; ++i) add_row(matrix, i, entries);
    for (std::size_t number = 0; number < matrix.coupled.size(); ++number) add_coupled(matrix, matrix.coupled[number], entries);
    for (const int number : matrix.local_outer) add_outer(matrix, matrix.of_forces->outer[number], entries);
}

}  // namespace

struct DirectSolver::Factor {
    Eigen::SimplicialLDLT<Sparse> ldlt;
    Sparse matrix;
    Triplets entries;
    std::vector<int> columns, rows;  // of the matrix analysed last
    Vec3Arrays residual, step;
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

void DirectSolver::apply(const BlockMatrix& matrix, const Vec3Arrays& r, Vec3Arrays& x) const {
    const int count = matrix.pattern->vertex_count;
    Eigen::VectorXd right(3 * count);
    for (int i = 0; i < count; ++i) right.segment<3>(3 * i) = r.at(i);
    const Eigen::VectorXd solution = factor_->ldlt.solve(right);
    x.resize(static_cast<int>(r.padded_size()));
    for (int i = 0; i < count; ++i) {
        if (matrix.free[i] > 0.0) x.set(i, solution.segment<3>(3 * i));
    }
}

bool DirectSolver::solve(const BlockMatrix& matrix, const Vec3Arrays& b, Vec3Arrays& x) {
    if (!factorise(matrix)) return false;
    Factor& factor = *factor_;
    factor.residual.resize(static_cast<int>(x.padded_size()));
    set_residual(matrix, b, x, factor.points, factor.residual);
    apply(matrix, factor.residual, factor.step);
    add_scaled(x, 1.0, factor.step);
    return true;
}

}  // namespace percale

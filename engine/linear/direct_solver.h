#pragma once

#include <memory>

#include "block_matrix.h"

namespace percale {

/// Sparse Cholesky factorisation of the step matrix, contact included (Eigen's SimplicialLDLT): for tiny and for badly
/// conditioned systems, and the oracle of the tests. The order of elimination is found anew when the pattern changes.
class DirectSolver {
public:
    DirectSolver();
    ~DirectSolver();
    DirectSolver(DirectSolver&&) noexcept;
    DirectSolver& operator=(DirectSolver&&) noexcept;

    /// x on the free vertices such that A x = b there, prescribed entries of x kept; false if the matrix is not positive
    /// definite.
    bool solve(const BlockMatrix& matrix, const Vec3Arrays& b, Vec3Arrays& x);

    /// The two halves of solve: false if the matrix is not positive definite; x = A^-1 r on the free vertices, 0 at the others,
    /// with the matrix factorised last, without its loads and its outer blocks that are not local.
    bool factorise(const BlockMatrix& matrix);
    void apply(const BlockMatrix& matrix, const Vec3Arrays& r, Vec3Arrays& x) const;

private:
    struct Factor;
    std::unique_ptr<Factor> factor_;
};

}  // namespace percale

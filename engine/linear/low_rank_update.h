#pragma once

#include <Eigen/Cholesky>
#include <vector>

#include "conjugate_gradient.h"

namespace percale {

/// The preconditioner of A + G G^T made from that of A, with the outer blocks that are not local (BlockMatrix::wide_outer) as the
/// columns of G, by the Sherman-Morrison-Woodbury formula (Golub and Van Loan, Matrix Computations, section 2.1.4):
///     (P + G G^T)^-1 = P^-1 - Z (I + G^T Z)^-1 Z^T,   Z = P^-1 G.
/// Positive definite where P is. Without such blocks it is P.
class LowRankUpdate {
public:
    /// Applies P once for each of the blocks; views the matrix.
    void fill(const BlockMatrix& matrix, Preconditioner of_matrix);
    void apply(const Vec3Arrays& r, Vec3Arrays& z);

private:
    const BlockMatrix* matrix_ = nullptr;
    Preconditioner of_matrix_;
    bool updates_ = false;              // there are such blocks
    std::vector<Vec3Arrays> columns_;   // Z
    Eigen::LLT<Eigen::MatrixXd> core_;  // I + G^T Z
    Eigen::MatrixXd sums_;              // work space
    Eigen::VectorXd along_;             // work space
};

}  // namespace percale

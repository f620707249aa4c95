#include "low_rank_update.h"

#include <utility>

namespace percale {

void LowRankUpdate::fill(const BlockMatrix& matrix, Preconditioner of_matrix) {
    matrix_ = &matrix;
    of_matrix_ = std::move(of_matrix);
    const std::vector<Vec3Arrays>& g = matrix.wide_outer;
    const Eigen::Index rank = static_cast<Eigen::Index>(g.size());
    columns_.resize(g.size());
    Eigen::MatrixXd core = Eigen::MatrixXd::Identity(rank, rank);
    for (Eigen::Index column = 0; column < rank; ++column) {
        of_matrix_(g[column], columns_[column]);
        for (Eigen::Index row = 0; row < rank; ++row) core(row, column) += dot(*matrix.compute, g[row], columns_[column]);
    }
    if (rank > 0) core_.compute(core);
}

void LowRankUpdate::apply(const Vec3Arrays& r, Vec3Arrays& z) const {
    of_matrix_(r, z);
    if (columns_.empty()) return;
    Eigen::VectorXd along(static_cast<Eigen::Index>(columns_.size()));
    for (std::size_t k = 0; k < columns_.size(); ++k) along[k] = dot(*matrix_->compute, columns_[k], r);
    core_.solveInPlace(along);
    for (std::size_t k = 0; k < columns_.size(); ++k) add_scaled(z, -along[k], columns_[k]);
}

}  // namespace percale

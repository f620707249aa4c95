#include "low_rank_update.h"

#include <utility>

namespace percale {

void LowRankUpdate::fill(const BlockMatrix& matrix, Preconditioner of_matrix) {
    matrix_ = &matrix;
    of_matrix_ = std::move(of_matrix);
    const std::vector<Vec3Arrays>& g = matrix.wide_outer;
    const Eigen::Index rank = static_cast<Eigen::Index>(g.size());
    columns_.resize(g.size());
    along_.resize(rank);
    sums_.setIdentity(rank, rank);
    for (Eigen::Index column = 0; column < rank; ++column) {
        of_matrix_(g[column], columns_[column]);
        for (Eigen::Index row = 0; row < rank; ++row) sums_(row, column) += dot(*matrix.compute, g[row], columns_[column]);
    }
    updates_ = rank > 0 && core_.compute(sums_).info() == Eigen::Success;
}

void LowRankUpdate::apply(const Vec3Arrays& r, Vec3Arrays& z) {
    of_matrix_(r, z);
    if (!updates_) return;
    const Compute& compute = *matrix_->compute;
    for (std::size_t k = 0; k < columns_.size(); ++k) along_[k] = dot(compute, columns_[k], r);
    core_.solveInPlace(along_);
    for (std::size_t k = 0; k < columns_.size(); ++k) {
        set_each(compute, z, columns_[k], z,
                 [factor = along_[k]](double value, double column) { return value - factor * column; });
    }
}

}  // namespace percale

#include "low_rank_update.h"

#include <utility>

namespace percale {

void LowRankUpdate::fill(const BlockMatrix& matrix, Preconditioner of_matrix) {
    matrix_ = &matrix;
    of_matrix_ = std::move(of_matrix);
    const OuterBlocks& blocks = matrix.of_forces->outer;
    const Eigen::Index rank = static_cast<Eigen::Index>(matrix.wide_outer.size());
    columns_.resize(rank);
    Eigen::MatrixXd core = Eigen::MatrixXd::Identity(rank, rank);
    for (Eigen::Index column = 0; column < rank; ++column) {
        const OuterBlocks::Block block = blocks[matrix.wide_outer[column]];
        gradient_.resize(static_cast<int>(matrix.padded()));
        for (std::size_t k = 0; k < block.vertex.size(); ++k)
            gradient_.set(block.vertex[k], matrix.free[block.vertex[k]] * block.gradient[k]);
        of_matrix_(gradient_, columns_[column]);
        for (Eigen::Index row = 0; row < rank; ++row) core(row, column) += dot(blocks[matrix.wide_outer[row]], columns_[column]);
    }
    if (rank > 0) core_.compute(core);
}

void LowRankUpdate::apply(const Vec3Arrays& r, Vec3Arrays& z) const {
    of_matrix_(r, z);
    if (columns_.empty()) return;
    const Eigen::Index rank = static_cast<Eigen::Index>(columns_.size());
    Eigen::VectorXd along(rank);
    for (Eigen::Index column = 0; column < rank; ++column) along[column] = dot(*matrix_->compute, columns_[column], r);
    core_.solveInPlace(along);
    for (Eigen::Index column = 0; column < rank; ++column) add_scaled(z, -along[column], columns_[column]);
}

}  // namespace percale

#include "rank_one.h"

#include "tolerances.h"

namespace percale {

void add_rank_one(const Compute& compute, std::span<const RankOne> blocks, const Vectors& x, Vectors& y) {
    for (const RankOne& block : blocks) {
        if (block.factor > 0.0) add_scaled(y, block.factor * dot(compute, block.gradient, x), block.gradient);
    }
}

SolveReport RankOneSolver::solve(const Compute& compute, std::span<const RankOne* const> blocks, const Vectors& b,
                                 const SolveTarget& target, const Solve& solve_rest, Vectors& x) {
    SolveReport report = solve_rest(b, target, x);
    const auto count = static_cast<Eigen::Index>(blocks.size());
    answers_.resize(blocks.size());
    coupling_.setZero(count, count);
    right_.resize(count);
    for (Eigen::Index k = 0; k < count; ++k) {
        const RankOne& block = *blocks[k];
        Vectors& answer = answers_[k];
        answer.resize(static_cast<int>(x.padded_size()));
        const SolveReport own = solve_rest(block.gradient, {.relative_residual = rank_one_residual}, answer);
        report.iterations += own.iterations;
        report.converged = report.converged && own.converged;
        right_[k] = dot(compute, block.gradient, x);
        coupling_(k, k) = 1.0 / block.factor;
        for (Eigen::Index l = 0; l < count; ++l) coupling_(l, k) += dot(compute, blocks[l]->gradient, answer);
    }
    factors_.compute(coupling_);
    taken_ = factors_.solve(right_);
    for (Eigen::Index k = 0; k < count; ++k) add_scaled(x, -taken_[k], answers_[k]);
    return report;
}

}  // namespace percale

#pragma once

#include <Eigen/LU>
#include <functional>
#include <span>
#include <vector>

#include "forces/force_term.h"
#include "gain_record.h"

namespace percale {

/// y += sum factor g (g . x)
void add_rank_one(const Compute& compute, std::span<const RankOne> blocks, const Vectors& x, Vectors& y);

/// Turns solves with a matrix A into those with A' = A + sum c_k g_k g_k^T by the formula of Sherman, Morrison and Woodbury
/// (Golub and Van Loan, Matrix Computations, 2.1.4): x = y - Z t with A y = b, A z_k = g_k and (1/c + G^T Z) t = G^T y. However
/// little exact Z is, G^T x is what it should be, so that stiff blocks do no harm; and as A' is above A, the error of x is no
/// larger in the norm of A' than that of y in the norm of A.
class RankOneSolver {
public:
    /// Solves A x = b with the prescribed entries of x.
    using Solve = std::function<SolveReport(const Vectors& b, const SolveTarget& target, Vectors& x)>;

    /// x becomes A'^-1 b. No factor may be 0.
    SolveReport solve(const Compute& compute, std::span<const RankOne* const> blocks, const Vectors& b, const SolveTarget& target,
                      const Solve& solve_rest, Vectors& x);

private:
    std::vector<Vectors> answers_;  // Z
    Eigen::MatrixXd coupling_;      // 1/c + G^T Z
    Eigen::VectorXd right_, taken_;
    Eigen::PartialPivLU<Eigen::MatrixXd> factors_;
};

}  // namespace percale

#include "linear_solver.h"

#include <cmath>

namespace percale {
namespace {

constexpr int dear_jacobi = 50;  // iterations from which multigrid is cheaper

}  // namespace

void StepSolver::set_model(const Compute& compute, const ClothModel& model, LinearSolver wish) {
    set_pattern(compute, model.adjacency, model.mass, matrix);
    model_ = &model;
    wish_ = wish;
    in_use_ = wish == LinearSolver::automatic ? LinearSolver::cg : wish;
    multigrid_.reset();
    direct_.reset();
}

void StepSolver::fill(const SpringTerms& springs, std::span<const ContactBlock> contacts) {
    fill_matrix(springs, contacts, matrix);
    if (in_use_ != LinearSolver::multigrid) return;
    if (!multigrid_) multigrid_ = std::make_unique<Multigrid>(*matrix.compute, model_->adjacency, model_->rest);
    multigrid_->fill(matrix);
}

SolveReport StepSolver::solve(const Vectors& b, const SolveTarget& target, Vectors& x) {
    if (in_use_ == LinearSolver::direct) {
        if (!direct_) direct_ = std::make_unique<DirectSolver>();
        return {.iterations = 1, .converged = direct_->solve(matrix, b, x)};
    }
    const SolveReport report = solve_cg(matrix, in_use_ == LinearSolver::multigrid ? multigrid_.get() : nullptr, b, target, space_, x);
    if (wish_ == LinearSolver::automatic && in_use_ == LinearSolver::cg && report.iterations > dear_jacobi) {
        in_use_ = LinearSolver::multigrid;
    }
    return report;
}

bool StepSolver::estimate(const Vectors& r, Vectors& z) {
    if (in_use_ != LinearSolver::multigrid || !multigrid_) return false;
    const double square = dot(*matrix.compute, r, r);
    if (!(square > 0.0) || !std::isfinite(square)) return false;
    if (z.padded_size() != r.padded_size()) z.resize(static_cast<int>(r.padded_size()));
    multigrid_->apply(std::sqrt(square), r, z);
    return true;
}

}  // namespace percale

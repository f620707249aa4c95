#include "linear_solver.h"

#include <algorithm>
#include <cmath>

#include "tolerances.h"

namespace percale {
namespace {

/// Iterations of block Jacobi from which multigrid is cheaper, and after which a solve goes on with multigrid. Coarser levels
/// are made anew when iterations exceed those of their first solve by a factor and by a number. Cost alone.
constexpr int dear_jacobi_iterations = 25, max_jacobi_iterations = 40;
constexpr int stale_level_factor = 2, stale_level_excess = 2;

/// Vertices up to which `automatic` factorises where iterative solvers are not exact enough. More: steps take seconds. Fewer:
/// small cloth with slivers is not solved exactly.
constexpr int max_factorised_vertices = 2000;

bool has_slivers(const ClothModel& model) {
    return std::any_of(model.cloths.begin(), model.cloths.end(),
                       [&](const ClothRange& cloth) { return largest_aspect(model, cloth) > sliver_aspect; });
}

}  // namespace

bool factorises(const ClothModel& model, LinearSolver wish) {
    if (wish != LinearSolver::automatic) return wish == LinearSolver::direct;
    return model.vertex_count() <= max_factorised_vertices && has_slivers(model);
}

void StepSolver::set_model(const Compute& compute, const ClothModel& model, LinearSolver wish) {
    set_pattern(compute, model.adjacency, model.mass, matrix);
    model_ = &model;
    wish_ = wish;
    const LinearSolver iterative = first_ == LinearSolver::direct ? LinearSolver::cg : first_;
    in_use_ = factorises(model, wish) ? LinearSolver::direct : wish == LinearSolver::automatic ? iterative : wish;
    multigrid_.reset();
    direct_.reset();
    stale_ = true;
}

void StepSolver::fill(const SpringTerms& springs, std::span<const CoupledBlock> contacts, const ForceBlocks& of_forces) {
    fill_matrix(springs, contacts, of_forces, matrix);
    if (in_use_ == LinearSolver::multigrid) fill_multigrid();
}

void StepSolver::fill_multigrid() {
    if (!multigrid_) multigrid_ = std::make_unique<Multigrid>(*matrix.compute, model_->adjacency, model_->rest);
    multigrid_->fill(matrix, stale_ ? Multigrid::Coarser::filled : Multigrid::Coarser::kept);
    if (stale_) fresh_iterations_ = 0;
    stale_ = false;
}

/// That of the solver in use, without loads and wide outer blocks.
Preconditioner StepSolver::preconditioner() {
    if (in_use_ == LinearSolver::multigrid) {
        return [this](const Vec3Arrays& r, Vec3Arrays& z) {
            if (!estimate(r, z)) z.resize(static_cast<int>(r.padded_size()));
        };
    }
    if (in_use_ == LinearSolver::direct) {
        if (!direct_) direct_ = std::make_unique<DirectSolver>();
        if (direct_->factorise(matrix)) return [this](const Vec3Arrays& r, Vec3Arrays& z) { direct_->apply(matrix, r, z); };
    }
    return [this](const Vec3Arrays& r, Vec3Arrays& z) {
        if (z.padded_size() != r.padded_size()) z.resize(static_cast<int>(r.padded_size()));
        for_chunks(*matrix.compute, matrix.slices(), [&](Slices range) { precondition(matrix, r, z, range); });
    };
}

/// With loads or wide outer blocks.
SolveReport StepSolver::solve_wide(const Vec3Arrays& b, const SolveTarget& target, Vec3Arrays& x) {
    low_rank_.fill(matrix, preconditioner());
    const SolveReport report =
        solve_cg(matrix, b, target, space_, x, [this](const Vec3Arrays& r, Vec3Arrays& z) { low_rank_.apply(r, z); });
    const bool may_change =
        in_use_ == LinearSolver::cg && wish_ == LinearSolver::automatic && model_->vertex_count() > dense_vertices;
    if (may_change && report.iterations > dear_jacobi_iterations) {
        in_use_ = LinearSolver::multigrid;
        fill_multigrid();
    }
    return report;
}

SolveReport StepSolver::solve(const Vec3Arrays& b, const SolveTarget& target, Vec3Arrays& x) {
    if (!matrix.of_forces->loads.empty() || !matrix.wide_outer.empty()) return solve_wide(b, target, x);
    int before = 0;
    if (in_use_ == LinearSolver::cg) {
        const bool may_change = wish_ == LinearSolver::automatic && model_->vertex_count() > dense_vertices;
        SolveTarget first = target;
        if (may_change) first.max_iterations = std::min(target.max_iterations, max_jacobi_iterations);
        const SolveReport report = solve_cg(matrix, b, first, space_, x);
        if (!may_change || report.iterations <= dear_jacobi_iterations) return report;
        in_use_ = LinearSolver::multigrid;
        fill_multigrid();
        if (report.converged) return report;
        before = report.iterations;
    }
    SolveReport report;
    if (in_use_ == LinearSolver::direct) {
        if (!direct_) direct_ = std::make_unique<DirectSolver>();
        report = {.iterations = 1, .converged = direct_->solve(matrix, b, x)};
    } else {
        report = solve_multigrid(matrix, *multigrid_, b, target, multigrid_space_, x);
        if (fresh_iterations_ == 0) fresh_iterations_ = report.iterations;
        stale_ = report.iterations > stale_level_factor * fresh_iterations_ + stale_level_excess;
    }
    report.iterations += before;
    if (report.converged) return report;
    // The rest, where the others broke down or reached their precision.
    const SolveReport rest = solve_cg(matrix, b, target, space_, x);
    return {.iterations = report.iterations + rest.iterations, .converged = rest.converged};
}

bool StepSolver::estimate(const Vec3Arrays& r, Vec3Arrays& z) {
    if (in_use_ != LinearSolver::multigrid || !multigrid_) return false;
    const double square = dot(*matrix.compute, r, r);
    if (!(square > 0.0) || !std::isfinite(square)) return false;
    const double scale = std::sqrt(square);
    const Compute& compute = *matrix.compute;
    const std::size_t padded = multigrid_->padded();
    for_chunks(compute, matrix.slices(), [&](Slices range) {
        compute.kernels->to_float(1.0 / scale, r.axes(), {multigrid_->residual().data(), padded}, range);
    });
    multigrid_->cycle();
    set_zero(compute, z, static_cast<int>(r.padded_size()));
    for_chunks(compute, matrix.slices(), [&](Slices range) {
        compute.kernels->add_float(scale, {multigrid_->correction().data(), padded}, z.axes(), range);
    });
    return true;
}

}  // namespace percale

#pragma once

#include <memory>

#include "conjugate_gradient.h"
#include "direct_solver.h"
#include "low_rank_update.h"
#include "model/cloth_model.h"
#include "multigrid_solve.h"
#include "percale/settings.h"

namespace percale {

/// Whether steps of a model begin with a factorisation: on request, and with `automatic` where small cloth with moduli has
/// slivers.
bool factorises(const ClothModel& model, LinearSolver wish);

/// The step matrix with the solver chosen by the settings or by the counts so far.
///
/// `automatic` begins with block Jacobi and changes to multigrid, permanently and also during a solve, when block Jacobi has
/// turned out to cost more, in products with the matrix: a multigrid solve costs about 8 products for its coarser matrices and 3
/// an iteration, and needs about five iterations where block Jacobi needs more than 25. Counts decide, no clock: runs repeat bit
/// for bit. Cloth of moduli with slivers is solved directly, up to `max_factorised_vertices` vertices.
class StepSolver {
public:
    /// Prepares for a model, which is viewed and must stay as it is.
    void set_model(const Compute& compute, const ClothModel& model, LinearSolver wish);
    bool is_for(const ClothModel& model) const { return matrix.pattern == &model.adjacency; }
    void forget_model() { matrix.pattern = nullptr; }

    /// A new stage begins: data kept from earlier matrices is computed anew.
    void start_stage() { stale_ = true; }

    /// Takes springs, contacts and the blocks of forces of a state; loads are in every product of A but in no preconditioner.
    void fill(const SpringTerms& springs, std::span<const CoupledBlock> contacts, const ForceBlocks& of_forces);

    /// A x = b on the free vertices, prescribed entries of x kept. Where multigrid or the factorisation does not converge,
    /// conjugate gradient with block Jacobi in double precision continues.
    SolveReport solve(const Vec3Arrays& b, const SolveTarget& target, Vec3Arrays& x);

    /// A cheap estimate of A^-1 r with the matrix last filled in: z = one application of the preconditioner. False where that is
    /// no good estimate, as with block Jacobi. Loads and outer blocks that are not local are left out: for a cloth that holds
    /// gas z is too large rather than too small.
    bool estimate(const Vec3Arrays& r, Vec3Arrays& z);

    /// The solver with which `automatic` begins for the next model; cg by default.
    void begin_with(LinearSolver solver) { first_ = solver; }

    LinearSolver in_use() const { return in_use_; }

    /// The solver with which `automatic` began and the present one.
    struct Choice {
        LinearSolver first = LinearSolver::cg, in_use = LinearSolver::cg;
    };
    Choice choice() const { return {first_, in_use_}; }
    /// Continues with the choice of a solver of the same model; after set_model.
    void go_on_from(const Choice& choice) {
        first_ = choice.first;
        in_use_ = choice.in_use;
    }

    BlockMatrix matrix;

private:
    void fill_multigrid();
    Preconditioner preconditioner();
    SolveReport solve_wide(const Vec3Arrays& b, const SolveTarget& target, Vec3Arrays& x);

    const ClothModel* model_ = nullptr;
    LinearSolver wish_ = LinearSolver::automatic;
    LinearSolver first_ = LinearSolver::cg;
    LinearSolver in_use_ = LinearSolver::cg;
    std::unique_ptr<Multigrid> multigrid_;
    std::unique_ptr<DirectSolver> direct_;
    LowRankUpdate low_rank_;
    bool stale_ = true;         // multigrid's coarser levels must be computed anew
    int fresh_iterations_ = 0;  // of the first solve with them
    SolveSpace space_;
    MultigridSpace multigrid_space_;
};

}  // namespace percale

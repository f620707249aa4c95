#pragma once

#include <memory>

#include "conjugate_gradient.h"
#include "direct_solver.h"
#include "model/cloth_model.h"
#include "multigrid_solve.h"
#include "percale/settings.h"

namespace percale {

/// Whether steps of a model begin with a factorisation: where that is asked for, and where `automatic` finds slivers in small
/// cloth of moduli.
bool factorises(const ClothModel& model, LinearSolver wish);

/// The step matrix with the solver that the settings or the counts so far choose.
///
/// `automatic` begins with block Jacobi and changes to multigrid, for good and in the midst of a solve, when that has turned out
/// to be dearer, in products with the matrix: a multigrid solve costs about 8 products for its coarser matrices and 3 an
/// iteration, and needs about five iterations where block Jacobi needs more than 25. Counts only, no clock: runs repeat bit for
/// bit. Cloth of moduli with slivers is solved directly, up to `most_factorised_vertices` vertices.
class StepSolver {
public:
    /// Prepares for a model, which is viewed and must stay as it is.
    void set_model(const Compute& compute, const ClothModel& model, LinearSolver wish);
    bool is_for(const ClothModel& model) const { return matrix.pattern == &model.adjacency; }
    void forget_model() { matrix.pattern = nullptr; }

    /// A new stage begins: what is taken over from earlier matrices is made anew.
    void start_stage() { stale_ = true; }

    /// Takes springs and contacts of a state.
    void fill(const SpringTerms& springs, std::span<const CoupledBlock> contacts);
    /// After that: enclosed blocks, taken at these positions, which join in every product of A but in no preconditioner. They are
    /// few directions, in which conjugate gradient needs an iteration or two more.
    void add_enclosed(std::span<const EnclosedBlock> blocks, const Vectors& positions);

    /// A x = b on the free vertices, prescribed entries of x kept. Where multigrid or the factorisation does not get there,
    /// conjugate gradient with block Jacobi in double precision goes on.
    SolveReport solve(const Vectors& b, const SolveTarget& target, Vectors& x);

    /// A cheap estimate of A^-1 r with the matrix last filled in: z = one application of the preconditioner. False where that is
    /// no good estimate, as with block Jacobi. Enclosed blocks are left out: of what fills a cloth z is too large rather than too
    /// small.
    bool estimate(const Vectors& r, Vectors& z);

    /// What `automatic` begins with for the next model; cg unless said.
    void begin_with(LinearSolver solver) { first_ = solver; }

    LinearSolver in_use() const { return in_use_; }

    /// What `automatic` begins with and has come to.
    struct Choice {
        LinearSolver first = LinearSolver::cg, in_use = LinearSolver::cg;
    };
    Choice choice() const { return {first_, in_use_}; }
    /// Goes on as a solver of the same model did; after set_model.
    void go_on_from(const Choice& choice) {
        first_ = choice.first;
        in_use_ = choice.in_use;
    }

    BlockMatrix matrix;

private:
    void fill_multigrid();
    SolveReport solve_enclosed(const Vectors& b, const SolveTarget& target, Vectors& x);

    const ClothModel* model_ = nullptr;
    LinearSolver wish_ = LinearSolver::automatic;
    LinearSolver first_ = LinearSolver::cg;
    LinearSolver in_use_ = LinearSolver::cg;
    std::unique_ptr<Multigrid> multigrid_;
    std::unique_ptr<DirectSolver> direct_;
    bool stale_ = true;         // multigrid's coarser levels are to be made anew
    int fresh_iterations_ = 0;  // of the first solve with them
    SolveSpace space_;
    MultigridSpace multigrid_space_;
};

}  // namespace percale

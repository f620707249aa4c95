#pragma once

#include <vector>

#include "body_states.h"
#include "linear/linear_solver.h"
#include "rigid_mode_correction.h"
#include "stage_equations.h"

namespace percale {

struct Direction {
    Vec3Arrays velocity;  // dv, m/s
    int linear_iterations = 0;
    bool exact = true;  // the solver reached its target
};

/// What a linear system is solved for, beside the point.
struct DirectionTask {
    const BodyStates& bodies;  // settled ones stay where they are
    const SolveTarget& target;
};

/// The linear systems of a stage: A dv = -r with the matrix A of linear/block_matrix.h, which is M without Jacobians. Prescribed
/// vertices move to their targets, and contact accounts for the motion that is left to obstacles. Kept from step to step so that
/// nothing is allocated once sizes are known; of a stage only the choice of the solver has an influence on later ones.
struct NewtonSystem {
    StepSolver solver;
    Vec3Arrays right_side;
    RigidModeCorrection rigid_modes;   // of the last direction
    std::vector<NetLimit> net_limits;  // of the last direction

    void begin_stage(const ImplicitStage& stage);
    /// The Newton direction at an evaluated point.
    void find_direction(const StageEquations& equations, const StagePoint& point, const DirectionTask& task, Direction& found);
    /// One application of the preconditioner alone, an estimate that is far cheaper; false where that is no good one.
    bool estimate_direction(const StageEquations& equations, const StagePoint& point, Direction& found);

private:
    void fill(const StageEquations& equations, const StagePoint& point, const DirectionTask& task);
    void set_net_limits(const StepScene& scene, double dt);
};

}  // namespace percale

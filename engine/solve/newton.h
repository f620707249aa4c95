#pragma once

#include <span>
#include <vector>

#include "contact/projection.h"
#include "forces/total_force.h"
#include "linear/linear_solver.h"
#include "model/cloth_model.h"
#include "plan/step_plan.h"
#include "percale/contact.h"
#include "percale/report.h"
#include "schemes/stage_base.h"

namespace percale {

/// What a test may switch off to reduce backward Euler to a simpler scheme.
struct NewtonOptions {
    bool jacobians = true;  // false: the matrix is the mass alone (Jq = Jv = 0)
    bool line_search = true;
    bool predict = true;  // start at q_n + dt v_n; false: at q_n
};

/// One part of a step, to be solved by backward Euler,
/// M (v - v_n) = dt f(q_n + dt v, v), or another implicit stage of the same form (stage_base.h), with prescribed vertices and
/// obstacles going where the script has them at its end. The whole way from the state to the stage's end is made safe.
struct ImplicitPart {
    const Compute* compute = nullptr;
    const ClothModel* model = nullptr;
    const StepSettings* settings = nullptr;
    const StepPlan* plan = nullptr;
    ContactDetector* detector = nullptr;          // used if the plan has contacts
    const Vectors* targets = nullptr;             // m, where prescribed vertices are at the end of the part
    const AlignedVector<double>* free = nullptr;  // 1 for free vertices, 0 for prescribed ones and padding
    double dt = 0.0;                              // s, length of this part; h of another stage
    const StageBase* base = nullptr;              // null: the state itself, backward Euler
    double contact_weight = 1.0;                  // how often contact forces count in M (v - v*) = h (f + weight contact)
    double full_step = 0.0;                       // s, of the whole step, over which obstacles move
    double contact_dt = 0.0;                      // s, ContactStep::stiffness_dt
    StepFraction span;                            // of the whole step
    std::span<const ObstacleFlow> flows = {};     // of each obstacle that moves; none: they stay
    const StepWind* wind = nullptr;               // null: no air
    NewtonOptions options;
};

enum class NewtonEnd {
    converged,
    iterations_used,  // arrived, but the error is above the target
    blocked,          // pins or obstacles could not reach the end of their path
    not_finite,
};

struct NewtonReport {
    NewtonEnd end = NewtonEnd::converged;
    int newton_iterations = 0;
    int linear_iterations = 0;
    int line_search_cuts = 0;
    double residual = 0.0;  // relative to the first, or to gravity's impulse where that is larger
    double smallest_fraction = 1.0;
    double largest_stiffness = 0.0;  // N/m, of contact
    double time_error = 0.0;         // m, estimated error of the stage's length, in the mean of the worst cloth
};

/// One point of the search: velocities v, positions q_n + dt v, how far pins and obstacles are, and all forces there.
struct NewtonPoint {
    Vectors velocities, positions;
    std::vector<Vec3> points;
    double fraction = 0.0;  // of the whole step
    Forces forces;
    std::vector<RowForce> row_forces;  // with contact_response projection
    Vectors residual;                  // M (v - v*) - h f, kg m/s; 0 at prescribed vertices
    double objective = 0.0;            // J: 1/2 |v - v*|_M^2 + potential
};

/// Work space of the solve, kept from step to step so that nothing is allocated once sizes are known.
struct NewtonSpace {
    StepSprings springs;
    StepSolver solver;
    DiagonalBlocks frozen_diagonal;  // empty until the part has been evaluated
    AlignedVector<float> frozen_inverse;
    Vectors frozen_load;  // N
    NewtonPoint current, trial;
    ContactProjection projection;  // likewise
    Vectors start_positions, start_velocities;
    std::vector<Grip> start_grips;
    FrictionStart friction;
    Vectors direction, right_side;
};

/// Solves one part from `state`, leaving the result there; a blocked or not finite part leaves `state` as it was.
/// Newton with the positive definite matrix of spring_force.h, conjugate gradient, every move cut to what the detector proves
/// free of crossing, and a line search. Stops by settings.newton_tolerance, or (auto) when what the last iteration changed, in
/// metres, dt sqrt(dv . b / m), is at most a quarter of the step's time error, estimated as dt/2 |v - v_n|, in every cloth.
NewtonReport solve_implicit(const ImplicitPart& part, NewtonSpace& space, ClothState& state, StageTimes& stages);

}  // namespace percale

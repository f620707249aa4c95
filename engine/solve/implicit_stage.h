#pragma once

#include <limits>
#include <span>
#include <vector>

#include "body_states.h"
#include "contact/foreseen_rows.h"
#include "contact/friction.h"
#include "contact/penalty.h"
#include "contact/projection.h"
#include "forces/total_force.h"
#include "linear/linear_solver.h"
#include "patch_space.h"
#include "plan/scene.h"
#include "schemes/stage_base.h"
#include "support/deadline.h"
#include "translations.h"

namespace percale {

/// What a test may switch off to reduce backward Euler to a simpler scheme.
struct NewtonOptions {
    bool jacobians = true;  // false: the matrix is the mass alone (Jq = Jv = 0)
    bool line_search = true;
    bool predict = true;  // start at q* + h v_n; false: at q_n
};

/// One nonlinear system, a stage of an implicit scheme: M (v - v*) = h f(q* + h v, v), with prescribed vertices and obstacles
/// going where the script has them at its end. The whole path from the start to the stage's end is made safe.
struct ImplicitStage {
    const StepScene& scene;
    const StageBase& base;                     // q*, v*, h
    const ClothState& start;                   // where the cloth is as the stage begins
    const Vectors& targets;                    // m, of prescribed vertices at its end
    StepFraction span = {};                    // of the whole step
    double contact_weight = 1.0;               // how often contact forces count in M (v - v*) = h (f + weight contact)
    double contact_dt = 0.0;                   // s, ContactStep::stiffness_dt
    std::span<const ObstacleFlow> flows = {};  // of each obstacle that moves; none: they stay
    const StepWind* wind = nullptr;            // null: no air
    std::span<const double> rest_length = {};  // m, ClothState::rest_length at the stage's time
    NewtonOptions options = {};

    bool moves_are_scripted() const { return scene.plan.obstacles_move || scene.plan.pins_move; }
    bool projects() const { return scene.plan.contacts && scene.settings.contact_response == ContactResponse::projection; }
};

/// One point of the search: velocities v, positions q* + h v, how far pins and obstacles are, and all forces there.
struct StagePoint {
    Vectors velocities, positions;
    std::vector<Vec3> points;
    double fraction = 0.0;  // of the whole step
    Forces forces;          // contact included
    ContactRows rows;       // empty without contact
    ContactTerms contact;
    std::vector<RowForce> row_forces;  // one a row
    Vectors residual;                  // r = M (v - v*) - h f, kg m/s; 0 at prescribed vertices
    double objective = 0.0;            // J: 1/2 |v - v*|_M^2 + potential; r is its gradient by v
};

/// Work space of solves, kept from step to step so that nothing is allocated once sizes are known. Nothing in it but what the
/// linear solver has come to (StepSolver::choice) has an influence on later stages.
struct NewtonSpace {
    StepSprings springs;
    StepSolver solver;
    PenaltyContact penalty;
    ProjectedContact projection;
    DiagonalBlocks frozen_diagonal;  // of the stage's first evaluation; empty until then
    AlignedVector<float> frozen_inverse;
    Vectors frozen_load;  // N
    StagePoint current, trial;
    FrictionStart friction;
    Vectors direction, right_side;
    Vectors first_direction;                                // m/s, before rows were foreseen
    Translations translations;                              // of the last direction
    std::vector<NetLimit> net_limits;                       // of the last direction
    BodyStates bodies;                                      // in the rounds of find_motion
    PatchSpace patches;                                     // of the last iteration that looked for some
    ForeseenRows foreseen;                                  // of the last move that a line search refused
    int iterations_left = std::numeric_limits<int>::max();  // of StepSettings::work_limit, for one stage
    TimeBudget time;                                        // that is left of the step's

    ContactLaw& law(ContactResponse response) {
        if (response == ContactResponse::projection) return projection;
        return penalty;
    }
};

}  // namespace percale

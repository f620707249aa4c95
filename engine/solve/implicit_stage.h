#pragma once

#include <span>
#include <vector>

#include "contact/friction.h"
#include "contact/penalty.h"
#include "contact/projection.h"
#include "forces/total_force.h"
#include "plan/scene.h"
#include "schemes/stage_base.h"

namespace percale {

/// Options by which a test reduces backward Euler to a simpler scheme.
struct NewtonOptions {
    bool jacobians = true;  // false: the matrix is the mass alone (Jq = Jv = 0)
    bool line_search = true;
    bool predict = true;  // start at q* + h v_n; false: at q_n
};

/// One nonlinear system, a stage of an implicit scheme: M (v - v*) = h f(q* + h v, v). Prescribed vertices and obstacles are at
/// their scripted places at its end. The whole path from the start to the end of the stage is kept free of crossing.
struct ImplicitStage {
    const StepScene& scene;
    const StageBase& base;                                  // q*, v*, h
    const ClothState& start;                                // the cloth at the start of the stage
    const Vec3Arrays& targets;                              // m, of prescribed vertices at its end
    StepFraction substep = {};                              // of the whole step
    double contact_weight = 1.0;                            // factor of contact forces in M (v - v*) = h (f + weight contact)
    std::span<const ObstacleMotion> obstacle_motions = {};  // of each obstacle that moves; those beyond the list are at rest
    const StepWind* wind = nullptr;                         // null: no air
    std::span<const double> rest_length = {};               // m, ClothState::rest_length at the stage's time
    NewtonOptions options = {};

    bool moves_are_scripted() const { return scene.plan.obstacles_move || scene.plan.pins_move; }
    bool projects() const { return scene.plan.contacts && scene.settings.contact_response == ContactResponse::projection; }
};

/// One point of the search: velocities v, positions q* + h v, the progress of pins and obstacles, and all forces there.
struct StagePoint {
    Vec3Arrays velocities, positions;
    std::vector<Vec3> points;
    double fraction = 0.0;           // of the whole step
    Forces forces;                   // contact included
    ContactConstraints constraints;  // empty without contact
    ContactTerms contact;
    std::vector<ConstraintForce> constraint_forces;  // one per constraint
    Vec3Arrays residual;                             // r = M (v - v*) - h f, kg m/s; 0 at prescribed vertices
    double objective = 0.0;                          // J: 1/2 |v - v*|_M^2 + potential; r is its gradient by v
};

/// Diagonal blocks of the elastic step matrix at the first evaluation of a stage, by which projection sets its stiffness.
struct FrozenForces {
    DiagonalBlocks diagonal;  // kg
    AlignedVector<float> inverse;
};

/// What the equations of a stage are made from, beside its points.
struct StageSpace {
    StepSprings springs;
    FrictionStart friction;
    ClothAnchors cloth_anchors;  // of friction
    FrozenForces frozen;
    PenaltyContact penalty;
    ProjectedContact projection;
    std::vector<double> loads;  // of soften_contact

    ContactLaw& law(ContactResponse response) {
        if (response == ContactResponse::projection) return projection;
        return penalty;
    }
};

}  // namespace percale

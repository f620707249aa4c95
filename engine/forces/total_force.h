#pragma once

#include "contact/penalty.h"
#include "model/cloth_model.h"
#include "percale/contact.h"
#include "percale/report.h"
#include "springs.h"
#include "wind.h"

namespace percale {

/// What forces act on in one evaluation.
struct ForceInput {
    const Compute* compute = nullptr;
    const ClothModel* model = nullptr;
    const StepSprings* springs = nullptr;
    const Vectors* positions = nullptr;
    const Vectors* velocities = nullptr;
    Vec3 gravity = Vec3::Zero();
    const StepWind* wind = nullptr;  // null: there is no air
    double dt = 0.0;
    bool with_matrix = false;
};

/// Forces of one state and what the step matrix is made of.
struct Forces {
    Vectors total;  // N
    SpringTerms spring_terms;
    ContactRows rows;  // set by whoever evaluates contacts; empty without obstacles
    ContactTerms contact;
    WindTerms wind;
    double potential =
        0.0;  // J, of springs (with their damping potential), hinges, wind (dissipation potential times dt), gravity and contact
};

/// Gravity, springs, hinges and wind; contact is added by add_contact_forces.
void evaluate_forces(const ForceInput& input, Forces& forces);

/// Adds the contact of forces.rows.
void add_contact_forces(const ForceInput& input, const ContactStep& contact_step, Forces& forces);

}  // namespace percale

#pragma once

#include "contact_law.h"
#include "potential.h"

namespace percale {

/// Contact by unilateral constraints: at the end of the step the distance of every constraint is at least the thickness, and an
/// active constraint pushes with just the force that this takes (Signorini). Friction is in Coulomb's cone: a constraint sticks
/// without any slip, or its friction is mu times its normal force, against the slip.
///
/// Augmented Lagrangian (Alart and Curnier 1991; Simo and Laursen 1992): each constraint has a force l as multiplier and acts
/// with
///     n max(0, l_n + k (h - d)) + P(l_t - k dt s),   P the projection onto the disc of radius mu times the normal force,
/// with slip velocity s. Newton solves for the motion with the multipliers fixed, then each multiplier becomes its constraint's
/// force. Where that changes nothing, d = h where constraints push and s = 0 where they stick, whatever k is. A stage makes a few
/// such rounds; the next one starts from its forces.
class ProjectedContact final : public ContactLaw {
public:
    double activation_ratio() const override;

    /// Starts from the forces that lasted for two stages, as the push of an impact lasts for one.
    void begin(const ContactWarmStart& warm_start) override;

    /// Forces move on with the cloth; the stiffness of each vertex is divided among its constraints.
    void set_constraints(const ContactConstraints& constraints) override;

    /// Makes blocks of pushing constraints only. Leaves the potential as it is: that of the multipliers changes with them.
    void evaluate(const ContactPoint& point, ContactForces forces) const override;

    /// The distance of the forces of a point from the multipliers, m: the largest change of a force over its k.
    double mismatch(const ContactConstraints& constraints, const std::vector<ConstraintForce>& forces) const;

    /// Makes the forces of a solved point the multipliers and replaces them by the forces that follow.
    bool correct(const ContactPoint& point, ContactForces forces, double enough) override;

    void end(const ContactConstraints& constraints, const ContactTerms& terms,
             const std::vector<ConstraintForce>& constraint_forces, ContactWarmStart& warm_start) override;

    /// The normal force is that of a constraint: the energy that it takes from motion towards the obstacle is lost.
    ContactLoss loss(const ContactMove& move, double stored) const override;

private:
    /// The multipliers at a point where constraints are gone: their forces have moved on (ContactMultipliers::transfer).
    const ContactMultipliers& multipliers_at(const ContactConstraints& constraints) const;

    ContactMultipliers multipliers_;
    mutable ContactMultipliers moved_on_;          // of the point evaluated last
    std::vector<ConstraintForce> lasting_forces_;  // scratch space of end
    std::vector<double> pushing_weight_;  // of each vertex, sum of weights of the constraints that push it as the stage begins
    double min_distance_ = 0.0;           // ContactWarmStart::min_distance
};

}  // namespace percale

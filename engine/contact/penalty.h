#pragma once

#include "contact_law.h"
#include "potential.h"

namespace percale {

/// Penalty springs with Coulomb friction. Adds the contact forces to `forces`, N; fills `terms` and the normal parts of
/// `constraint_forces`. Between cloths the slip is that of one side relative to the other (ClothFrictionContact), and n.A n and
/// the masses are those of both sides in series, 1/sum w^2/a.
/// The stiffness of a constraint is half of the weighted sum of n.A n/dt^2 over its vertices, where A are the frozen diagonal
/// blocks (with `stiffness_dt` for the masses unless the obstacle moves: a suddenly shorter step must not throw up the cloth that
/// lies there). It is at least four times (weight or initial load on the constraint)/thickness, so that cloth rests at no less
/// than 3/4 of the thickness. Friction with obstacles acts on vertices (friction.h), each with its part of all constraints with
/// the same obstacle; the matrix leaves a sliding vertex free along its slip.
void add_contact(const ContactConstraints& constraints, const ContactStep& step, const Vec3Arrays& positions, Vec3Arrays& forces,
                 ContactTerms& terms, std::vector<ConstraintForce>& constraint_forces);

/// Contact as penalty springs with Coulomb friction (add_contact). Every evaluation stands by itself: nothing is held fixed while
/// Newton solves, and the warm start holds only the anchors of friction between cloths.
class PenaltyContact final : public ContactLaw {
public:
    double activation_ratio() const override { return 1.0; }
    void begin(const ContactWarmStart&) override {}
    void set_constraints(const ContactConstraints&) override {}
    void evaluate(const ContactPoint& point, ContactForces forces) const override;
    bool correct(const ContactPoint&, ContactForces, double) override { return false; }
    void end(const ContactConstraints& constraints, const ContactTerms& terms,
             const std::vector<ConstraintForce>& constraint_forces, ContactWarmStart& warm_start) override;
    /// The potential of a friction contact is CoulombLaw::potential. The excess of its slip over the threshold times the friction
    /// force is the friction loss.
    ContactLoss loss(const ContactMove& move, double stored) const override;
};

}  // namespace percale

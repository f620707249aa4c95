#pragma once

#include "contact_law.h"
#include "potential.h"

namespace percale {

/// Contact by a potential of the distance (potential.h, contact_stiffness.h) with Coulomb friction. Adds the contact forces to
/// `forces`, N; fills `terms` and the normal parts of `constraint_forces`, with the curvature of the potential as their
/// stiffness. Between cloths the slip is that of one side relative to the other (ClothFrictionContact). A constraint with a
/// mollifier below 0 is subtracted: it has no matrix, which so stays positive definite. Friction with obstacles acts on vertices
/// (friction.h), each with its part of all constraints with the same obstacle; the matrix leaves a sliding vertex free along its
/// slip.
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

private:
    AnchorKeeper anchors_;
};

}  // namespace percale

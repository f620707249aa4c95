#pragma once

#include <vector>

#include "contact_law.h"
#include "support/aligned.h"

namespace percale {

/// What of a point of the search says how far its contact forces are out of balance.
struct ContactBalance {
    const ContactConstraints& constraints;
    const std::vector<ConstraintForce>& forces;  // N, those of contact
    const Vec3Arrays& residual;                  // kg m/s
    const AlignedVector<double>& free;           // 0 for prescribed vertices, whose residual says nothing
    double h = 0.0;                              // s
    double weight = 1.0;                         // factor of the contact forces (ImplicitStage::contact_weight)
};

/// Replaces the tangents in the matrix of contact by secants where a constraint's force is larger than what it has to carry.
/// A force F ~ s^n of the depth s far out of balance falls by Newton's tangent to (1 - 1/n)^n of itself only, to about a third an
/// iteration. The share of it that the other forces carry is, with the residual r, the weights w and the normal n,
///     rho = 1 + sum w_k n.r_k/h / sum |w_k| S_k,   S the sum of the sizes of all contact forces on a vertex.
/// F rho is what the constraint will carry, at a depth of s sqrt(rho) or more. The secant between s and s max(sqrt(rho), 1/2) is
/// softer than the tangent, as F is convex, but above 0: the direction descends. From rho = 1/2 on it stays the tangent, and the
/// solve ends with Newton's own iterations. `loads`: work space.
void soften_contact(const ContactBalance& balance, ContactTerms& terms, std::vector<double>& loads);

}  // namespace percale

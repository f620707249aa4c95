#pragma once

#include <algorithm>
#include <vector>

#include "contact_law.h"
#include "percale/contact_load.h"

namespace percale {

/// The force of an obstacle on a vertex through one constraint or one friction contact, N.
struct Push {
    int vertex = -1, obstacle = -1;
    Vec3 normal = Vec3::Zero(), friction = Vec3::Zero();
    double normal_force = 0.0;    // N, along the direction; below 0 where it is subtracted
    const Vec3* where = nullptr;  // m, on the obstacle; null where nothing presses
};

/// Calls visit(push) for every vertex of every constraint with an obstacle that acts, and for every friction contact. Friction of
/// projection is in the constraints, friction of penalty in the friction contacts.
template <class Visit>
void for_each_push(const ContactConstraints& constraints, const ContactTerms& terms,
                   const std::vector<ConstraintForce>& constraint_forces, Visit visit) {
    for (std::size_t constraint = 0; constraint < std::min(constraints.size(), constraint_forces.size()); ++constraint) {
        const ConstraintForce& force = constraint_forces[constraint];
        if (constraints.obstacle[constraint] < 0 || force.normal == 0.0) continue;
        for (int k = 0; k < 4 && constraints.vertex[constraint][k] >= 0; ++k) {
            const double weight = constraints.weight[constraint][k];
            if (weight == 0.0) continue;
            visit(Push{constraints.vertex[constraint][k], constraints.obstacle[constraint],
                       weight * force.normal * constraints.direction[constraint], weight * force.friction, weight * force.normal,
                       &constraints.obstacle_point[constraint]});
        }
    }
    for (const FrictionContact& contact : terms.friction_contacts.all) {
        if (contact.obstacle >= 0) visit(Push{contact.vertex, contact.obstacle, Vec3::Zero(), contact.law().force(contact.slip)});
    }
}

/// The forces of obstacles on vertices from the constraints and forces of one evaluation, sorted by vertex and obstacle. Vertices
/// without an active constraint and constraints between cloths are left out. The caller fills in the places of the vertices
/// (cloth_point). `only`: one obstacle; -1: all.
std::vector<ContactLoad> contact_loads(const ContactConstraints& constraints, const ContactTerms& terms,
                                       const std::vector<ConstraintForce>& constraint_forces, int only = -1);

}  // namespace percale

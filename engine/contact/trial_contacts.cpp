#include "trial_contacts.h"

#include <algorithm>

namespace percale {
namespace {

/// The distance at which the tangent of a constraint's force is 0.
double activation_distance_of(const ContactConstraints& constraints, std::size_t constraint, const ConstraintForce& force) {
    return std::min(constraints.thickness[constraint], constraints.distance[constraint] + force.normal / force.stiffness);
}

}  // namespace

void TrialContacts::add_to(const AlignedVector<double>& free, Vec3Arrays& right_side) const {
    const std::size_t first = blocks.size() - impulses.size();
    for (std::size_t i = 0; i < impulses.size(); ++i) {
        const CoupledBlock& block = blocks[first + i];
        for (int k = 0; k < 4 && block.vertex[k] >= 0; ++k) {
            right_side.add(block.vertex[k], free[block.vertex[k]] * block.weight[k] * impulses[i]);
        }
    }
}

double find_trial_contacts(const std::vector<CoupledBlock>& blocks_at_start, const TrialMove& move, TrialContacts& found) {
    const ContactConstraints& constraints = move.constraints;
    const double h = move.h, weighted = move.weight * h;
    found.blocks = blocks_at_start;
    found.impulses.clear();
    double slope = 0.0;
    for (std::size_t constraint = 0; constraint < constraints.size(); ++constraint) {
        const ConstraintForce& force = move.constraint_forces[constraint];
        if (!(force.normal > 0.0)) continue;
        const Vec3& n = constraints.direction[constraint];
        CoupledBlock block{.vertex = constraints.vertex[constraint], .weight = constraints.weight[constraint], .k = {}};
        double distance = -n.dot(constraints.obstacle_point[constraint]), opening = 0.0;
        for (int k = 0; k < 4 && block.vertex[k] >= 0; ++k) {
            distance += block.weight[k] * n.dot(move.start.at(block.vertex[k]));
            opening += block.weight[k] * n.dot(move.direction.at(block.vertex[k]));
        }
        if (distance < constraints.thickness[constraint]) continue;
        const double apart = distance - activation_distance_of(constraints, constraint, force);
        slope -= weighted * force.normal * opening;
        add_normal_block(block.k, weighted * h * force.stiffness, n);
        found.blocks.push_back(block);
        found.impulses.push_back(-weighted * force.stiffness * apart * n);
    }
    return slope;
}

}  // namespace percale

#include "contact_secants.h"

#include <algorithm>
#include <cmath>

namespace percale {
namespace {

/// Fraction of the depth to which a secant leads at most. Smaller: vertices leave contact that they need, and come back far too
/// deep. Larger: forces far too large fall slowly.
constexpr double min_depth_ratio = 0.5;

/// How many times softer than the tangent a secant is at most. Larger: where cloth begins at distances of rounding, whose forces
/// are 1e12 times what it carries, the matrix has no balance of normal and friction forces.
constexpr double max_softening = 8.0;

/// Share from which on a constraint has its tangent. 1: the last changes of a solve are those of a secant, which are no measure
/// of its error; sheets in a pile tremble longer. 0: forces twice too large fall slowly.
constexpr double balanced_share = 0.5;

/// The sum of the sizes of the contact forces on each vertex, less those that are subtracted, N.
void add_loads(const ContactBalance& balance, std::vector<double>& loads) {
    const ContactConstraints& constraints = balance.constraints;
    for (std::size_t constraint = 0; constraint < constraints.size(); ++constraint) {
        const double force = balance.weight * balance.forces[constraint].normal;
        for (int k = 0; k < 4 && constraints.vertex[constraint][k] >= 0; ++k)
            loads[constraints.vertex[constraint][k]] += std::abs(constraints.weight[constraint][k]) * force;
    }
}

/// rho of a constraint; 1 where it is not known.
double carried_share(const ContactBalance& balance, std::size_t constraint, const std::vector<double>& loads) {
    double excess = 0.0, load = 0.0;
    for (int k = 0; k < 4 && balance.constraints.vertex[constraint][k] >= 0; ++k) {
        const int i = balance.constraints.vertex[constraint][k];
        if (balance.free[i] == 0.0) continue;
        const double weight = balance.constraints.weight[constraint][k];
        excess += weight * balance.constraints.direction[constraint].dot(balance.residual.at(i)) / balance.h;
        load += std::abs(weight) * loads[i];
    }
    return load > 0.0 ? 1.0 + excess / load : 1.0;
}

}  // namespace

void soften_contact(const ContactBalance& balance, ContactTerms& terms, std::vector<double>& loads) {
    const ContactConstraints& constraints = balance.constraints;
    loads.assign(balance.residual.padded_size(), 0.0);
    add_loads(balance, loads);
    for (CoupledBlock& block : terms.blocks) {
        const int constraint = block.constraint;
        if (constraint < 0 || !(balance.forces[constraint].normal > 0.0)) continue;
        const double share = carried_share(balance, constraint, loads);
        if (share >= balanced_share) continue;
        const double thickness = constraints.thickness[constraint], depth = thickness - constraints.distance[constraint];
        const double fallen = depth * (1.0 - std::max(std::sqrt(std::max(share, 0.0)), min_depth_ratio));
        const ConstraintForce& force = balance.forces[constraint];
        const double left =
            contact_potential(constraints.distance[constraint] + fallen, thickness, terms.stiffness[constraint]).slope;
        const double ratio = std::max((force.normal - left) / fallen / force.stiffness, 1.0 / max_softening);
        const Vec3& n = constraints.direction[constraint];
        add_normal_block(block.k, (ratio - 1.0) * quadratic_form(block.k, n), n);
    }
}

}  // namespace percale

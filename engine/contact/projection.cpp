#include "projection.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tolerances.h"

namespace percale {
namespace {

/// Fraction of the step matrix that the stiffness of a projected constraint has. Smaller: more rounds of multipliers. Larger:
/// each takes Newton longer.
constexpr double projection_stiffness_ratio = 1.0;

/// s, time constant with which cloth that is too near comes back to h. Shorter: it is thrown off. Longer: it stays too near.
constexpr double thickness_recovery_time = 0.05;

/// Fraction of the activation distance beyond its target within which a constraint's force ends. 1: constraints that leave the
/// activation distance still push.
constexpr double multiplier_activation_ratio = 0.9;

constexpr ConstraintClearance leaving{.activation_ratio = projection_activation_ratio, .ratio = contact_accuracy};

/// No clearance is as large: only forces of constraints that are gone move on.
constexpr ConstraintClearance gone{.activation_ratio = projection_activation_ratio,
                                   .ratio = std::numeric_limits<double>::infinity()};

/// One constraint at one point of the search.
struct ConstraintState {
    Vec3 normal;
    double stiffness = 0.0;   // k, N/m
    ContactPotential spring;  // added to the multiplier: pulls beyond the target distance
    double approach = 0.0;    // m, target distance minus distance
    Vec3 slip;                // m/s
    double friction = 0.0;    // mu
    double mollifier = 1.0;   // factor of all its forces
};

/// What a constraint depends on beside the point.
struct ConstraintPast {
    double min_distance = 0.0;         // ContactWarmStart::min_distance
    double multiplier = 0.0;           // N, normal part
    const std::vector<double>& crowd;  // ProjectedContact::pushing_weight_
};

/// k = ratio/(dt^2 W), W = sum c w^2/(n.A n) over the vertices, n.A^-1 n if these had no neighbours and c constraints shared the
/// stiffness of a vertex. Without c a dozen constraints with a finely meshed obstacle are a dozen times as stiff as their cloth.
double constraint_stiffness(const ContactConstraints& constraints, std::size_t constraint, const ContactStep& step,
                            const std::vector<double>& crowd) {
    double compliance = 0.0;
    for (int k = 0; k < 4 && constraints.vertex[constraint][k] >= 0; ++k) {
        const double weight = constraints.weight[constraint][k];
        const std::size_t vertex = constraints.vertex[constraint][k];
        const double sharing = vertex < crowd.size() ? std::max(1.0, crowd[vertex]) : 1.0;
        compliance += sharing * weight * weight /
                      quadratic_form(step.diagonal->block(constraints.vertex[constraint][k]), constraints.direction[constraint]);
    }
    return projection_stiffness_ratio / (step.dt * step.dt * compliance);
}

/// The distance that a constraint has to keep: the thickness; if it began nearer, only part of the gap is restored, as pushing it
/// out at once would throw the cloth off. Its start distance follows from its velocity, but is at least `kept`.
double target_distance(double thickness, double kept, double began, double dt) {
    const double start = std::clamp(began, std::min(kept, thickness), thickness);
    return thickness - (thickness - start) * std::exp(-dt / thickness_recovery_time);
}

/// Distance, target distance and activation distance of a constraint, m.
struct ConstraintRange {
    double distance = 0.0, target = 0.0, activation_distance = 0.0;
};

/// The force beside the multiplier: k (target - d), but as 1/d below half of the target (spring_potential), as a motion that
/// only multipliers can stop must not reach d = 0 first, and so steep beyond the target that the constraint's force ends before
/// the activation distance.
ContactPotential constraint_spring(const ConstraintRange& range, double multiplier, double stiffness) {
    if (range.distance < range.target) return spring_potential(range.distance, range.target, stiffness);
    const double depth = range.target - range.distance;
    const double steep =
        std::max(stiffness, multiplier / (multiplier_activation_ratio * (range.activation_distance - range.target)));
    return {0.5 * steep * depth * depth, steep * depth, steep};
}

ConstraintState constraint_state(const ContactPoint& point, std::size_t constraint, const ConstraintPast& past) {
    const ContactConstraints& constraints = point.constraints;
    Vec3 velocity = Vec3::Zero();
    for (int k = 0; k < 4 && constraints.vertex[constraint][k] >= 0; ++k) {
        velocity += constraints.weight[constraint][k] * point.velocities.at(constraints.vertex[constraint][k]);
    }
    const Vec3 &n = constraints.direction[constraint], &displacement = constraints.obstacle_displacement[constraint];
    const double thickness = constraints.thickness[constraint] / projection_activation_ratio;
    const double began =
        constraints.distance[constraint] - n.dot(point.step.dt * velocity - point.obstacles_moved * displacement);
    const double target = target_distance(thickness, past.min_distance * thickness, began, point.step.dt);
    const double stiffness = constraint_stiffness(constraints, constraint, point.step, past.crowd);
    return {.normal = n,
            .stiffness = stiffness,
            .spring = constraint_spring({constraints.distance[constraint], target, constraints.thickness[constraint]},
                                        past.multiplier, stiffness),
            .approach = target - constraints.distance[constraint],
            .slip = tangential(velocity - point.step.obstacle_rate * displacement, n),
            .friction = constraints.friction[constraint],
            .mollifier = constraints.mollifier[constraint]};
}

/// The force of a constraint, N; adds its matrix, kg, to the block; no matrix if it does not push, or is subtracted.
ConstraintForce constraint_force(const ConstraintState& constraint, const ConstraintForce& multiplier, double dt,
                                 SymmetricBlock& block) {
    const double size_of_factor = std::abs(constraint.mollifier);
    ConstraintForce force{.normal = size_of_factor * std::max(0.0, multiplier.normal + constraint.spring.slope),
                          .stiffness = constraint.stiffness};
    if (force.normal == 0.0) return force;
    const double damping = size_of_factor * constraint.stiffness * dt, limit = constraint.friction * force.normal;
    const Vec3 trial = size_of_factor * tangential(multiplier.friction, constraint.normal) - damping * constraint.slip;
    const double size = trial.norm();
    const bool slides = size > limit;
    const double kept = slides ? limit / size : 1.0;
    force.friction = kept * trial;
    if (constraint.mollifier < 0.0) return {.normal = -force.normal, .friction = -force.friction, .stiffness = force.stiffness};
    const Vec3 along = slides ? Vec3(trial / size) : Vec3(Vec3::Zero());
    const double normal_part = size_of_factor * dt * dt * constraint.spring.curvature,
                 slip_part = constraint.friction > 0.0 ? dt * damping * kept : 0.0;
    add_normal_block(block, normal_part, constraint.normal);
    add_tangent_block(block, slip_part, constraint.normal, along);
    return force;
}

/// Its derivative by the distance is -force; the part of the multiplier counts from the target on.
double constraint_energy(const ConstraintState& constraint, double multiplier, double force) {
    if (force == 0.0) return -0.5 * constraint.mollifier * multiplier * multiplier / constraint.spring.curvature;
    return constraint.mollifier * (multiplier * constraint.approach + constraint.spring.energy);
}

Vec3 total(const ContactConstraints& constraints, std::size_t constraint, const ConstraintForce& force) {
    return force.normal * constraints.direction[constraint] + force.friction;
}

void take(const ContactConstraints& constraints, const std::vector<ConstraintForce>& forces, ContactMultipliers& multipliers) {
    multipliers.clear(constraints.size());
    for (std::size_t constraint = 0; constraint < constraints.size(); ++constraint) {
        if (!(forces[constraint].normal > 0.0)) continue;
        ConstraintForce multiplier = forces[constraint];
        multiplier.direction = constraints.direction[constraint];
        multipliers.add(constraint_key(constraints, constraint), multiplier);
    }
}

}  // namespace

double ProjectedContact::activation_ratio() const { return projection_activation_ratio; }

void ProjectedContact::begin(const ContactWarmStart& warm_start) {
    multipliers_ = warm_start.lasting;
    min_distance_ = warm_start.min_distance;
}

const ContactMultipliers& ProjectedContact::multipliers_at(const ContactConstraints& constraints) const {
    std::size_t found = 0;
    for (std::size_t constraint = 0; constraint < constraints.size(); ++constraint) {
        if (constraints.obstacle[constraint] >= 0) found += multipliers_.knows(constraint_key(constraints, constraint));
    }
    if (found == multipliers_.count_with_obstacles()) return multipliers_;
    moved_on_ = multipliers_;
    moved_on_.transfer(constraints, gone);
    return moved_on_;
}

void ProjectedContact::evaluate(const ContactPoint& point, ContactForces forces) const {
    const ContactConstraints& constraints = point.constraints;
    const ContactMultipliers& multipliers = multipliers_at(constraints);
    ContactTerms& terms = forces.terms;
    terms.clear();
    forces.constraint_forces.clear();
    for (std::size_t constraint = 0; constraint < constraints.size(); ++constraint) {
        CoupledBlock block{.vertex = constraints.vertex[constraint],
                           .weight = constraints.weight[constraint],
                           .k = {},
                           .constraint = static_cast<int>(constraint)};
        const ConstraintForce multiplier = multipliers.of(constraint_key(constraints, constraint));
        const ConstraintState state = constraint_state(point, constraint, {min_distance_, multiplier.normal, pushing_weight_});
        const ConstraintForce& force =
            forces.constraint_forces.emplace_back(constraint_force(state, multiplier, point.step.dt, block.k));
        terms.energy += constraint_energy(state, multiplier.normal, force.normal);
        if (force.normal == 0.0) continue;
        const Vec3 whole = total(constraints, constraint, force);
        spread(constraints, constraint, whole, forces.total);
        if (force.normal > 0.0) terms.blocks.push_back(block);
        terms.largest_stiffness = std::max(terms.largest_stiffness, state.stiffness);
        terms.obstacle_power += whole.dot(constraints.obstacle_displacement[constraint]) * point.step.obstacle_rate;
    }
}

void ProjectedContact::set_constraints(const ContactConstraints& constraints) {
    multipliers_.transfer(constraints, leaving);
    std::fill(pushing_weight_.begin(), pushing_weight_.end(), 0.0);
    for (std::size_t constraint = 0; constraint < constraints.size(); ++constraint) {
        const bool near = constraints.distance[constraint] * projection_activation_ratio < constraints.thickness[constraint];
        if (!near && multipliers_.of(constraint_key(constraints, constraint)).normal == 0.0) continue;
        for (int k = 0; k < 4 && constraints.vertex[constraint][k] >= 0; ++k) {
            const std::size_t vertex = constraints.vertex[constraint][k];
            if (vertex >= pushing_weight_.size()) pushing_weight_.resize(vertex + 1, 0.0);
            pushing_weight_[vertex] += constraints.mollifier[constraint] * std::abs(constraints.weight[constraint][k]);
        }
    }
}

double ProjectedContact::mismatch(const ContactConstraints& constraints, const std::vector<ConstraintForce>& forces) const {
    double largest = 0.0;
    const ContactMultipliers& multipliers = multipliers_at(constraints);
    for (std::size_t constraint = 0; constraint < constraints.size(); ++constraint) {
        const ConstraintForce before = multipliers.of(constraint_key(constraints, constraint));
        const double change =
            std::hypot(forces[constraint].normal - before.normal, (forces[constraint].friction - before.friction).norm());
        if (change > 0.0) largest = std::max(largest, change / forces[constraint].stiffness);
    }
    return largest;
}

bool ProjectedContact::correct(const ContactPoint& point, ContactForces forces, double enough) {
    const ContactConstraints& constraints = point.constraints;
    if (mismatch(constraints, forces.constraint_forces) <= enough) return false;
    for (std::size_t constraint = 0; constraint < constraints.size(); ++constraint) {
        spread(constraints, constraint, -total(constraints, constraint, forces.constraint_forces[constraint]), forces.total);
    }
    take(constraints, forces.constraint_forces, multipliers_);
    evaluate(point, forces);
    return true;
}

void ProjectedContact::end(const ContactConstraints& constraints, const ContactTerms&,
                           const std::vector<ConstraintForce>& constraint_forces, ContactWarmStart& warm_start) {
    warm_start.last.transfer(constraints, leaving);  // the lasting forces may have moved on during the substep
    std::vector<ConstraintForce>& lasting = lasting_forces_;
    lasting = constraint_forces;
    for (std::size_t constraint = 0; constraint < constraints.size(); ++constraint) {
        const double before = warm_start.last.of(constraint_key(constraints, constraint)).normal;
        if (lasting[constraint].normal <= before) continue;
        lasting[constraint].friction *= before / lasting[constraint].normal;
        lasting[constraint].normal = before;
    }
    take(constraints, lasting, warm_start.lasting);
    take(constraints, constraint_forces, warm_start.last);
    warm_start.min_distance = 1.0;
    for (std::size_t constraint = 0; constraint < constraints.size(); ++constraint) {
        warm_start.min_distance =
            std::min(warm_start.min_distance,
                     constraints.distance[constraint] * projection_activation_ratio / constraints.thickness[constraint]);
    }
}

ContactLoss ProjectedContact::loss(const ContactMove& move, double stored) const {
    ContactLoss loss;
    for (std::size_t constraint = 0; constraint < move.constraints.size(); ++constraint) {
        const ConstraintForce& force = move.constraint_forces[constraint];
        const Vec3 moved = relative_move(move, constraint);
        loss.contact -= force.normal * move.constraints.direction[constraint].dot(moved);
        loss.friction -= force.friction.dot(moved);
    }
    loss.contact += stored - move.terms.energy;
    return loss;
}

}  // namespace percale

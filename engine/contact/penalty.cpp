#include "penalty.h"

#include <algorithm>
#include <cmath>

#include "contact_stiffness.h"
#include "tolerances.h"

namespace percale {
namespace {

/// Fraction of h. A constraint's distance at the start of a move counts as at least this: the ledger's potential has no bound at
/// 0.
constexpr double min_start_ratio = 1e-3;

/// Fraction of a block that is left whatever is subtracted from it. 0: the matrix lets vertices fall through. 1: Newton's steps
/// are too short, and stop too early: layers tremble.
constexpr double min_block_ratio = 0.1;

/// kg, 1/sum w^2/m: of both sides of a constraint between cloths in series.
double mass_between_cloths(const ContactConstraints& constraints, std::size_t constraint, const ContactStep& step) {
    double mobility = 0.0;
    for (int k = 0; k < 4 && constraints.vertex[constraint][k] >= 0; ++k) {
        const double weight = constraints.weight[constraint][k];
        mobility += weight * weight / (*step.mass)[constraints.vertex[constraint][k]];
    }
    return 1.0 / mobility;
}

/// Adds a vertex with a weight to the scale of its side.
void add_vertex(const ContactStep& step, int vertex, double weight, ContactScale& scale) {
    scale.weight += weight * (*step.mass)[vertex] * step.gravity;
    scale.modulus += weight * (*step.modulus)[vertex];
    scale.length += weight * (*step.length)[vertex];
}

/// The stiffness of a constraint, of two cloths in series; below 0 where the constraint is subtracted.
ContactStiffness constraint_stiffness(const ContactConstraints& constraints, std::size_t constraint, const ContactStep& step) {
    ContactScale first, second;
    for (int k = 0; k < 4 && constraints.vertex[constraint][k] >= 0; ++k) {
        const double weight = constraints.weight[constraint][k];
        add_vertex(step, constraints.vertex[constraint][k], std::abs(weight), weight > 0.0 ? first : second);
    }
    const double h = constraints.thickness[constraint], mollifier = constraints.mollifier[constraint];
    const ContactStiffness stiffness = constraints.obstacle[constraint] >= 0
                                           ? contact_stiffness(first, h)
                                           : in_series(contact_stiffness(first, h), contact_stiffness(second, h));
    return {mollifier * stiffness.quadratic, mollifier * stiffness.quartic};
}

/// Adds the normal force of a constraint with an obstacle to the friction contacts of its vertices. Opposed normals, from the two
/// sides of a gap, both add to the limit; what is subtracted has no direction of its own (below 0: only to the load).
void add_normal_force(const ContactConstraints& constraints, std::size_t constraint, double normal_force, const ContactStep& step,
                      FrictionContacts& friction_contacts) {
    const std::span<const ObstacleMotion> obstacle_motions = step.friction->obstacle_motions;
    const bool deforms = constraints.obstacle[constraint] < static_cast<int>(obstacle_motions.size()) &&
                         obstacle_motions[constraints.obstacle[constraint]].deforms;
    const Vec3 friction_limit = constraints.friction[constraint] * normal_force * constraints.direction[constraint];
    for (int k = 0; k < 4 && constraints.vertex[constraint][k] >= 0; ++k) {
        if (constraints.weight[constraint][k] <= 0.0) continue;
        FrictionContact& friction_contact =
            friction_contacts.get(constraints.vertex[constraint][k], constraints.obstacle[constraint]);
        const double load = constraints.weight[constraint][k] * normal_force;
        friction_contact.load += load;
        friction_contact.stick_threshold = stick_threshold_ratio * constraints.thickness[constraint];
        if (deforms) friction_contact.carried += load * constraints.obstacle_displacement[constraint];
        if (normal_force < 0.0) continue;
        friction_contact.pressed += load;
        friction_contact.friction_limit += (friction_contact.friction_limit.dot(friction_limit) < 0.0 ? -1.0 : 1.0) *
                                           constraints.weight[constraint][k] * friction_limit;
    }
}

/// What is subtracted reduces the limit of a vertex by the part that it is of what presses.
void reduce_limit(FrictionContact& contact) {
    if (contact.load < contact.pressed) contact.friction_limit *= std::max(0.0, contact.load / contact.pressed);
}

/// The direction in which the matrix leaves a vertex free, an active set: a contact that stuck and slipped slides, one that
/// turned back sticks. At its first evaluation it slides if it is old or if friction at its limit cannot stop it within the step.
Vec3 slip_direction(const FrictionContact& friction_contact, const ContactStep& step) {
    const double length = friction_contact.slip.norm();
    if (!friction_contact.law().slides(length)) return Vec3::Zero();
    const Vec3 along = friction_contact.slip / length;
    if (const FrictionContact* before =
            step.previous ? step.previous->find(friction_contact.vertex, friction_contact.obstacle) : nullptr) {
        if (friction_contact.slip == before->slip) return before->slip_direction;  // only other vertices have moved
        return along.dot(before->slip_direction) < 0.0 ? Vec3(Vec3::Zero()) : along;
    }
    const double stopping = step.dt * step.dt * friction_contact.friction_limit.norm();
    return friction_contact.had_anchor || length * (*step.mass)[friction_contact.vertex] > stopping ? along : Vec3(Vec3::Zero());
}

/// Adds force and matrix of a friction contact with a known friction limit.
void add_friction(const ContactStep& step, const Vec3Arrays& positions, FrictionContact& friction_contact, Vec3Arrays& forces,
                  ContactTerms& terms) {
    set_slip(*step.friction, positions.at(friction_contact.vertex), step.fraction, friction_contact);
    friction_contact.slip_direction = slip_direction(friction_contact, step);
    const CoulombLaw law = friction_contact.law();
    CoupledBlock block{.vertex = {friction_contact.vertex, -1, -1, -1}, .weight = {1.0, 0.0, 0.0, 0.0}, .k = {}};
    add_tangent_block(block.k, step.dt * step.dt * law.stiffness(friction_contact.slip.norm()),
                      friction_contact.friction_limit / law.limit, friction_contact.slip_direction);
    terms.blocks.push_back(block);
    const Vec3 force = law.force(friction_contact.slip);
    forces.add(friction_contact.vertex, force);
    terms.obstacle_power += force.dot(friction_contact.obstacle_displacement) * step.obstacle_rate;
}

/// Whether the matrix lets a cloth-cloth friction contact beyond its stick threshold slide: at the first evaluation if it had an
/// anchor or if friction at its limit cannot stop it within the step, later always.
bool slides(const ContactConstraints& constraints, const ClothFrictionContact& cloth_contact, const ContactStep& step) {
    const double length = cloth_contact.slip.norm();
    if (!cloth_contact.law.slides(length)) return false;
    if (step.previous || cloth_contact.had_anchor) return true;
    const double mass = mass_between_cloths(constraints, cloth_contact.constraint, step);
    return length * mass > step.dt * step.dt * cloth_contact.law.limit;
}

/// Friction force of a constraint between two cloths; its matrix is added to the block of the constraint.
Vec3 friction_between_cloths(const ContactConstraints& constraints, const ClothFrictionContact& cloth_contact,
                             const ContactStep& step, CoupledBlock& block) {
    const double length = cloth_contact.slip.norm();
    const Vec3 slip_direction = slides(constraints, cloth_contact, step) ? Vec3(cloth_contact.slip / length) : Vec3(Vec3::Zero());
    add_tangent_block(block.k, step.dt * step.dt * cloth_contact.law.stiffness(length),
                      constraints.direction[cloth_contact.constraint], slip_direction);
    return cloth_contact.law.force(cloth_contact.slip);
}

/// Whether a constraint is of a vertex with faces of an obstacle or of cloth.
bool of_vertex(const ContactConstraints& constraints, std::size_t constraint) {
    return constraints.vertex[constraint][1] < 0 || is_of_vertex(constraints.weight[constraint]);
}

/// On which side of the vertex the constraint holds cloth.
int side_of(const VertexStiffness& of, const Vec3& direction) { return of.first_side.dot(direction) < 0.0 ? 1 : 0; }

/// What is subtracted has no block, or the matrix would not be positive definite. Over a valley, in which faces count less their
/// edge, it would be up to three times too stiff, in a pile nearly everywhere; the blocks of a vertex are reduced by what is
/// subtracted on that side of it.
void reduce_blocks(const ContactConstraints& constraints, const std::vector<ConstraintForce>& forces, int vertices,
                   ContactTerms& terms) {
    std::vector<VertexStiffness>& stiffness = terms.vertex_stiffness;
    stiffness.assign(vertices, {});
    for (std::size_t constraint = 0; constraint < constraints.size(); ++constraint) {
        if (!of_vertex(constraints, constraint)) continue;
        VertexStiffness& of = stiffness[constraints.vertex[constraint][0]];
        if (of.first_side.isZero(0.0)) of.first_side = constraints.direction[constraint];
        const int side = side_of(of, constraints.direction[constraint]);
        (constraints.mollifier[constraint] > 0.0 ? of.added : of.subtracted)[side] += std::abs(forces[constraint].stiffness);
    }
    for (CoupledBlock& block : terms.blocks) {
        if (!of_vertex(constraints, block.constraint)) continue;
        const VertexStiffness& of = stiffness[block.vertex[0]];
        const int side = side_of(of, constraints.direction[block.constraint]);
        if (of.subtracted[side] == 0.0 || of.added[side] == 0.0) continue;
        const double ratio = std::max(min_block_ratio, 1.0 - of.subtracted[side] / of.added[side]);
        for (double& entry : block.k) entry *= ratio;
    }
}

/// The loss of a move, and the energy, J, that the constraints at its end would have stored at its start with their stiffness:
/// their distances and slips are moved back with the relative velocity.
struct PenaltyLoss {
    double friction = 0.0, integrator = 0.0, stored_at_start = 0.0;
};

void add_constraint_loss(const ContactMove& move, std::size_t constraint, PenaltyLoss& loss) {
    const ContactStiffness& stiffness = move.terms.stiffness[constraint];
    const Vec3& n = move.constraints.direction[constraint];
    const double h = move.constraints.thickness[constraint], d = move.constraints.distance[constraint];
    if (d >= h) return;
    const double opened = n.dot(relative_move(move, constraint));
    const double began = std::max(d - opened, std::min(d, min_start_ratio * h));
    const ContactPotential end = contact_potential(d, h, stiffness), start = contact_potential(began, h, stiffness);
    loss.stored_at_start += start.energy;
    loss.integrator += start.energy - end.energy - end.slope * opened;
}

/// A slip, the part of it that belongs to the move, and the path along which its force acts in the move, m.
struct MovedSlip {
    Vec3 slip, moved, path;
};

void add_friction_loss(const CoulombLaw& law, const MovedSlip& of, PenaltyLoss& loss) {
    const auto& [slip, moved, path] = of;
    const double end = law.potential(slip.norm()), start = law.potential((slip - moved).norm());
    loss.friction += law.limit * std::max(slip.norm() - law.stick_threshold, 0.0);
    loss.stored_at_start += start;
    loss.integrator += start - end - law.force(slip).dot(path);
}

void add_friction_contact_loss(const ContactMove& move, const FrictionContact& friction_contact, PenaltyLoss& loss) {
    const CoulombLaw law = friction_contact.law();
    if (law.limit == 0.0) return;
    const Vec3 along = move.end.at(friction_contact.vertex) - move.start.at(friction_contact.vertex) -
                       move.dt * move.obstacle_rate * friction_contact.obstacle_displacement;
    const Vec3 moved = tangential(along, friction_contact.friction_limit / law.limit);
    add_friction_loss(law, {friction_contact.slip, moved, moved}, loss);
}

}  // namespace

void add_contact(const ContactConstraints& constraints, const ContactStep& step, const Vec3Arrays& positions, Vec3Arrays& forces,
                 ContactTerms& terms, std::vector<ConstraintForce>& constraint_forces) {
    terms.clear();
    constraint_forces.clear();
    terms.friction_contacts.clear(positions.padded_size());
    bool subtracts = false;
    for (std::size_t constraint = 0; constraint < constraints.size(); ++constraint) {
        terms.stiffness.push_back(constraint_stiffness(constraints, constraint, step));
        const ContactPotential potential =
            contact_potential(constraints.distance[constraint], constraints.thickness[constraint], terms.stiffness.back());
        constraint_forces.push_back({.normal = potential.slope, .stiffness = potential.curvature});
        CoupledBlock block{.vertex = constraints.vertex[constraint],
                           .weight = constraints.weight[constraint],
                           .k = {},
                           .constraint = static_cast<int>(constraint)};
        add_normal_block(block.k, step.dt * step.dt * potential.curvature, constraints.direction[constraint]);
        Vec3 force = potential.slope * constraints.direction[constraint];
        const bool has_friction = step.friction && constraints.friction[constraint] * potential.slope != 0.0,
                   on_obstacle = constraints.obstacle[constraint] >= 0;
        if (has_friction && !on_obstacle) {
            terms.cloth_friction_contacts.push_back(
                cloth_friction_contact(*step.friction, constraints, static_cast<int>(constraint), potential.slope, positions));
            force += friction_between_cloths(constraints, terms.cloth_friction_contacts.back(), step, block);
        }
        spread(constraints, constraint, force, forces);
        if (constraints.mollifier[constraint] > 0.0)
            terms.blocks.push_back(block);
        else
            subtracts = true;
        terms.energy += potential.energy;
        terms.largest_stiffness = std::max(terms.largest_stiffness, potential.curvature);
        terms.obstacle_power += force.dot(constraints.obstacle_displacement[constraint]) * step.obstacle_rate;
        if (has_friction && on_obstacle)
            add_normal_force(constraints, constraint, potential.slope, step, terms.friction_contacts);
    }
    if (subtracts) reduce_blocks(constraints, constraint_forces, static_cast<int>(step.mass->size()), terms);
    for (FrictionContact& friction_contact : terms.friction_contacts.all) {
        reduce_limit(friction_contact);
        if (!friction_contact.friction_limit.isZero(0.0)) add_friction(step, positions, friction_contact, forces, terms);
    }
}

void PenaltyContact::evaluate(const ContactPoint& point, ContactForces forces) const {
    add_contact(point.constraints, point.step, point.positions, forces.total, forces.terms, forces.constraint_forces);
    forces.potential += forces.terms.energy;
}

void PenaltyContact::end(const ContactConstraints& constraints, const ContactTerms& terms, const std::vector<ConstraintForce>&,
                         ContactWarmStart& warm_start) {
    anchors_.keep(constraints, terms.cloth_friction_contacts, warm_start.cloth_anchors);
}

ContactLoss PenaltyContact::loss(const ContactMove& move, double stored) const {
    PenaltyLoss loss;
    for (std::size_t constraint = 0; constraint < move.constraints.size(); ++constraint)
        add_constraint_loss(move, constraint, loss);
    for (const FrictionContact& friction_contact : move.terms.friction_contacts.all)
        add_friction_contact_loss(move, friction_contact, loss);
    for (const ClothFrictionContact& cloth_contact : move.terms.cloth_friction_contacts)
        add_friction_loss(cloth_contact.law,
                          {cloth_contact.slip, cloth_contact.moved, relative_move(move, cloth_contact.constraint)}, loss);
    return {.friction = loss.friction, .contact = stored - loss.stored_at_start, .integrator = loss.integrator};
}

}  // namespace percale

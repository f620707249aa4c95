#pragma once

#include <array>
#include <vector>

#include "forces/blocks.h"
#include "friction.h"
#include "model/vec3_arrays.h"
#include "multipliers.h"
#include "percale/contact.h"
#include "potential.h"

namespace percale {

/// What a contact law needs to know of the stage in which it is evaluated.
struct ContactStep {
    double dt = 0.0;                               // s, h sqrt(weight of contact in the stage): the form of backward Euler
    double obstacle_rate = 0.0;                    // 1/s, obstacle velocity / obstacle_displacement
    double fraction = 0.0;                         // of the whole step, where the obstacles are
    const std::vector<double>* mass = nullptr;     // kg, of each vertex
    double gravity = 0.0;                          // m/s^2
    const std::vector<double>* modulus = nullptr;  // N/m, of each vertex, for penalty
    const std::vector<double>* length = nullptr;   // m, likewise (ContactScale)
    const DiagonalBlocks* diagonal = nullptr;      // of the elastic step matrix at the stage's first evaluation; frozen
    const FrictionStart* friction = nullptr;       // null: without friction
    const FrictionContacts* previous = nullptr;    // of the last accepted Newton iterate; null at the first evaluation
};

/// The stiffness of a vertex' constraints with faces on its two sides, N/m: of those that have blocks, and of those subtracted.
struct VertexStiffness {
    Vec3 first_side = Vec3::Zero();  // direction of the first constraint; zero: there is none
    std::array<double, 2> added{}, subtracted{};
};

/// The result of one evaluation of contact.
struct ContactTerms {
    std::vector<CoupledBlock> blocks;  // those of constraints, then one per friction contact
    FrictionContacts friction_contacts;
    std::vector<ClothFrictionContact> cloth_friction_contacts;  // of the constraints between cloths
    std::vector<ContactStiffness> stiffness;                    // of each constraint, with penalty
    std::vector<VertexStiffness> vertex_stiffness;              // work space of penalty
    double energy = 0.0;                                        // J, without friction
    double largest_stiffness = 0.0;                             // N/m
    double obstacle_power = 0.0;                                // W, of the obstacles on the cloth

    void clear() {
        blocks.clear();
        cloth_friction_contacts.clear();
        stiffness.clear();
        energy = largest_stiffness = obstacle_power = 0.0;
    }
};

/// One point of the search, as the contact law sees it.
struct ContactPoint {
    const ContactConstraints& constraints;
    const Vec3Arrays& positions;   // m
    const Vec3Arrays& velocities;  // m/s
    ContactStep step;
    double obstacles_moved = 0.0;  // the part of the whole step between the start of the stage and this point
};

/// The output of a contact law at a point.
struct ContactForces {
    Vec3Arrays& total;                                // N, the contact forces are added
    double& potential;                                // J, the contact energy is added
    ContactTerms& terms;                              // filled anew
    std::vector<ConstraintForce>& constraint_forces;  // filled anew, one entry per constraint
};

/// The warm start of contact: what one implicit stage passes on to the next, within a substep and beyond.
struct ContactWarmStart {
    ContactMultipliers last, lasting;        // forces at the end of the last stage; those that lasted for two stages
    std::vector<ClothAnchor> cloth_anchors;  // for penalty: of friction between cloths at that end
    double energy = 0.0;                     // J, without friction, at that end
    double min_distance = 0.0;               // smallest distance over thickness of the constraints at that end; 0 if unknown

    void forget() { *this = {}; }
};

/// A straight move of the cloth that ended with these contacts.
struct ContactMove {
    const ContactConstraints& constraints;
    const ContactTerms& terms;
    const std::vector<ConstraintForce>& constraint_forces;
    const Vec3Arrays& start;  // m
    const Vec3Arrays& end;    // m
    double dt;                // s, duration of the move
    double obstacle_rate;     // 1/s, obstacle velocity / obstacle_displacement
};

/// Energy that contact forces take from the cloth beyond the change of their own energy, without the work of obstacles, J.
struct ContactLoss {
    double friction = 0.0;  // friction force times slip
    /// Penalty: the energy stored at the start less what the constraints of the end would store there. Projection: what the
    /// normal forces take beyond the change of the contact energy.
    double contact = 0.0;
    double integrator = 0.0;  // Bregman terms of the potentials of constraints and of the sticking springs; >= 0
};

/// A contact law: how contact acts on the cloth, by penalty springs (penalty.h) or by an augmented Lagrangian (projection.h).
class ContactLaw {
public:
    virtual ~ContactLaw() = default;

    /// The activation distance of the law over the thickness: the law needs all contacts that are nearer.
    virtual double activation_ratio() const = 0;

    /// Begins a stage from the warm start of the last one.
    virtual void begin(const ContactWarmStart& warm_start) = 0;
    /// Passes the constraints of the stage's first evaluation, which follows the clamped move to q* + h v_n.
    virtual void set_constraints(const ContactConstraints& constraints) = 0;
    /// Computes the forces and the matrix blocks at a point.
    virtual void evaluate(const ContactPoint& point, ContactForces forces) const = 0;
    /// Outer iteration of the augmented Lagrangian, after Newton has converged at a point: where the largest error of a
    /// constraint exceeds `enough`, m, updates the multipliers and evaluates anew. False: converged, also for a law without
    /// multipliers.
    virtual bool correct(const ContactPoint& point, ContactForces forces, double enough) = 0;
    /// The stage ends at a point with these constraints, terms and forces; writes the warm start of the next one.
    virtual void end(const ContactConstraints& constraints, const ContactTerms& terms,
                     const std::vector<ConstraintForce>& constraint_forces, ContactWarmStart& warm_start) = 0;

    /// The loss of a move that ended with these contacts; `stored`: contact energy at its start, J.
    virtual ContactLoss loss(const ContactMove& move, double stored) const = 0;
};

/// The weighted displacement of a constraint's vertices relative to the displacement of its obstacle point, m.
Vec3 relative_move(const ContactMove& move, std::size_t constraint);

/// Obstacles move on while the cloth moves: the distance of a constraint changes by n.(dx - dp), where dp is the displacement
/// that is left to its obstacle point. A Newton direction thus solves A dv = -r + dt^2 P''(d) n n.dp/h. Adds the last term where
/// `free` is 1; the blocks of constraints hold dt^2 P'' n n^T. `rate`: the part of the whole step that is left in this stage,
/// over the stage's h, 1/s.
void add_obstacle_advance(const ContactConstraints& constraints, const ContactTerms& terms, double rate,
                          const AlignedVector<double>& free, Vec3Arrays& right_side);

/// Adds the force of a constraint to its vertices.
inline void spread(const ContactConstraints& constraints, std::size_t constraint, const Vec3& force, Vec3Arrays& forces) {
    for (int k = 0; k < 4 && constraints.vertex[constraint][k] >= 0; ++k)
        forces.add(constraints.vertex[constraint][k], constraints.weight[constraint][k] * force);
}

}  // namespace percale

#pragma once

#include <vector>

#include "forces/blocks.h"
#include "friction.h"
#include "model/vectors.h"
#include "multipliers.h"
#include "percale/contact.h"

namespace percale {

/// What contact needs of the stage that it is evaluated in.
struct ContactStep {
    double dt = 0.0;                            // s, of the stage being solved
    double stiffness_dt = 0.0;                  // s, that the masses' part of the stiffness is made for, where longer than dt
    double obstacle_rate = 0.0;                 // 1/s, obstacle velocity / obstacle_displacement
    double fraction = 0.0;                      // of the whole step, where obstacles are
    Vec3 gravity = Vec3::Zero();                // m/s^2
    const std::vector<double>* mass = nullptr;  // kg, of each vertex
    const DiagonalBlocks* diagonal = nullptr;   // of the elastic step matrix when the stage began; frozen
    const Vectors* load = nullptr;              // N, forces without contact when the stage began; null: gravity alone
    const FrictionStart* friction = nullptr;    // null: without friction
    const Touches* previous = nullptr;          // of the point that the search came from; null at the first evaluation
};

/// What one evaluation of contact leaves behind.
struct ContactTerms {
    std::vector<CoupledBlock> blocks;  // first `others`, then of the rows, then one of friction for each touch
    std::size_t others = 0;            // blocks of single vertices that other forces put there; contact keeps them
    Touches touches;
    std::vector<Rub> rubs;           // of rows between cloths
    double energy = 0.0;             // J, without friction
    double largest_stiffness = 0.0;  // N/m
    double obstacle_power = 0.0;     // W, of the obstacles on the cloth

    void clear() {
        blocks.resize(others);
        rubs.clear();
        energy = largest_stiffness = obstacle_power = 0.0;
    }
};

/// One point of the search as contact sees it.
struct ContactPoint {
    const ContactRows& rows;
    const Vectors& positions;   // m
    const Vectors& velocities;  // m/s
    ContactStep step;
    double obstacles_moved = 0.0;  // of the whole step, what lies between the stage's start and here
};

/// What contact does there.
struct ContactForces {
    Vectors& total;                     // N, contact is added
    double& potential;                  // J, likewise
    ContactTerms& terms;                // filled anew
    std::vector<RowForce>& row_forces;  // filled anew, one a row
};

/// What contact hands on from one span to the next.
struct ContactMemory {
    ContactMultipliers last, lasting;  // forces at the end of the last span; those that lasted for two
    ContactMultipliers held;           // then, between cloths by penalty: what friction holds (set_held)
    double least_distance = 0.0;       // of the thickness: the nearest row at that end; 0 if unknown

    void forget() { *this = {}; }
};

/// A straight move of the cloth that ended with these contacts.
struct ContactMove {
    const ContactRows& rows;
    const ContactTerms& terms;
    const std::vector<RowForce>& row_forces;
    const Vectors& start;  // m
    const Vectors& end;    // m
    double dt;             // s, that the move took
    double obstacle_rate;  // 1/s, obstacle velocity / obstacle_displacement
};

/// What contact forces took from the cloth beyond the change of their energy, obstacles' work left out, J.
struct ContactLoss {
    double friction = 0.0;    // friction force times slip
    double contact = 0.0;     // by contacts that are not those, or not as stiff as those, that the energy was stored in
    double integrator = 0.0;  // Bregman terms of the potentials of rows and of the springs by which friction holds; >= 0
};

/// How contact acts on the cloth. Two laws have this shape: penalty.h and projection.h.
class ContactLaw {
public:
    virtual ~ContactLaw() = default;

    /// The zone in which the law wants to know of contacts, in thicknesses.
    virtual double zone() const = 0;

    /// A stage begins, from what the last span handed on.
    virtual void begin(const ContactMemory& memory) = 0;
    /// The rows that it begins with are known.
    virtual void meet(const ContactRows& rows) = 0;
    /// Forces and blocks of the matrix at a point.
    virtual void evaluate(const ContactPoint& point, ContactForces forces) const = 0;
    /// The motion at a point is solved for. Changes what the law holds fixed meanwhile, where that is off by more than
    /// `enough`, m, and evaluates it anew; false if nothing is left to be solved.
    virtual bool correct(const ContactPoint& point, ContactForces forces, double enough) = 0;
    /// The span ends at a point with these rows, terms and forces: what it hands on.
    virtual void end(const ContactRows& rows, const ContactTerms& terms, const std::vector<RowForce>& row_forces,
                     ContactMemory& memory) = 0;

    /// Of a move that ended with these contacts; `stored`: energy of contact at its start, J.
    virtual ContactLoss loss(const ContactMove& move, double stored) const = 0;
};

/// How much farther a row's vertices, by their weights, moved than its obstacle point, m.
Vec3 relative_move(const ContactMove& move, std::size_t row);

/// Obstacles go on to their ends while the cloth moves: a row's distance changes by n.(dx - dp), dp the displacement that its
/// obstacle point still has, so a Newton direction solves A dv = -r + dt P''(d) n n.dp. Adds the last term where `free` is 1; the
/// blocks of rows hold dt^2 P'' n n^T. `rate`: the part of the whole step still to come over dt, 1/s.
void add_obstacle_advance(const ContactRows& rows, const ContactTerms& terms, double rate, const AlignedVector<double>& free,
                          Vectors& right_side);

/// Adds the force of a row to its vertices.
inline void spread(const ContactRows& rows, std::size_t row, const Vec3& force, Vectors& forces) {
    for (int k = 0; k < 4 && rows.vertex[row][k] >= 0; ++k) forces.add(rows.vertex[row][k], rows.weight[row][k] * force);
}

}  // namespace percale

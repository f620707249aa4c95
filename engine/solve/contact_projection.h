#pragma once

#include "contact_multipliers.h"
#include "forces/total_force.h"

namespace percale {

/// The contact zone that a detector is asked for when contact is projected, in thicknesses: rows have to be known before they
/// touch, and cloth at rest lies at the thickness itself.
constexpr double projection_zone = 1.2;

/// A point of the search as contact sees it.
struct ProjectedPoint {
    ContactStep step;
    const ContactRows* rows = nullptr;  // their thickness is the detector's zone
    const Vectors* velocities = nullptr;
    double obstacles_moved = 0.0;  // of the obstacles' way during the whole step, what lies in this part before the point
};

/// What contact does there.
struct ProjectedForces {
    Vectors& total;               // N, contact is added
    ContactTerms& terms;          // blocks of pushing rows only
    std::vector<RowForce>& rows;  // one a row
};

/// Contact as constraints: at the end of the step every row's distance is at least the thickness, and a row that is nearer pushes
/// with just the force that this takes (Signorini), with friction in Coulomb's cone: a row sticks, without any slip, or its
/// friction is mu times its push and against the slip.
///
/// Augmented Lagrangian (Alart and Curnier 1991; Simo and Laursen 1992): each row has a force l as multiplier and acts with
///     n max(0, l_n + k (h - d)) + P(l_t - k dt s),   P the projection onto the disc of radius mu times the push,
/// with slip velocity s. Newton solves for the motion with the multipliers fixed, then each multiplier becomes its row's force,
/// until neither changes: then d = h and s = 0 where rows push and stick, whatever k is. k is ten times what the step matrix
/// resists the row with, divided by dt^2: an error shrinks about elevenfold each time.
class ContactProjection {
public:
    /// A part of a step begins, from the multipliers that were kept last.
    void start_part();

    void add(const ProjectedPoint& point, ProjectedForces forces) const;

    /// A linear system is solved at this point next: its matrix holds the rows that push there.
    void solve_at(const ContactRows& rows, const std::vector<RowForce>& forces);

    /// After a full step along the solution: the forces there become the multipliers of the rows that the matrix held, and are
    /// exchanged for those that follow. Rows that it did not hold have not been solved for and start from 0.
    void advance(const ProjectedPoint& point, ProjectedForces forces);

    /// The part ends in a state with these forces: the next one starts with them.
    void keep(const ContactRows& rows, const std::vector<RowForce>& forces);

    /// Cloth or obstacles are not where the last part left them.
    void forget();

private:
    ContactMultipliers kept_, multipliers_, solved_;
    double kept_share_ = 0.0;  // of the thickness, the least distance of a kept row; 0 if unknown
};

}  // namespace percale

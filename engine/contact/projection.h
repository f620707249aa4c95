#pragma once

#include "multipliers.h"
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
/// with slip velocity s. Newton solves for the motion with the multipliers fixed, then each multiplier becomes its row's force:
/// where that changes nothing, d = h for rows that push and s = 0 for rows that stick, whatever k is. A step makes a few such
/// rounds, the next step goes on from its forces.
class ContactProjection {
public:
    /// A part of a step begins, from what was kept last: forces that lasted for two parts, as the push of an impact lasts for
    /// one.
    void start_part() { multipliers_ = lasting_; }

    /// The rows that it begins with are known: forces go on with the cloth, and rows share what their vertices can bear.
    void meet(const ContactRows& rows);

    void add(const ProjectedPoint& point, ProjectedForces forces) const;

    /// How far the forces of a point are from the multipliers, in m: the largest change of one over its k.
    double mismatch(const ContactRows& rows, const std::vector<RowForce>& forces) const;

    /// Makes the forces of a solved point the multipliers and exchanges them for those that follow.
    void advance(const ProjectedPoint& point, ProjectedForces forces);

    /// The part ends in a state with these forces.
    void keep(const ContactRows& rows, const std::vector<RowForce>& forces);

    /// Cloth or obstacles are not where the last part left them.
    void forget();

    /// All that one part hands on to the next.
    struct Kept {
        std::vector<KeyedForce> kept, lasting;
        double share = 0.0;
    };
    Kept kept() const { return {kept_.all(), lasting_.all(), kept_share_}; }
    void go_on_from(const Kept& kept);

private:
    ContactMultipliers kept_, lasting_, multipliers_;
    std::vector<RowForce> lasting_forces_;  // scratch space of keep
    std::vector<double> crowd_;             // of each vertex, the rows that push it as the part begins, by their weights
    double kept_share_ = 0.0;               // of the thickness, the least distance of a kept row; 0 if unknown
};

}  // namespace percale

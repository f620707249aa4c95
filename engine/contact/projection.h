#pragma once

#include "contact_law.h"
#include "potential.h"

namespace percale {

/// Contact as constraints: at the end of the step every row's distance is at least the thickness, and a row that is nearer pushes
/// with just the force that this takes (Signorini), with friction in Coulomb's cone: a row sticks, without any slip, or its
/// friction is mu times its push and against the slip.
///
/// Augmented Lagrangian (Alart and Curnier 1991; Simo and Laursen 1992): each row has a force l as multiplier and acts with
///     n max(0, l_n + k (h - d)) + P(l_t - k dt s),   P the projection onto the disc of radius mu times the push,
/// with slip velocity s. Newton solves for the motion with the multipliers fixed, then each multiplier becomes its row's force:
/// where that changes nothing, d = h for rows that push and s = 0 for rows that stick, whatever k is. A step makes a few such
/// rounds, the next step goes on from its forces.
class ProjectedContact final : public ContactLaw {
public:
    double zone() const override;

    /// From the forces that lasted for two spans, as the push of an impact lasts for one.
    void begin(const ContactMemory& memory) override;

    /// Forces go on with the cloth, and rows share what their vertices can bear.
    void meet(const ContactRows& rows) override;

    /// Blocks of pushing rows only. The potential is left as it is: that of the multipliers changes with them.
    void evaluate(const ContactPoint& point, ContactForces forces) const override;

    /// How far the forces of a point are from the multipliers, in m: the largest change of one over its k.
    double mismatch(const ContactRows& rows, const std::vector<RowForce>& forces) const;

    /// Makes the forces of a solved point the multipliers and exchanges them for those that follow.
    bool correct(const ContactPoint& point, ContactForces forces, double enough) override;

    void end(const ContactRows& rows, const ContactTerms& terms, const std::vector<RowForce>& row_forces,
             ContactMemory& memory) override;

    /// A row's push is a constraint's: what it takes from motion towards the obstacle is gone.
    ContactLoss loss(const ContactMove& move, double stored) const override;

private:
    ContactMultipliers multipliers_;
    std::vector<RowForce> lasting_forces_;  // scratch space of end
    std::vector<double> crowd_;             // of each vertex, the rows that push it as the stage begins, by their weights
    double least_distance_ = 0.0;           // ContactMemory::least_distance
};

}  // namespace percale

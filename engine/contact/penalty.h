#pragma once

#include "contact_law.h"
#include "potential.h"

namespace percale {

/// Penalty springs with Coulomb friction. forces += contact forces, N; fills `terms` and the normal parts of `row_forces`.
/// Between cloths the slip is that of one side along the other (Rub), and n.A n and masses are those of both sides in series,
/// 1/sum w^2/a.
/// Stiffness of a row: half of n.A n/dt^2 summed over its vertices by weight, A the frozen diagonal blocks (the share of the
/// masses for `stiffness_dt`, unless the obstacle moves: a step that is suddenly shorter must not throw up what lies there), but
/// at least four times (weight on the row, or what its vertices press with)/thickness, so that cloth rests at no less than 3/4 of
/// the thickness. Friction with obstacles acts on vertices (friction.h), each pressed by its share of all rows with the same
/// obstacle; in the matrix a sliding one is free along its slip.
void add_contact(const ContactRows& rows, const ContactStep& step, const Vectors& positions, Vectors& forces, ContactTerms& terms,
                 std::vector<RowForce>& row_forces);

/// Contact as penalty springs with Coulomb friction (add_contact). Every evaluation stands by itself: nothing is held fixed while
/// Newton solves, and nothing handed on but what friction holds.
class PenaltyContact final : public ContactLaw {
public:
    double zone() const override { return 1.0; }
    void begin(const ContactMemory&) override {}
    void meet(const ContactRows&) override {}
    void evaluate(const ContactPoint& point, ContactForces forces) const override;
    bool correct(const ContactPoint&, ContactForces, double) override { return false; }
    void end(const ContactRows& rows, const ContactTerms& terms, const std::vector<RowForce>& row_forces,
             ContactMemory& memory) override;
    /// A touch moves by u along the surface. Its potential is Huber's, quadratic up to the reach and linear beyond: what lies
    /// beyond is the friction force times the slip.
    ContactLoss loss(const ContactMove& move, double stored) const override;
};

}  // namespace percale

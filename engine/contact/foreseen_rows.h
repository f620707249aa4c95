#pragma once

#include "contact_law.h"

namespace percale {

/// A move of the cloth along a direction, to where these rows are.
struct RowMove {
    const ContactRows& rows;
    const std::vector<RowForce>& row_forces;  // there
    const Vectors& start;                     // m
    const Vectors& direction;                 // m/s
    double h = 0.0;                           // s: the move is h direction
    double weight = 1.0;                      // how often contact forces count (ImplicitStage::contact_weight)
};

/// Contact rows that push at the end of a move, but were still out of reach at its start and therefore in no matrix there. Taken
/// as springs that act on from the start, with the force that is 0 where they come into reach, they make the next direction end
/// where they hold the cloth: the step of an active set (Hintermueller, Ito and Kunisch 2002).
struct ForeseenRows {
    std::vector<CoupledBlock> blocks;  // kg: those of contact at the start, then one of each such row
    std::vector<Vec3> impulses;        // kg m/s, of each such row on its cloth point at the start: it pulls

    /// Adds the impulses where `free` is 1.
    void add_to(const AlignedVector<double>& free, Vectors& right_side) const;
};

/// Finds the rows of a move that began with these blocks of contact. Returns the part of the slope at its end (residual times
/// direction, J) that they make.
double foresee_rows(const std::vector<CoupledBlock>& blocks_at_start, const RowMove& move, ForeseenRows& found);

}  // namespace percale

#pragma once

#include "contact_law.h"

namespace percale {

/// A move of the cloth along a direction, with the constraints at its end.
struct TrialMove {
    const ContactConstraints& constraints;
    const std::vector<ConstraintForce>& constraint_forces;  // at the end
    const Vec3Arrays& start;                                // m
    const Vec3Arrays& direction;                            // m/s
    double h = 0.0;                                         // s: the move is h direction
    double weight = 1.0;                                    // factor of the contact forces (ImplicitStage::contact_weight)
};

/// Contacts that push at the end of a trial move, but were out of range at its start and are in no matrix there. As springs that
/// act from the start on, with a force that is 0 where the contact begins, they make the next direction end where they hold the
/// cloth: this is the step of an active set method (Hintermueller, Ito and Kunisch 2002).
struct TrialContacts {
    std::vector<CoupledBlock> blocks;  // kg: those of contact at the start, then one for each trial contact
    std::vector<Vec3> impulses;        // kg m/s, of each trial contact on its cloth point at the start: it pulls

    /// Adds the impulses where `free` is 1.
    void add_to(const AlignedVector<double>& free, Vec3Arrays& right_side) const;
};

/// Finds the trial contacts of a move that began with these contact blocks. Returns their part of the slope at its end (residual
/// times direction, J).
double find_trial_contacts(const std::vector<CoupledBlock>& blocks_at_start, const TrialMove& move, TrialContacts& found);

}  // namespace percale

#pragma once

#include "penalty.h"

namespace percale {

/// A straight move of the cloth that ended with these contacts.
struct ContactMove {
    const ContactRows& rows;
    const ContactTerms& terms;
    const Vectors& start;  // m
    const Vectors& end;    // m
    double dt;             // s, that the move took
    double obstacle_rate;  // 1/s, obstacle velocity / obstacle_displacement
};

/// What contact forces of the penalty form took from the cloth beyond the change of their energy, obstacles' work left out, J.
struct ContactLoss {
    double friction = 0.0;    // friction force times slip
    double integrator = 0.0;  // Bregman terms of the potentials of rows and of the springs by which friction holds; >= 0
    /// What the rows of the end, with their stiffness, would have stored at the start: their distances and the stretch of their
    /// grips, moved back with the relative velocity.
    double stored_at_start = 0.0;
};

/// A touch moves by u along the surface. Its potential is Huber's, quadratic up to the reach and linear beyond: what lies beyond
/// is the friction force times the slip.
ContactLoss contact_loss(const ContactMove& move);

/// How much farther a row's vertices, by their weights, moved than its obstacle point, m.
Vec3 relative_move(const ContactMove& move, std::size_t row);

}  // namespace percale

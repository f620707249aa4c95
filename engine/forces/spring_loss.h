#pragma once

#include <span>

#include "model/spring_network.h"
#include "model/vectors.h"
#include "percale/settings.h"

namespace percale {

/// A straight move, with the state in which a scheme took the forces for it.
struct SpringMove {
    const Vectors& start;       // m
    const Vectors& end;         // m
    const Vectors& positions;   // m, that forces were taken at
    const Vectors& velocities;  // m/s, likewise; unused by DampingForm::length_rate
    DampingForm form;
    double dt;                                 // s, that the move takes
    std::span<const double> rest_length = {};  // ClothState::rest_length
};

struct SpringLoss {
    double material = 0.0;  // J, by damping: dt kd r^2 with the damping rate r, (l_end - l_start)/dt or v_ij . d
    /// J, Bregman term of the elastic energy U for the force f that the scheme took, -f . (q_end - q_start) - (U(q_end) -
    /// U(q_start)), and what the damping force kd r takes as the ends do not move apart at the rate r all the way.
    double integrator = 0.0;
};

/// Elastic and damping force of every spring, taken once and held over the move: what they take beyond the change of elastic
/// energy.
SpringLoss spring_loss(const SpringNetwork& network, const SpringMove& move);

}  // namespace percale

#pragma once

#include <span>

#include "model/spring_network.h"
#include "model/vec3_arrays.h"
#include "percale/settings.h"

namespace percale {

/// A straight move, with the state in which a scheme took the forces for it.
struct SpringMove {
    const Vec3Arrays& start;       // m
    const Vec3Arrays& end;         // m
    const Vec3Arrays& positions;   // m, that forces were taken at
    const Vec3Arrays& velocities;  // m/s, likewise; unused by DampingForm::length_rate
    DampingForm form;
    double dt;                                 // s, that the move takes
    std::span<const double> rest_length = {};  // ClothState::rest_length
};

struct SpringLoss {
    double material = 0.0;  // J, by damping: dt kd r^2 with the damping rate r, (l_end - l_start)/dt or v_ij . d
    /// J, Bregman term of the elastic energy U for the force f that the scheme took, -f . (q_end - q_start) - (U(q_end) -
    /// U(q_start)), and the work of the damping force kd r where the ends do not separate at the rate r throughout the move.
    double integrator = 0.0;
};

/// Loss of the elastic and damping force of every spring, evaluated once and held over the move: their work beyond the change of
/// elastic energy.
SpringLoss spring_loss(const SpringNetwork& network, const SpringMove& move);

}  // namespace percale

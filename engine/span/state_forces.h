#pragma once

#include "span.h"

namespace percale {

/// A state in which forces are taken: m, m/s; `air`: positions that the triangles have in the wind; ClothState::rest_length.
struct ForcePlace {
    const Vectors &positions, &velocities, &air;
    std::span<const double> rest_length;
};

/// Forces at a state, without contact, into work.explicit_space.forces. Damping by velocity.
void evaluate_at(const StepScene& scene, const ForcePlace& place, Workspace& work);

/// f/m without contact, m/s^2; 0 at prescribed vertices.
void set_accelerations(const StepScene& scene, const ForcePlace& place, Workspace& work, Vectors& accelerations);

/// The air around cloth that lies at these positions, if there is any; null: none.
StepWind* set_wind_at(const StepScene& scene, const Vectors& positions, Workspace& work);

/// Work of moving pins and of the wind, J.
struct ScriptWork {
    double pins = 0.0, wind = 0.0;
};

/// That between two states, `length` in s apart. Pins: what their kinetic energy gained less the work of the mean of the forces
/// (without contact) at both; wind: the mean of its powers there.
ScriptWork script_work(const StepScene& scene, const ClothState& start, const ClothState& end, double length, Workspace& work);

}  // namespace percale

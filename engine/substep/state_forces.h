#pragma once

#include "substep.h"

namespace percale {

/// A state in which forces are evaluated: m, m/s; `air`: positions that the triangles have in the wind; ClothState::rest_length.
struct ForcePlace {
    const Vec3Arrays &positions, &velocities, &air;
    std::span<const double> rest_length;
};

/// Evaluates the forces at a state, without contact, into work.explicit_space.forces, with velocity damping.
void evaluate_at(const StepScene& scene, const ForcePlace& place, Workspace& work);

/// f/m without contact, m/s^2; 0 at prescribed vertices.
void set_accelerations(const StepScene& scene, const ForcePlace& place, Workspace& work, Vec3Arrays& accelerations);

/// The air around cloth that lies at these positions, if there is any; null: none.
StepWind* set_wind_at(const StepScene& scene, const Vec3Arrays& positions, Workspace& work);

/// Work of moving pins and of the wind, J.
struct ScriptWork {
    double pins = 0.0, wind = 0.0;
};

/// The work between two states, `length` in s apart. Pins: the gain of their kinetic energy less the work of the mean of the
/// forces (without contact) at both; wind: the mean of its powers there.
ScriptWork script_work(const StepScene& scene, const ClothState& start, const ClothState& end, double length, Workspace& work);

}  // namespace percale

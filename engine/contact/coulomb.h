#pragma once

#include <algorithm>

#include "percale/mesh.h"

namespace percale {

/// Coulomb's law of friction with a sticking spring, for a tangential slip e from an anchor: up to the stick threshold r the
/// force is -N e/r, beyond it has the size N, mu times the normal force, against the slip, and the anchor follows at the distance
/// r.
struct CoulombLaw {
    double limit = 0.0;            // N, mu times the normal force
    double stick_threshold = 0.0;  // m, r > 0

    bool slides(double slip) const { return slip > stick_threshold; }
    /// Force over slip, N/m.
    double stiffness(double slip) const { return limit / std::max(slip, stick_threshold); }
    Vec3 force(const Vec3& slip) const { return -stiffness(slip.norm()) * slip; }

    /// The energy that the spring stores, J: 1/2 N/r e^2 up to r, constant beyond.
    double stored(double slip) const { return spring(std::min(slip, stick_threshold)); }
    /// The potential of a slip that grows from 0 while N is constant, J (Huber's function): the force is minus its derivative.
    double potential(double slip) const { return slides(slip) ? limit * (slip - 0.5 * stick_threshold) : spring(slip); }

    /// The slip that remains once the anchor has followed.
    Vec3 anchored(const Vec3& slip) const {
        const double length = slip.norm();
        return slides(length) ? Vec3(stick_threshold / length * slip) : slip;
    }

private:
    double spring(double stretch) const { return 0.5 * limit / stick_threshold * stretch * stretch; }
};

}  // namespace percale

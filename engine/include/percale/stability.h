#pragma once

#include "percale/settings.h"

namespace percale {

/// x'' + damping x' + square x = 0: one mode of a cloth.
struct Oscillator {
    double square = 0.0;   // 1/s^2, of the angular frequency, > 0
    double damping = 0.0;  // 1/s, 2 zeta omega, >= 0
};

/// The longest time step, s, for which a scheme does not amplify an oscillator: infinity for implicit schemes, 0 for those that
/// amplify it with any step. With the eigenvalues z = lambda dt and |R(z)| <= 1 where R is the Taylor polynomial of exp of degree
/// 1 (forward_euler), 2 (midpoint) or 4 (rk4); symplectic_euler, its damping taken at the old velocity, is stable for square dt^2
/// + 2 damping dt <= 4. `scheme` must not be `automatic`.
double longest_stable_step(Scheme scheme, const Oscillator& oscillator);

}  // namespace percale

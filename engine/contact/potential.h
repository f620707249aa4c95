#pragma once

namespace percale {

struct ContactPotential {
    double energy = 0.0;     // J
    double slope = 0.0;      // -dP/dd, N
    double curvature = 0.0;  // d2P/dd2, N/m
};

/// The two coefficients of the contact force, N/m.
struct ContactStiffness {
    double quadratic = 0.0, quartic = 0.0;
};

/// Potential of a contact in the distance d, with thickness h and coefficients a and b: 0 from h on, and with s = 1 - d/h
///     -P' = h (a s^2 + b s^4)   down to h/2,
/// below -P' = c + e (h/(2 d) - 1), without bound as d -> 0, c and e such that it is twice continuously differentiable. A contact
/// begins without stiffness, and what it takes of a load follows from it alone: of a small load F a depth of sqrt(F h/a).
ContactPotential contact_potential(double distance, double thickness, const ContactStiffness& stiffness);

/// Potential of a spring of stiffness k, 1/2 k (h - d)^2 with h in the place of the thickness, likewise without bound below h/2,
/// -P' = k (h/2)^2/d.
ContactPotential spring_potential(double distance, double length, double stiffness);

}  // namespace percale

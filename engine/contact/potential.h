#pragma once

namespace percale {

/// Potential of one contact in the raw distance d, with thickness h and stiffness k: 0 from h on, 1/2 k (h - d)^2 down to
/// h/2, logarithmic below, so that it grows without bound as d -> 0. Twice continuously differentiable but for the jump of the
/// second derivative at h. `slope` is -dP/dd >= 0, N; `curvature` d2P/dd2 >= 0, N/m.
struct ContactPotential {
    double energy = 0.0, slope = 0.0, curvature = 0.0;
};
ContactPotential contact_potential(double distance, double thickness, double stiffness);

/// The stiffness k with which the potential has this curvature at a distance below the thickness.
double stiffness_of_curvature(double curvature, double distance, double thickness);

}  // namespace percale

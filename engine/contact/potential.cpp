#include "potential.h"

#include <cmath>

namespace percale {

namespace {

/// The potential that goes on as it begins, at s = 1 - d/h.
ContactPotential polynomial(double s, double h, const ContactStiffness& stiffness) {
    const double quadratic = stiffness.quadratic * s * s, quartic = stiffness.quartic * s * s * s * s;
    return {.energy = h * h * s * (quadratic / 3.0 + quartic / 5.0),
            .slope = h * (quadratic + quartic),
            .curvature = 2.0 * (stiffness.quadratic + 2.0 * stiffness.quartic * s * s) * s};
}

}  // namespace

ContactPotential contact_potential(double distance, double thickness, const ContactStiffness& stiffness) {
    const double half = 0.5 * thickness;
    if (distance >= thickness) return {};
    if (distance >= half) return polynomial((thickness - distance) / thickness, thickness, stiffness);
    const ContactPotential middle = polynomial(0.5, thickness, stiffness);
    const double scale = middle.curvature * half;  // e
    return {.energy = middle.energy + (middle.slope - scale) * (half - distance) + scale * half * std::log(half / distance),
            .slope = middle.slope + scale * (half / distance - 1.0),
            .curvature = scale * half / (distance * distance)};
}

ContactPotential spring_potential(double distance, double length, double stiffness) {
    const double half = 0.5 * length, depth = length - distance;
    if (distance >= half) return {0.5 * stiffness * depth * depth, stiffness * depth, stiffness};
    // Below half the length the slope is k half^2/d, which meets k (h - d) there with the same value and derivative.
    const double scale = stiffness * half * half;
    return {0.5 * scale + scale * std::log(half / distance), scale / distance, scale / (distance * distance)};
}

}  // namespace percale

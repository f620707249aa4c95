#include "potential.h"

#include <cmath>

namespace percale {

ContactPotential contact_potential(double distance, double thickness, double stiffness) {
    if (distance >= thickness) return {};
    const double half = 0.5 * thickness, depth = thickness - distance;
    if (distance >= half) return {0.5 * stiffness * depth * depth, stiffness * depth, stiffness};
    // Below h/2 the slope is k (h/2)^2 / d, which meets k (h - d) there with the same value and derivative.
    const double scale = stiffness * half * half;
    return {0.5 * scale + scale * std::log(half / distance), scale / distance, scale / (distance * distance)};
}

double stiffness_of_curvature(double curvature, double distance, double thickness) {
    return distance >= 0.5 * thickness ? curvature : 4.0 * distance * distance / (thickness * thickness) * curvature;
}

}  // namespace percale

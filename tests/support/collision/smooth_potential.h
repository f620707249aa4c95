#pragma once

#include <cmath>

namespace percale::test {

/// A smooth potential of a distance, and its derivative: 0 from a distance h on.
struct SmoothPotential {
    double h = 0.2;  // m

    double at(double distance) const { return distance < h ? std::pow(h - distance, 3) : 0.0; }
    double slope(double distance) const { return distance < h ? -3.0 * std::pow(h - distance, 2) : 0.0; }
};

}  // namespace percale::test

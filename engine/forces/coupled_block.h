#pragma once

#include <array>
#include <span>

#include "model/vectors.h"
#include "symmetric_block.h"

namespace percale {

/// A part of the step matrix that joins up to four vertices: w_k w_l K between vertices k and l, K symmetric, kg.
struct CoupledBlock {
    std::array<int, 4> vertex;  // -1 = unused
    std::array<double, 4> weight;
    SymmetricBlock k;
    int row = -1;  // contact row; -1: of a single vertex (friction with all its rows, wind)
};

/// What fills a closed cloth in the step matrix: stiffness g g^T - load H, kg, with the gradient g and the matrix H of second
/// derivatives of the volume inside. It joins all vertices of the cloth, and the second part has negative eigenvalues.
struct EnclosedBlock {
    double stiffness = 0.0;               // kg/m^4, dt^2 times minus the slope of pressure over volume
    double load = 0.0;                    // Pa s^2, dt^2 times the pressure
    Vectors gradient;                     // g, m^2; 0 at the vertices of other cloth
    std::span<const Triangle> triangles;  // of the cloth
};

}  // namespace percale

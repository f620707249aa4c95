#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "model/vectors.h"

namespace percale {

/// A force with all that it claims about itself at one state. Positions are those at the end of a step of length dt, velocities
/// follow from them.
struct CheckedTerm {
    std::string name;
    std::function<void(const Vectors& positions, Vectors& forces)> add_forces;  // N
    std::function<double(const Vectors& positions)> energy;                     // J; empty: the force has no potential
    /// product = -dt^2 J direction, J the derivative of the forces, kg; empty: it has no part in the matrix.
    std::function<void(const Vectors& direction, Vectors& product)> multiply;
    /// Whether the rows of a vertex are the derivative itself; elsewhere the matrix need only bound it from above, or with
    /// `kinks`, where there is no derivative, claims nothing.
    std::function<bool(int vertex)> exact;
    bool kinks = false;
    bool internal = true;  // between vertices of the cloth: without sum and moment
};

/// The first thing that does not fit.
struct WrongDerivative {
    std::string term;
    std::string what;    // with figures
    int vertex = -1;     // of the system; -1: all of them together
    int by_vertex = -1;  // whose motion shows it
};

/// The state that terms are checked at, and the sizes of it.
struct CheckedState {
    const Vectors& positions;  // m
    int count = 0;             // vertices
    double reach = 0.0;        // m, how far vertices are moved for differences; small against every length
    double dt = 0.0;           // s
};

/// Compares every term with itself by central differences along one fixed set of directions: the sum and moment of internal
/// forces, forces with the slope of the energy, the product with the matrix with the change of the forces. Relative accuracy
/// 1e-4 at each vertex.
std::optional<WrongDerivative> find_wrong_derivative(const std::vector<CheckedTerm>& terms, const CheckedState& state);

}  // namespace percale

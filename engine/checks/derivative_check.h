#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "model/vec3_arrays.h"

namespace percale {

/// A force with its energy and its matrix at one state. Positions are those at the end of a step of length dt; velocities follow
/// from them.
struct CheckedTerm {
    std::string name;
    std::function<void(const Vec3Arrays& positions, Vec3Arrays& forces)> add_forces;  // N
    std::function<double(const Vec3Arrays& positions)> energy;                        // J; empty: the force has no potential
    /// product = -dt^2 J direction, J the derivative of the forces, kg; empty: it has no part in the matrix.
    std::function<void(const Vec3Arrays& direction, Vec3Arrays& product)> multiply;
    /// Whether the rows of a vertex are the derivative itself; elsewhere the matrix need only bound it from above, or with
    /// `kinks`, where there is no derivative, may be anything.
    std::function<bool(int vertex)> exact;
    bool kinks = false;
    bool internal = true;  // between vertices of the cloth: sum and moment are 0
};

/// The first misfit.
struct WrongDerivative {
    std::string term;
    std::string what;    // with figures
    int vertex = -1;     // of the system; -1: all of them together
    int by_vertex = -1;  // the vertex whose motion reveals it
};

/// The state at which terms are checked, and its sizes.
struct CheckedState {
    const Vec3Arrays& positions;   // m
    int count = 0;                 // vertices
    double difference_step = 0.0;  // m, displacement of vertices for differences; small against every length
    double dt = 0.0;               // s
};

/// Compares every term with itself by central differences along one fixed set of directions: the sum and moment of internal
/// forces, forces with the slope of the energy, the product with the matrix with the change of the forces. Relative accuracy 1e-4
/// at each vertex.
std::optional<WrongDerivative> find_wrong_derivative(const std::vector<CheckedTerm>& terms, const CheckedState& state);

}  // namespace percale

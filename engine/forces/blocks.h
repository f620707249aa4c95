#pragma once

#include <array>
#include <span>

#include "model/vec3_arrays.h"
#include "percale/mesh.h"

namespace percale {

/// A symmetric 3x3 matrix: xx xy xz yy yz zz.
using SymmetricBlock = std::array<double, 6>;

/// n.K n
inline double quadratic_form(const SymmetricBlock& k, const Vec3& n) {
    return n.x() * (k[0] * n.x() + 2.0 * k[1] * n.y() + 2.0 * k[2] * n.z()) + n.y() * (k[3] * n.y() + 2.0 * k[4] * n.z()) +
           k[5] * n.z() * n.z();
}

/// K += factor n n^T
inline void add_normal_block(SymmetricBlock& k, double factor, const Vec3& n) {
    int entry = 0;
    for (int a = 0; a < 3; ++a) {
        for (int b = a; b < 3; ++b) k[entry++] += factor * n[a] * n[b];
    }
}

/// K += factor (I - n n^T - t t^T), n a unit vector, t one at right angles to it or zero.
inline void add_tangent_block(SymmetricBlock& k, double factor, const Vec3& n, const Vec3& t) {
    int entry = 0;
    for (int a = 0; a < 3; ++a) {
        for (int b = a; b < 3; ++b) k[entry++] += factor * ((a == b ? 1.0 : 0.0) - n[a] * n[b] - t[a] * t[b]);
    }
}

/// The part of v at right angles to the unit vector n.
inline Vec3 tangential(const Vec3& v, const Vec3& n) { return v - n * n.dot(v); }

/// The block diagonal of a step matrix: six arrays xx xy xz yy yz zz, kg.
struct DiagonalBlocks {
    AlignedVector<double> data;
    std::size_t padded = 0;

    void resize(std::size_t padded_size) {
        padded = padded_size;
        data.assign(6 * padded, 0.0);
    }
    const double* operator[](int entry) const { return data.data() + entry * padded; }
    SymmetricBlock block(int i) const {
        SymmetricBlock k;
        for (std::size_t entry = 0; entry < 6; ++entry) k[entry] = data[entry * padded + i];
        return k;
    }
};

/// A part of the step matrix that joins up to four vertices: w_k w_l K between vertices k and l, K symmetric, kg.
struct CoupledBlock {
    std::array<int, 4> vertex;  // -1 = unused
    std::array<double, 4> weight;
    SymmetricBlock k;
    int constraint = -1;  // contact constraint; -1: of a single vertex (friction with all its constraints, wind)
};

/// The pressure block of a closed cloth in the step matrix: stiffness g g^T - load H, kg, with the gradient g and the matrix H
/// of second derivatives of the enclosed volume. It joins all vertices of the cloth, and the second part has negative
/// eigenvalues.
struct PressureBlock {
    double stiffness = 0.0;               // kg/m^4, dt^2 times minus the slope of pressure over volume
    double load = 0.0;                    // Pa s^2, dt^2 times the pressure
    Vec3Arrays gradient;                  // g, m^2; 0 at the vertices of other cloth
    std::span<const Triangle> triangles;  // of the cloth
};

}  // namespace percale

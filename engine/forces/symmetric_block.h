#pragma once

#include <array>

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

}  // namespace percale

#pragma once

#include <functional>

#include "block_matrix.h"
#include "energy_error_estimate.h"
#include "model/vec3_arrays.h"

namespace percale {

/// Work space, sized on first use.
struct SolveSpace {
    Vec3Arrays r, z, p, q;
    AlignedVector<double> points;
};

/// z = P^-1 r, 0 at prescribed vertices, with a positive definite P.
using Preconditioner = std::function<void(const Vec3Arrays& r, Vec3Arrays& z)>;

/// Conjugate gradient for A x = b on the free vertices (Hestenes and Stiefel 1952) in double precision, preconditioned by block
/// Jacobi if nothing else is given. Energy gains are taken over ten iterations. Where A turns out not to be positive definite, as
/// loads may make it, x is the last iterate, at least the preconditioned b: r . x > 0, so that it leads downhill
/// (Nocedal and Wright, Numerical Optimization, algorithm 7.1).
/// On entry x holds the prescribed values of the other vertices, which stay, and a first guess at the free ones.
SolveReport solve_cg(const BlockMatrix& matrix, const Vec3Arrays& b, const SolveTarget& target, SolveSpace& space, Vec3Arrays& x,
                     const Preconditioner& preconditioner = {});

}  // namespace percale

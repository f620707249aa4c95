#pragma once

#include "block_matrix.h"
#include "gain_record.h"
#include "model/vectors.h"

namespace percale {

/// Work space, sized on first use.
struct SolveSpace {
    Vectors r, z, p, q;
    AlignedVector<double> points;
};

/// Conjugate gradient for A x = b on the free vertices (Hestenes and Stiefel 1952), preconditioned by block Jacobi, in double
/// precision. Energy gains are taken over ten iterations.
/// On entry x holds the prescribed values of the other vertices, which stay, and a first guess at the free ones.
SolveReport solve_cg(const BlockMatrix& matrix, const Vectors& b, const SolveTarget& target, SolveSpace& space, Vectors& x);

}  // namespace percale

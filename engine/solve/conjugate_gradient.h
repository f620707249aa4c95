#pragma once

#include "block_matrix.h"
#include "model/vectors.h"

namespace percale {

class Multigrid;

/// When to stop. A rule is off where its number is 0; the first that holds ends the solve.
struct SolveTarget {
    double relative_residual = 0.0;  // |r| <= this |r at the start|, over free vertices
    /// Energy norm of the error, estimated by the gains alpha_k (r.z)_k of the last iterations (Hestenes and Stiefel's error
    /// formula): their sum <= relative_gain^2 (sum of all gains), or <= absolute_gain (J s^2). Ten iterations with block Jacobi,
    /// one with multigrid, whose error falls several times an iteration.
    double relative_gain = 0.0;
    double absolute_gain = 0.0;
    int most_iterations = 2000;
};

struct SolveReport {
    int iterations = 0;
    bool converged = false;
};

/// Work space, sized on first use.
struct SolveSpace {
    Vectors r, z, p, q;
    AlignedVector<double> points;
};

/// Preconditioned conjugate gradient for A x = b on the free vertices (Hestenes and Stiefel 1952) in double precision;
/// preconditioned by `multigrid`, filled in with the matrix, or by block Jacobi where that is null.
/// On entry x holds the prescribed values of the other vertices and 0 at free ones; prescribed entries stay.
SolveReport solve_cg(const BlockMatrix& matrix, Multigrid* multigrid, const Vectors& b, const SolveTarget& target,
                     SolveSpace& space, Vectors& x);

}  // namespace percale

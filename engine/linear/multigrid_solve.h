#pragma once

#include "block_matrix.h"
#include "energy_error_estimate.h"
#include "multigrid.h"

namespace percale {

/// Work space, sized on first use.
struct MultigridSpace {
    AlignedVector<float> x, p, q;
    Vec3Arrays r;
    AlignedVector<double> points;
};

/// A x = b on the free vertices by conjugate gradient in single precision, preconditioned by a V-cycle. With a residual to reach,
/// the residual is computed anew in double precision when the single-precision one has reached it or has gained four digits, and
/// the remaining system is solved (iterative refinement; Higham, Accuracy and Stability of Numerical Algorithms, 2002, chapter
/// 12). Energy gains are those of the last iteration: the error falls several times in each. On entry x holds the prescribed
/// values of the other vertices and 0 at free ones; prescribed entries stay.
SolveReport solve_multigrid(const BlockMatrix& matrix, Multigrid& multigrid, const Vec3Arrays& b, const SolveTarget& target,
                            MultigridSpace& space, Vec3Arrays& x);

}  // namespace percale

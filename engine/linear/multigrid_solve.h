#pragma once

#include "block_matrix.h"
#include "gain_record.h"
#include "multigrid.h"

namespace percale {

/// Work space, sized on first use.
struct MultigridSpace {
    AlignedVector<float> x, p, q;
    Vectors r;
    AlignedVector<double> points;
};

/// A x = b on the free vertices by conjugate gradient in single precision, preconditioned by a V-cycle. With a residual to reach,
/// the residual is formed anew in double precision when the floats say it is reached or have gained four digits, and what is left
/// is solved for again (iterative refinement; Higham, Accuracy and Stability of Numerical Algorithms, 2002, chapter 12). Energy
/// gains are those of the last iteration: the error falls several times in each. On entry x holds the prescribed values of the
/// other vertices and 0 at free ones; prescribed entries stay.
SolveReport solve_multigrid(const BlockMatrix& matrix, Multigrid& multigrid, const Vectors& b, const SolveTarget& target,
                            MultigridSpace& space, Vectors& x);

}  // namespace percale

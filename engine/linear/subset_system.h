#pragma once

#include <span>
#include <vector>

#include "block_matrix.h"

namespace percale {

/// The part of a step matrix that belongs to a few vertices while all others are held, gathered so that the cost of products is
/// that of a small matrix. It leaves out loads.
class SubsetSystem {
public:
    /// Takes the rows and columns of these vertices, each of them free and named once, from a filled matrix.
    void fill(const BlockMatrix& matrix, std::span<const int> vertices);

    /// A x = b, kg m/s, by conjugate gradient with block Jacobi (as solve_cg) until |b - A x| <= ratio |b|. Sets x at the
    /// subset's vertices and reads b there; no other entries. Returns the number of iterations.
    int solve(const Vec3Arrays& b, double ratio, Vec3Arrays& x);

private:
    void add_coupled(const BlockMatrix& matrix);
    void add_outer(const BlockMatrix& matrix);
    void multiply(const std::vector<Vec3>& x, std::vector<Vec3>& y) const;
    double precondition();

    std::vector<int> vertices_, number_;  // of the subset; of every vertex in it, or -1
    std::vector<int> start_, column_;     // blocks off the diagonal, row by row
    std::vector<Eigen::Matrix3d> block_;
    std::vector<SymmetricBlock> diagonal_, inverse_;
    std::vector<CoupledBlock> coupled_;  // vertices by their number in the subset; -1: held or unused
    OuterBlocks outer_;                  // likewise, without those that are held
    std::vector<Vec3> x_, r_, z_, p_, q_;
};

}  // namespace percale

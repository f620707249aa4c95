#pragma once

#include <array>
#include <vector>

#include "coarsening.h"
#include "kernels/kernels.h"
#include "support/aligned.h"

namespace percale {

/// Rows of (vertex, weight) in slices.
struct TransferLists {
    std::vector<int> start;
    AlignedVector<int> other;
    AlignedVector<float> weight;

    EntryPattern pattern() const { return {start.data(), other.data()}; }
};

/// A coarser level: its pairs, and how it is computed from the finer one.
struct LevelPattern {
    int vertices = 0;
    std::vector<std::array<int, 2>> pairs;
    std::vector<int> start;  // of slices of entries, one entry for each end of a pair
    AlignedVector<int> other;
    std::vector<int> entry_pair;  // pairs.size() for padding
    /// Galerkin: the block of a pair is the sum of coefficient * block of a finer pair.
    std::vector<int> term_start, term_pair;
    AlignedVector<float> coefficient;
    TransferLists prolongation, restriction;  // rows of the finer level; rows of this one
    std::vector<InterpolationRow> rows;       // the prolongation again, vertex by vertex

    int slices() const { return static_cast<int>(start.size()) - 1; }
    EntryPattern pattern() const { return {start.data(), other.data()}; }
};

/// Coarser and coarser levels of a graph, the finest of them first, down to about thirty vertices or until coarsening gains no
/// more. Interpolation weights are scalar, so the product of transfers and matrix keeps the form of a sum over pairs of blocks
/// acting on differences: for a pair (i, j) with x_i - x_j = sum_a c_a x_a (sum of c = 0), B (x_i - x_j)^2 = sum over a < b of
/// -c_a c_b B (x_a - x_b)^2.
std::vector<LevelPattern> make_hierarchy(SpringGraph graph);

}  // namespace percale

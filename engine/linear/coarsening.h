#pragma once

#include <array>
#include <vector>

#include "percale/mesh.h"

namespace percale {

/// Springs as a graph, from which a coarser level is chosen.
struct SpringGraph {
    std::vector<Vec3> positions;  // m, at rest
    std::vector<std::array<int, 2>> pairs;
    std::vector<double> strength;  // of each pair, N/m
};

/// At most three weights that sum to 1: a vertex of the finer level as a mean of vertices of the coarser one.
struct InterpolationRow {
    std::array<int, 3> vertex;
    std::array<double, 3> weight;
    int count = 0;
};

struct Coarsening {
    std::vector<int> kept;  // vertices of the finer level that form the coarser one
    std::vector<InterpolationRow> rows;
};

/// A maximal independent set of the strong pairs (at least a quarter of the strongest pair at one of its ends) in the vertices'
/// order; where that would keep more than two in five, as on the coarser levels of a grid, whose diagonals are weaker, pairs of a
/// thirtieth of the strongest count too. The others are interpolated by moving least squares from at most three kept vertices
/// within two strong pairs, so that linear functions of the rest position are kept where the neighbours allow (Lancaster and
/// Salkauskas 1981). The same for any thread.
Coarsening coarsen(const SpringGraph& graph);

}  // namespace percale

#pragma once

#include <array>

#include "symmetric_block.h"

namespace percale {

/// A part of the step matrix that joins up to four vertices: w_k w_l K between vertices k and l, K symmetric, kg.
struct CoupledBlock {
    std::array<int, 4> vertex;  // -1 = unused
    std::array<double, 4> weight;
    SymmetricBlock k;
    int row = -1;  // contact row; -1: of a single vertex (friction with all its rows, wind)
};

}  // namespace percale

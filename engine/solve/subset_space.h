#pragma once

#include <vector>

#include "linear/subset_system.h"

namespace percale {

/// Work space of solve_subsets.
struct SubsetSpace {
    SubsetSystem system;
    std::vector<double> squares;  // |r|^2/m of each vertex, kg m^2/s^2
    std::vector<int> order;       // of vertices, in descending order of squares
    std::vector<int> vertices;    // of the subset
    std::vector<char> joined;     // 1: in the subset, or prescribed beside it
};

}  // namespace percale

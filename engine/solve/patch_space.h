#pragma once

#include <vector>

#include "linear/patch_system.h"

namespace percale {

/// Work space of relax_patches.
struct PatchSpace {
    PatchSystem system;
    std::vector<double> squares;  // |r|^2/m of each vertex, kg m^2/s^2
    std::vector<int> order;       // of vertices, those with the most first
    std::vector<int> vertices;    // of the patches
    std::vector<char> joined;     // 1: one of them, or prescribed beside them
};

}  // namespace percale

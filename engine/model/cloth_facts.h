#pragma once

#include <span>
#include <string>

#include "percale/fabric.h"

namespace percale {

/// Properties of one cloth for the plan.
struct ClothFacts {
    std::string name = {};
    bool grid = true;
    Fabric fabric = {};
};

/// Properties of a scene's forces for the plan.
struct ForceFacts {
    std::span<const ClothFacts> cloths;
    bool wind = false;   // there is air, or there will be
    bool seams = false;  // there are seams
};

}  // namespace percale

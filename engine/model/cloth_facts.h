#pragma once

#include <span>
#include <string>

#include "percale/fabric.h"

namespace percale {

/// What is known of one cloth.
struct ClothFacts {
    std::string name = {};
    bool grid = true;
    Fabric fabric = {};
};

/// What is known of a scene's forces.
struct ForceFacts {
    std::span<const ClothFacts> cloths;
    bool wind = false;   // there is air, or there will be
    bool seams = false;  // there are some
};

}  // namespace percale

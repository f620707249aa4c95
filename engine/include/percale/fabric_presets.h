#pragma once

#include <span>
#include <string_view>

#include "percale/fabric.h"

namespace percale {

/// A fabric with a name. `source` is the origin of its numbers.
struct FabricPreset {
    std::string_view name;
    std::string_view source;
    Fabric fabric;
};

/// Fabrics to start from: typical ones, then measured ones. Moduli of all of them differ along warp and weft.
std::span<const FabricPreset> fabric_presets();

/// The fabric of a preset. Throws SceneError naming the valid ones.
const Fabric& fabric_preset(std::string_view name);

/// The same, isotropic, for meshes without a direction of warp: shear_stiffness is kept, as it decides how cloth drapes, and
/// stretch_stiffness becomes the matching one, 2 (1 + nu) shear_stiffness, or the geometric mean of warp and weft where that is
/// smaller. Woven cloth stretches more than it should by that. A fabric without moduli stays as it is.
Fabric isotropic(const Fabric& fabric);

}  // namespace percale

#pragma once

#include <span>
#include <string_view>

#include "percale/fabric.h"

namespace percale {

/// A fabric under a name. `source` says where its numbers come from.
struct FabricPreset {
    std::string_view name;
    std::string_view source;
    Fabric fabric;
};

/// Fabrics to start from: typical ones, then measured ones. Moduli of all of them differ along warp and weft.
std::span<const FabricPreset> fabric_presets();

/// The fabric of a preset. Throws SceneError naming the valid ones.
const Fabric& fabric_preset(std::string_view name);

/// The same, isotropic, for meshes that do not say where warp is: shear_stiffness is kept, as it decides how cloth drapes, and
/// stretch_stiffness becomes what belongs to it, 2 (1 + nu) shear_stiffness, or the geometric mean of warp and weft where that is
/// smaller. Woven cloth stretches more than it should by that. A fabric without moduli stays as it is.
Fabric isotropic(const Fabric& fabric);

}  // namespace percale

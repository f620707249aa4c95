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

/// The same with one stretch_stiffness, the geometric mean of warp and weft, and the shear_stiffness of isotropic cloth: for
/// meshes that do not say where warp is. A fabric without moduli stays as it is.
Fabric isotropic(const Fabric& fabric);

}  // namespace percale

#include "percale/fabric_presets.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "percale/error.h"
#include "tolerances.h"

namespace percale {
namespace {

/// s. Damping time of the shipped fabrics, which was not measured. Larger: cloth moves as in oil. 0: oscillations do not decay.
constexpr double preset_damping_time = 2e-3;

constexpr std::string_view typical =
    "typical of its kind, not one cloth: mass and bending length in the range of ASTM D1388 tables, B = mass * g * length^3; "
    "stretch and shear in the range of Kawabata (KES-F) tables at small strain";
constexpr std::string_view measured =
    "measured: Wang, O'Brien and Ramamoorthi, Data-driven elastic models for cloth, ACM Transactions on Graphics 30(4), 2011; "
    "moduli at small strain, mean bending; their coupling of warp and weft is left out, which leaves them positive definite";

struct Moduli {
    double warp, weft, shear;  // N/m
};

Fabric fabric_of(double area_density, const Moduli& moduli, double bend_stiffness) {
    Fabric fabric{.area_density = area_density, .springs = {.structural = 0.0}, .spring_damping = 0.0};
    fabric.damping_time = preset_damping_time;
    fabric.stretch_stiffness = {moduli.warp, moduli.weft};
    fabric.shear_stiffness = moduli.shear;
    fabric.bend_stiffness = bend_stiffness;
    return fabric;
}

/// A preset with a bending length in m.
FabricPreset typical_preset(std::string_view name, double area_density, const Moduli& moduli, double bending_length) {
    const double bend_stiffness = area_density * standard_gravity * bending_length * bending_length * bending_length;
    return {name, typical, fabric_of(area_density, moduli, bend_stiffness)};
}

FabricPreset measured_preset(std::string_view name, double area_density, const Moduli& moduli, double bend_stiffness) {
    return {name, measured, fabric_of(area_density, moduli, bend_stiffness)};
}

const FabricPreset presets[] = {
    typical_preset("cotton", 0.13, {2500.0, 1500.0, 50.0}, 0.022),
    typical_preset("silk", 0.06, {1500.0, 1000.0, 15.0}, 0.015),
    typical_preset("wool", 0.20, {1200.0, 800.0, 35.0}, 0.019),
    typical_preset("denim", 0.40, {5000.0, 3000.0, 150.0}, 0.032),
    measured_preset("denim_11oz", 0.324, {205.0, 1014.0, 53.0}, 7.2e-5),
    measured_preset("ponte", 0.284, {31.0, 44.0, 32.0}, 3.3e-5),
    measured_preset("interlock_tshirt", 0.187, {17.0, 34.0, 37.0}, 2.2e-5),
    measured_preset("rib_knit", 0.276, {43.0, 65.0, 83.0}, 4.6e-5),
    measured_preset("sweatshirt", 0.224, {12.0, 3.3, 18.0}, 3.3e-5),
    measured_preset("ribbon_blanket", 0.228, {152.0, 245.0, 30.0}, 1.2e-4),
    measured_preset("target_pants", 0.220, {2017.0, 2035.0, 105.0}, 1.7e-4),
    measured_preset("tango_jacket", 0.113, {43.0, 171.0, 14.0}, 1.9e-5),
    measured_preset("white_dots_tablecloth", 0.128, {2002.0, 2027.0, 19.0}, 3.1e-5),
    measured_preset("swim", 0.204, {48.0, 105.0, 61.0}, 5.0e-5),
};

}  // namespace

std::span<const FabricPreset> fabric_presets() { return presets; }

const Fabric& fabric_preset(std::string_view name) {
    const auto found =
        std::find_if(std::begin(presets), std::end(presets), [&](const FabricPreset& preset) { return preset.name == name; });
    if (found != std::end(presets)) return found->fabric;
    std::string valid;
    for (const FabricPreset& preset : presets) valid += (valid.empty() ? "" : ", ") + std::string(preset.name);
    throw SceneError("no fabric preset '" + std::string(name) + "'; valid: " + valid);
}

Fabric isotropic(const Fabric& fabric) {
    if (!fabric.has_moduli()) return fabric;
    Fabric result = fabric;
    const auto [warp, weft] = *fabric.stretch_stiffness;
    double young = std::sqrt(warp * weft);
    if (fabric.shear_stiffness) young = std::min(young, 2.0 * (1.0 + fabric.poisson_ratio) * *fabric.shear_stiffness);
    result.stretch_stiffness = {young, young};
    result.shear_stiffness.reset();
    return result;
}

}  // namespace percale

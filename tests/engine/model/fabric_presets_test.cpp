#include "percale/fabric_presets.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <set>

#include "tests/support/catch.h"
#include "tests/support/forces/membrane_cases.h"

namespace percale::test::fabric_presets_test {

TEST_CASE("Presets have names of their own, allowed numbers, positive definite moduli and a source") {
    std::set<std::string_view> names;
    for (const FabricPreset& preset : fabric_presets()) {
        CAPTURE(preset.name);
        CHECK(names.insert(preset.name).second);
        CHECK(scene_error([&] { check_options(preset.fabric, preset.name); }) == "");
        REQUIRE(preset.fabric.has_moduli());
        CHECK(stress_law(preset.fabric).selfadjointView<Eigen::Lower>().eigenvalues().minCoeff() > 0.0);
        CHECK(preset.fabric.bend_stiffness > 0.0);
        CHECK(preset.source.size() > 40);
        CHECK(&fabric_preset(preset.name) == &preset.fabric);
    }
    CHECK(names.size() >= 14);
}

TEST_CASE("Bending lengths of presets are those of cloth: one to six centimetres") {
    for (const FabricPreset& preset : fabric_presets()) {
        CAPTURE(preset.name);
        const double length = std::cbrt(*preset.fabric.bend_stiffness / (9.80665 * preset.fabric.area_density));
        CHECK(length >= 0.01);
        CHECK(length <= 0.06);
    }
}

TEST_CASE("An unknown preset is refused with the names of all presets") {
    CHECK(mentions(scene_error([] { fabric_preset("coton"); }), {"'coton'", "cotton", "white_dots_tablecloth"}));
}

TEST_CASE("Made isotropic, a preset keeps mass, bending, and its shear stiffness unless stretch is too soft for it") {
    for (const FabricPreset& preset : fabric_presets()) {
        const Fabric fabric = isotropic(preset.fabric);
        CHECK(is_isotropic(fabric));
        CHECK(fabric.area_density == preset.fabric.area_density);
        CHECK(fabric.bend_stiffness == preset.fabric.bend_stiffness);
        const auto [warp, weft] = *preset.fabric.stretch_stiffness;
        const double shear = stress_law(fabric)(2, 2), mean = std::sqrt(warp * weft);
        CHECK(shear == Approx(std::min(*preset.fabric.shear_stiffness, 0.5 * mean)));
    }
    CHECK(isotropic(sheet_fabric()).springs.structural == sheet_fabric().springs.structural);
}

}  // namespace percale::test::fabric_presets_test

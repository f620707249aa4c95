#include "scenes/garment/cloth_warnings.h"

#include "scenes/format/scene_file.h"
#include "scenes/run/scene_build.h"
#include "tests/scenes/scene_texts.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::cloth_warnings_test {
namespace {

std::vector<Finding> warnings_of(const std::string& fabric, const std::string& second_grid = "") {
    std::string text = "[fabric.f]\nsprings.structural = 100.0\n" + fabric +
                       "\n[[cloth]]\nname = \"a\"\nfabric = \"f\"\ngrid = { size = [0.5, 0.5], vertices = [5, 5] }\n";
    if (!second_grid.empty())
        text += "[[cloth]]\nname = \"b\"\nfabric = \"f\"\ngrid = { size = [0.5, 0.5], vertices = [5, 5] }\n" + second_grid;
    return build_scene(parse_scene(text, "t")).warnings;
}

}  // namespace

TEST_CASE("an area density that no cloth has is warned of, with the one that may be meant") {
    CHECK(warnings_of("area_density = 0.15").empty());
    const auto heavy = warnings_of("area_density = 150.0"), light = warnings_of("area_density = 0.00015");
    REQUIRE(heavy.size() == 1);
    CHECK(
        finding_line(heavy[0]) ==
        "warning: fabric 'f': area_density 150 kg/m^2 is too heavy for cloth (0.005 ... 15); set 0.15 kg/m^2, if that was meant");
    REQUIRE(light.size() == 1);
    CHECK(light[0].what == "fabric 'f': area_density 0.00015 kg/m^2 is too light for cloth (0.005 ... 15)");
    for (const Finding& finding : {heavy[0], light[0]}) {
        CHECK(finding.kind == "area_density");
        CHECK(finding.place == "t");
        CHECK(finding.fix == "set 0.15 kg/m^2, if that was meant");
    }
}

TEST_CASE("two cloths in one place are warned of where they do not meet") {
    const std::string apart = "pose.translation = [0, 0.02, 0]\n", near = "pose.translation = [0, 0.002, 0]\n";
    const auto warnings = warnings_of("thickness = 0.005", near);
    REQUIRE(warnings.size() == 1);
    CHECK(warnings[0].kind == "cloths_in_one_place");
    CHECK(warnings[0].place == "t:8:1");
    CHECK(finding_text(warnings[0]) ==
          "cloths 'a' and 'b' lie in one place and pass through each other; self_contact = true of their fabrics lets them meet");
    CHECK(warnings_of("thickness = 0.005", apart).empty());
    CHECK(warnings_of("thickness = 0.005\nself_contact = true", near).empty());
}

}  // namespace percale::scenes::test::cloth_warnings_test

#include "scenes/garment/meeting_warnings.h"

#include <cmath>

#include "scenes/format/scene_file.h"
#include "scenes/meshes/obj_file.h"
#include "scenes/run/scene_build.h"
#include "tests/scenes/test_folder.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::meeting_warnings_test {
namespace {

/// A scene of a small sheet 1 m above and `beside` a block, both from files, with more of the scene behind the sheet.
std::vector<Finding> meeting(double beside, const std::string& more = "", const std::string& of_fabric = "") {
    const test::TestFolder folder;
    const TriangleMesh sheet = make_grid(0.2, 0.2, 3, 3), block = make_box(Vec3(0.2, 0.2, 0.2));
    write_obj(folder.path("sheet.obj"), sheet.vertices, sheet.triangles);
    write_obj(folder.path("block.obj"), block.vertices, block.triangles);
    const std::string text = "[fabric.f]\nsprings.structural = 100.0\n" + of_fabric +
                             "[[cloth]]\nname = \"a\"\nfabric = \"f\"\n" +
                             std::string("mesh = \"sheet.obj\"\npose.translation = [") + std::to_string(beside) + ", 1, 0]\n" +
                             more + "[[obstacle]]\nname = \"block\"\nmesh = \"block.obj\"\n";
    return build_scene(load_scene(folder.write("t.toml", text))).warnings;
}

}  // namespace

TEST_CASE("cloth that can meet no obstacle is warned of, with how far it is away") {
    CHECK(meeting(0.0).empty());
    CHECK(meeting(0.35).empty());  // it may turn
    const auto missing = meeting(1.2);
    REQUIRE(missing.size() == 1);
    CHECK(missing[0].kind == "out_of_reach");
    CHECK(missing[0].place.ends_with("t.toml"));
    CHECK(finding_text(missing[0]) ==
          "no cloth can meet an obstacle from where it starts: cloth 'a' stays 1 m beside obstacle 'block'; move it there by "
          "pose.translation, or say the unit of its mesh");
    // Whatever else moves it may bring it there.
    CHECK(meeting(1.2, "[[event]]\ntime = 0.1\nwind = [-5, 0, 0]\n").empty());
    CHECK(meeting(1.2, "[[obstacle]]\nname = \"floor\"\nshape = { plane = {} }\npose.translation = [0, -1, 0]\n").empty());
    const auto hanging = meeting(0.0, "pin = [0]\n");
    REQUIRE(hanging.size() == 1);  // 1 m above
    CHECK(hanging[0].kind == "out_of_reach");
}

TEST_CASE("folded cloth can meet what it reaches when it unfolds, and cloth that meets other cloth may be led there") {
    const test::TestFolder folder;
    TriangleMesh strip = make_grid(4.0, 0.2, 41, 3);
    for (Vec3& x : strip.vertices) {  // an accordion of 0.1 m
        const auto column = static_cast<int>(std::lround((x.x() + 2.0) / 0.1));
        x = Vec3(column % 2 == 0 ? 0.0 : 0.1, 1.6 + 0.004 * column, x.z());
    }
    const TriangleMesh block = make_box(Vec3(0.2, 0.2, 0.2));
    write_obj(folder.path("strip.obj"), strip.vertices, strip.triangles);
    write_obj(folder.path("block.obj"), block.vertices, block.triangles);
    const auto warnings = [&](double below) {
        const std::string text =
            "[fabric.f]\nsprings.structural = 100.0\n[[cloth]]\nname = \"a\"\nfabric = \"f\"\nmesh = \"strip.obj\"\npin = [0]\n"
            "[[obstacle]]\nname = \"block\"\nmesh = \"block.obj\"\npose.translation = [0, " +
            std::to_string(-below) + ", 0]\n";
        return build_scene(load_scene(folder.write("t.toml", text))).warnings;
    };
    CHECK(warnings(0.0).empty());
    CHECK(warnings(20.0).size() == 1);
    const std::string other =
        "[[cloth]]\nname = \"b\"\nfabric = \"f\"\ngrid = { size = [0.2, 0.2], vertices = [3, 3] }\npose.translation = [2, 2, "
        "0]\n";
    CHECK(meeting(1.2, other).size() == 1);
    CHECK(meeting(1.2, other, "self_contact = true\n").empty());
}

TEST_CASE("a mesh of a cloth that is closed and one of an obstacle that is not are warned of") {
    const test::TestFolder folder;
    const TriangleMesh sheet = make_grid(0.2, 0.2, 3, 3), block = make_box(Vec3(0.2, 0.2, 0.2));
    write_obj(folder.path("sheet.obj"), sheet.vertices, sheet.triangles);
    write_obj(folder.path("block.obj"), block.vertices, block.triangles);
    const auto warnings = [&](const std::string& cloth, const std::string& obstacle, const std::string& more = "") {
        const std::string text =
            "[fabric.f]\nsprings.structural = 100.0\n" + more + "[[cloth]]\nname = \"a\"\nfabric = \"f\"\nmesh = \"" + cloth +
            ".obj\"\npose.translation = [0, 1, 0]\n[[obstacle]]\nname = \"b\"\nmesh = \"" + obstacle + ".obj\"\n";
        return build_scene(load_scene(folder.write("t.toml", text))).warnings;
    };
    CHECK(warnings("sheet", "block").empty());
    const auto swapped = warnings("block", "sheet");
    REQUIRE(swapped.size() == 1);
    CHECK(swapped[0].kind == "swapped");
    CHECK(swapped[0].place.ends_with("t.toml:3:1"));
    CHECK(finding_text(swapped[0]) == "cloth 'a': it is a closed surface and obstacle 'b' is not: were their meshes swapped?");
    CHECK(warnings("block", "block").empty());
    CHECK(warnings("block", "sheet", "gas_volume = 0.008\n").empty());
}

}  // namespace percale::scenes::test::meeting_warnings_test

#include "doctor/doctor_vertices.h"

#include "format/scene_file.h"
#include "tests/scenes/test_folder.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::doctor_vertices_test {
namespace {

const char* const two_cloths = R"(duration = 1.0
[fabric.f]
springs = { structural = 100.0 }
[[cloth]]
name = "flag"
fabric = "f"
grid = { size = [1.0, 1.0], vertices = [3, 3] }
pin = [0, 9, 12]
[[cloth]]
name = "towel"
fabric = "f"
grid = { size = [1.0, 1.0], vertices = [2, 2] }
pin = { box = [[0, 0, 0], [0.1, 1, 1]] }
[[event]]
time = 0.1
unpin = { cloth = "towel", vertices = [4] }
[[event]]
time = 0.2
pin = { cloth = "flag", vertices = [8] }
)";

}  // namespace

TEST_CASE("vertices that no cloth has are found in every pin and every event") {
    const TestFolder folder;
    const Scene scene = load_scene(folder.write("scene.toml", two_cloths));
    const TriangleMesh flag = make_grid(1.0, 1.0, 3, 3), towel = make_grid(1.0, 1.0, 2, 2);
    const std::vector<ClothMesh> both = {{&scene.cloths[0], &flag}, {&scene.cloths[1], &towel}};
    const std::vector<Finding> found = missing_vertices(scene, both);
    REQUIRE(found.size() == 2);
    CHECK(found[0].severity == Severity::error);
    CHECK(found[0].kind == "missing_vertices");
    CHECK(found[0].place.find("scene.toml:8:") != std::string::npos);
    CHECK(found[0].what == "pin: vertices of cloth 'flag': vertices 9, 12 are out of range; allowed: 0 ... 8");
    CHECK(found[1].place.find("scene.toml:14:") != std::string::npos);
    CHECK(found[1].what == "event: vertices of cloth 'towel': vertex 4 is out of range; allowed: 0 ... 3");
    // A box that holds no vertex is reported, too.
    Scene boxed = scene;
    boxed.cloths[1].pin = VertexBox{.lowest = Vec3(1.5, 0.0, 1.5), .highest = Vec3(1.9, 1.0, 1.9)};
    const std::vector<ClothMesh> again = {{&boxed.cloths[0], &flag}, {&boxed.cloths[1], &towel}};
    const std::vector<Finding> more = missing_vertices(boxed, again);
    REQUIRE(more.size() == 3);
    CHECK(more[1].what.find("no vertex lies in the box") != std::string::npos);
    // Without its mesh a cloth is not looked at.
    CHECK(missing_vertices(scene, std::span(both).first(1)).size() == 1);
    CHECK(missing_vertices(scene, std::span(both).first(0)).empty());
}

}  // namespace percale::scenes::test::doctor_vertices_test

#include "scenes/garment/cloth_shape.h"

#include <cmath>

#include "scenes/format/scene_file.h"
#include "scenes/run/scene_build.h"
#include "tests/scenes/scene_texts.h"
#include "tests/scenes/test_folder.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::cloth_shape_test {
namespace {

// A square of 10 cm, upright; its vt lie in a unit of 20 cm, the second triangle apart from the first and turned by half.
constexpr const char* square =
    "v 0 1 0\nv 0.1 1 0\nv 0.1 1.1 0\nv 0 1.1 0\n"
    "vt 0 0\nvt 0.5 0\nvt 0.5 0.5\n"
    "vt 3 3\nvt 2.5 2.5\nvt 3 2.5\n"
    "f 1/1 2/2 3/3\nf 1/4 3/5 4/6\n";

constexpr const char* woven = "stretch_stiffness = [300.0, 100.0]\nshear_stiffness = 20.0\nspring_damping = 0.0";

BuiltScene built(const test::TestFolder& folder, const std::string& obj, const std::string& keys,
                 const std::string& fabric = woven) {
    folder.write("cloth.obj", obj);
    return build_scene(load_scene(folder.write("scene.toml", "gravity = [0, 0, 0]\n[fabric.f]\n" + fabric +
                                                                 "\n[[cloth]]\nname = \"c\"\nfabric = \"f\"\nmesh = "
                                                                 "\"cloth.obj\"\n" +
                                                                 keys)));
}

std::string fault(const std::string& obj, const std::string& keys) {
    const test::TestFolder folder;
    return error_of([&] { built(folder, obj, keys); });
}

// N/m of the energy that 1 % of strain along an axis stores, Poisson's ratio 0.
double modulus_along(BuiltScene& scene, int axis) {
    std::vector<Vec3> x(scene.simulation.positions({0}).begin(), scene.simulation.positions({0}).end());
    for (Vec3& point : x) point[axis] *= 1.01;
    scene.simulation.set_positions({0}, x);
    const double green = 0.5 * (1.01 * 1.01 - 1.0);
    return 2.0 * scene.simulation.energy().elastic / (green * green * 0.01);
}

bool says(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("a rest mesh is cut as the mesh of the start is, where a polygon is concave in one of them") {
    const test::TestFolder folder;
    folder.write("flat.obj", "v 0 0 0\nv 0.1 0 0\nv 0.1 0 0.1\nv 0 0 0.1\nf 1 2 3 4\n");
    const char* dart = "v 0 0 0\nv 0.1 0 0.05\nv 0 0 0.1\nv 0.05 0 0.05\nf 1 2 3 4\n";
    const BuiltScene scene = built(folder, dart, "rest = \"flat.obj\"\nwarp = [1, 0, 0]\n");
    CHECK(scene.rest_shapes[0].corners.size() == 2);
    CHECK(scene.cloth_meshes[0].triangles != std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}});
}

TEST_CASE("vt are the rest shape, uv_scale metres a unit, warp along v if not said, panels apart") {
    struct Case {
        const char* keys;
        double along_x, along_y;
    };
    for (const Case& c : {Case{"", 100.0, 300.0},
                          {"warp = \"v\"\n", 100.0, 300.0},
                          {"warp = \"u\"\n", 300.0, 100.0},
                          {"warp = [0, -2]\n", 100.0, 300.0}}) {
        CAPTURE(c.keys);
        const test::TestFolder folder;
        const std::string keys = std::string("rest = \"uv\"\nuv_scale = 0.2\n") + c.keys;
        BuiltScene scene = built(folder, square, keys);
        CHECK(scene.warnings.empty());
        CHECK(scene.simulation.energy().elastic < 1e-20);
        CHECK(std::abs(scene.simulation.largest_strain()) < 1e-12);
        CHECK(modulus_along(scene, 0) == Approx(c.along_x));
        BuiltScene other = built(folder, square, keys);
        CHECK(modulus_along(other, 1) == Approx(c.along_y));
    }
}

TEST_CASE("the pose turns a cloth that is its own rest shape with its warp, and scales a rest shape with it") {
    const test::TestFolder folder;
    const std::string turned = "pose = { rotation = [0.7071067811865476, 0, 0, 0.7071067811865476] }\n";
    BuiltScene scene = built(folder, square, "warp = [1, 0, 0]\n" + turned);
    CHECK(modulus_along(scene, 1) == Approx(300.0));
    BuiltScene scaled = built(folder, square, "rest = \"uv\"\nuv_scale = 0.2\npose = { scale = 3.0 }\n");
    CHECK(std::abs(scaled.simulation.largest_strain()) < 1e-12);
}

TEST_CASE("another mesh of the same triangles is the rest shape, in the same unit") {
    const test::TestFolder folder;
    folder.write("flat.obj", "v 0 0 0\nv 0 0 -8\nv 8 0 -8\nv 8 0 0\nf 1 2 3\nf 1 3 4\n");
    const std::string in_cm = "v 0 0 0\nv 10 0 0\nv 10 10 0\nv 0 10 0\nf 1 2 3\nf 1 3 4\n";
    const BuiltScene scene = built(folder, in_cm, "unit = \"cm\"\nrest = \"flat.obj\"\nwarp = [0, 0, 1]\n");
    CHECK(scene.simulation.largest_strain() == Approx(0.25));
    CHECK(scene.warnings.empty());
}

TEST_CASE("a rest shape in what is likely another unit is warned of, with the scale that fits") {
    const test::TestFolder folder;
    const BuiltScene scene = built(folder, square, "rest = \"uv\"\nuv_scale = 20.0\n");
    REQUIRE(scene.warnings.size() == 1);
    CHECK(scene.warnings[0].kind == "rest_scale");
    CHECK(says(scene.warnings[0].what, "100 times as long"));
    CHECK(scene.warnings[0].fix == "with uv_scale = 0.2 they would be as long");
}

TEST_CASE("what a rest shape or a warp lacks is one error with its place") {
    CHECK(says(fault(square, "rest = \"none.obj\"\n"), "no such file"));
    CHECK(says(fault("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "rest = \"uv\"\n"), "no texture index (vt)"));
    CHECK(says(fault("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/2 3/1\n", "rest = \"uv\"\n"),
               "texture index 2 is out of range 1 ... 1"));
    CHECK(says(fault("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\n", "rest = \"uv\"\n"),
               "triangle 0 of its rest shape has no area"));
    CHECK(says(fault(square, "warp = \"u\"\n"), "needs rest = \"uv\""));
    CHECK(says(fault(square, "rest = \"uv\"\nwarp = [1, 0, 0]\n"), "with rest = \"uv\""));
    CHECK(says(fault(square, "warp = [0, 0, 0]\n"), "must not be zero"));
    CHECK(says(fault(square, "warp = \"w\"\n"), "warp"));
    CHECK(says(fault(square, "warp = [0, 0, 1]\n"), "upright on triangle 0"));
    CHECK(says(fault(square, "uv_scale = 2.0\n"), "uv_scale needs rest = \"uv\""));
    CHECK(says(fault(square, "rest = \"uv\"\nuv_scale = 0\n"), "allowed"));
    CHECK(says(fault(square, ""), "does not say where warp is"));
}

TEST_CASE("a relative path starts at the scene file's folder, an absolute one stays") {
    Scene scene;
    scene.file = "some/folder/scene.toml";
    CHECK(path_beside(scene, "a.obj") == "some/folder/a.obj");
    CHECK(path_beside(scene, "../a.obj") == "some/folder/../a.obj");
    CHECK(path_beside(scene, "/folder/a.obj") == "/folder/a.obj");
    scene.file = "scene.toml";
    CHECK(path_beside(scene, "a.obj") == "a.obj");
}

}  // namespace percale::scenes::test::cloth_shape_test

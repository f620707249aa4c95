#include "scenes/models/mesh_part.h"

#include <sstream>

#include "percale/error.h"
#include "scenes/meshes/mesh_import.h"
#include "scenes/meshes/obj_file.h"
#include "tests/scenes/scene_texts.h"
#include "tests/scenes/test_folder.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::mesh_part_test {
namespace {

// A body with its skin in two groups, eyes as an object of their own, and a face before any name.
const std::string body =
    "v 9 9 9\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 2/1 3/2 4/3\n"
    "o The Body \ng skin arm\nv 0 0 1\nf 2/1 3/2 5/3\ng skin leg\nv 0 0 2\nf 2/1 4/2 6/3\n"
    "o Eyes\ng\nv 3 0 0\nf -1/1 3/2 4/3\n";

TriangleMesh part_of(const std::string& part) {
    std::istringstream in(body);
    return read_obj(in, "body.obj", part);
}

}  // namespace

TEST_CASE("an object or a group of an OBJ file is taken with its own vertices, in their order") {
    CHECK(part_of("").triangles.size() == 4);
    CHECK(part_of("").vertices.size() == 7);  // with the one that no face has
    const TriangleMesh skin = part_of("skin");
    CHECK(skin.vertices == std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 2}});
    CHECK(skin.triangles == std::vector<Triangle>{{0, 1, 3}, {0, 2, 4}});
    CHECK(part_of("leg").triangles == std::vector<Triangle>{{0, 1, 2}});
    CHECK(part_of("The Body").triangles == skin.triangles);
    CHECK(part_of("Eyes").vertices == std::vector<Vec3>{{1, 0, 0}, {0, 1, 0}, {3, 0, 0}});
    std::istringstream in(body);
    const TexturedMesh leg = read_textured_obj(in, "body.obj", "leg");
    CHECK(leg.mesh.vertices == part_of("leg").vertices);
    REQUIRE(leg.uv.size() == 1);
    CHECK(leg.uv[0] == std::array<Eigen::Vector2d, 3>{Eigen::Vector2d(0, 0), Eigen::Vector2d(1, 0), Eigen::Vector2d(0, 1)});
}

TEST_CASE("a part that a file does not have is reported with those that it has") {
    CHECK(error_of([] { part_of("eyes"); }) ==
          "body.obj: no object or group 'eyes' with faces; did you mean 'Eyes'? valid: The Body, skin, arm, leg, Eyes");
    std::istringstream bare("o none\no\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    CHECK(error_of([&] { read_obj(bare, "bare.obj", "none"); }) ==
          "bare.obj: no object or group 'none' with faces; the file names none");
    std::istringstream in("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    CHECK(error_of([&] { read_obj(in, "plain.obj", "skin"); }) ==
          "plain.obj: no object or group 'skin' with faces; the file names none");
    const TestFolder folder;
    const std::string off = folder.write("plain.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    CHECK(error_of([&] { import_mesh(off, 1.0, nullptr, "skin"); }) == off + ": has no objects or groups, so none named 'skin'");
}

TEST_CASE("vertices that no triangle has are left out") {
    TriangleMesh mesh{.vertices = {{5, 0, 0}, {1, 0, 0}, {5, 0, 0}, {2, 0, 0}, {3, 0, 0}}, .triangles = {{4, 1, 3}, {3, 1, 4}}};
    drop_unused_vertices(mesh);
    CHECK(mesh.vertices == std::vector<Vec3>{{1, 0, 0}, {2, 0, 0}, {3, 0, 0}});
    CHECK(mesh.triangles == std::vector<Triangle>{{2, 0, 1}, {1, 0, 2}});
}

}  // namespace percale::scenes::test::mesh_part_test

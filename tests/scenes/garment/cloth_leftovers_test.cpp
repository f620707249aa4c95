#include "scenes/garment/cloth_leftovers.h"

#include "scenes/format/scene_file.h"
#include "scenes/meshes/obj_file.h"
#include "scenes/run/scene_build.h"
#include "tests/scenes/message_of.h"
#include "tests/scenes/test_folder.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::cloth_leftovers_test {
namespace {

/// A grid whose first vertex is loose, with two triangles once more, turned and mirrored, one of them before others.
TriangleMesh littered() {
    TriangleMesh mesh = make_grid(0.4, 0.4, 5, 5);
    mesh.vertices.insert(mesh.vertices.begin(), Vec3(9, 9, 9));
    for (Triangle& triangle : mesh.triangles)
        for (int& corner : triangle) ++corner;
    const Triangle a = mesh.triangles[2], b = mesh.triangles[7];
    mesh.triangles.insert(mesh.triangles.begin() + 5, Triangle{a[1], a[2], a[0]});
    mesh.triangles.push_back({b[1], b[0], b[2]});
    mesh.vertices.push_back({8, 8, 8});
    return mesh;
}

std::string scene_text(const std::string& keys) {
    return "duration = 0.1\n[fabric.f]\nsprings = { structural = 100.0 }\n[[cloth]]\nname = \"c\"\nfabric = \"f\"\n"
           "mesh = \"littered.obj\"\n" +
           keys;
}

BuiltScene built(const TestFolder& folder, const std::string& keys) {
    const TriangleMesh mesh = littered();
    write_obj(folder.path("littered.obj"), mesh.vertices, mesh.triangles);
    return build_scene(load_scene(folder.write("scene.toml", scene_text(keys))));
}

}  // namespace

TEST_CASE("loose vertices and repeated triangles are found, and dropped from mesh and rest shape; the rest keeps its order") {
    const TriangleMesh clean = make_grid(0.4, 0.4, 5, 5);
    TriangleMesh mesh = littered();
    const Leftovers leftovers = leftovers_of(mesh);
    CHECK(leftovers.vertices == std::vector<int>{0, 26});
    CHECK(leftovers.triangles == std::vector<int>{5, static_cast<int>(clean.triangles.size()) + 1});
    CHECK(leftovers.text() == "2 vertices of no triangle and 2 repeated triangles");
    RestShape rest;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) rest.corners.push_back({Vec3(static_cast<double>(t), 0, 0), {}, {}});
    drop_leftovers(leftovers, mesh, rest);
    CHECK(mesh.vertices == clean.vertices);
    CHECK(mesh.triangles == clean.triangles);
    REQUIRE(rest.corners.size() == clean.triangles.size());
    CHECK(rest.corners[4][0].x() == 4.0);
    CHECK(rest.corners[5][0].x() == 6.0);
    CHECK_FALSE(leftovers_of(mesh).any());
}

TEST_CASE("a scene runs a littered garment and says what it left out, unless it names vertices by number") {
    const TestFolder folder;
    const BuiltScene scene = built(folder, "");
    CHECK(scene.cloth_meshes[0].vertices == make_grid(0.4, 0.4, 5, 5).vertices);
    REQUIRE_FALSE(scene.warnings.empty());
    CHECK(scene.warnings[0].kind == "leftovers");
    CHECK(finding_text(scene.warnings[0]) ==
          "cloth 'c': 2 vertices of no triangle and 2 repeated triangles of its mesh are left out");
    CHECK_NOTHROW(built(folder, "pin = \"boundary\"\n"));
    for (const auto& [keys, use] : {std::pair<std::string, std::string>{"pin = [3]\n", "pin"},
                                    {"[[event]]\ntime = 0.0\npin = { cloth = \"c\", vertices = [3] }\n", "[[event]]"},
                                    {"[[seam]]\nvertices = [[3, 9]]\n", "[[seam]]"}}) {
        const std::string text = message_of([&, &more = keys] { built(folder, more); });
        CAPTURE(text);
        CHECK(text.find("the first is vertex 0; left out they would change the numbers of vertices, which " + use) !=
              std::string::npos);
    }
}

TEST_CASE("vertices behind all others are left out without changing numbers") {
    const TestFolder folder;
    TriangleMesh mesh = make_grid(0.4, 0.4, 5, 5);
    mesh.vertices.push_back({8, 8, 8});
    write_obj(folder.path("littered.obj"), mesh.vertices, mesh.triangles);
    const BuiltScene scene = build_scene(load_scene(folder.write("scene.toml", scene_text("pin = [3]\n"))));
    CHECK(scene.cloth_meshes[0].vertices.size() == 25);
}

}  // namespace percale::scenes::test::cloth_leftovers_test

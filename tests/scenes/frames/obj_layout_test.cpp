#include "scenes/frames/obj_layout.h"

#include <sstream>

#include "percale/error.h"
#include "scenes/meshes/obj_file.h"
#include "tests/scenes/test_folder.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::obj_layout_test {
namespace {

TriangleMesh read(const std::string& text) {
    std::istringstream in(text);
    return read_obj(in, "text");
}

/// The text of a file with other vertices.
std::string again(const TestFolder& folder, const std::string& text, std::span<const Vec3> vertices) {
    return ObjLayout(folder.write("mesh.obj", text)).text(vertices, folder.path("frames"));
}

}  // namespace

TEST_CASE("a polygon that has bent is the same triangles again, where a reader of polygons would cut it otherwise") {
    const TestFolder folder;
    const std::string text = "v 0 0 0\nv 2 0 0\nv 2 0 2\nv 0 0 2\nf 1 2 3 4\n";
    const TriangleMesh flat = read(text);
    TriangleMesh bent = flat;
    bent.vertices[1] = Vec3(0.4, 0, 1.4);  // now the corner is one that turns in, and the fan from the first would fold
    std::string dumb = "v 0 0 0\nv 0.4 0 1.4\nv 2 0 2\nv 0 0 2\nf 1 2 3 4\n";
    CHECK(read(dumb).triangles != flat.triangles);
    const TriangleMesh back = read(again(folder, text, bent.vertices));
    CHECK(back.triangles == flat.triangles);
    CHECK(back.vertices == bent.vertices);
}

TEST_CASE("lines keep their order and what they say, with colours, faces that count backwards and joined lines") {
    const TestFolder folder;
    const std::string text =
        "# a comment\ng a\nv 0 0 0 1 0.5 0.25\nv 1 0 0\nv 0 0 1\nf -3//1 -2//1 \\\n -1//1\ns off\nv 1 0 1\nf -1 -2 -3\nl 1 2\nvn "
        "0 1 0\n";
    const TriangleMesh mesh = read(text);
    const std::string written = again(folder, text, mesh.vertices);
    CHECK(written == "g a\nv 0 0 0 1 0.5 0.25\nv 1 0 0\nv 0 0 1\nf -3 -2 -1\ns off\nv 1 0 1\nf -1 -2 -3\nl 1 2\n");
    CHECK(read(written).triangles == mesh.triangles);
}

TEST_CASE("a material library is found from the other folder") {
    const TestFolder folder;
    std::filesystem::create_directories(folder.path("frames"));
    const std::string text = "mtllib my cloth.mtl\nv 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 3\n";
    CHECK(again(folder, text, read(text).vertices).starts_with("mtllib ../my cloth.mtl\n"));
}

TEST_CASE("a layout fits the mesh of its file and no other") {
    const TestFolder folder;
    const std::string text = "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nf 1 2 3\nf 1 3 4\n";
    const ObjLayout layout(folder.write("mesh.obj", text));
    TriangleMesh mesh = read(text);
    CHECK(layout.fits(mesh));
    std::swap(mesh.triangles[0], mesh.triangles[1]);
    CHECK_FALSE(layout.fits(mesh));
    mesh = read(text);
    mesh.vertices.push_back(Vec3::Zero());
    CHECK_FALSE(layout.fits(mesh));
}

TEST_CASE("a file that is no mesh is refused as its reader does") {
    const TestFolder folder;
    CHECK_THROWS_WITH(ObjLayout(folder.write("mesh.obj", "v 0 0 0\nf 1 2 3\n")), Catch::Contains("mesh.obj:2"));
    CHECK_THROWS_AS(ObjLayout(folder.path("none.obj")), SceneError);
}

TEST_CASE("what a comment says of how a face is cut has to be right") {
    const std::string quad = "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nf 1 2 3 4\n";
    CHECK(read(quad + "#percale corners 1 2 3 1 3 0\n").triangles == std::vector<Triangle>{{1, 2, 3}, {1, 3, 0}});
    CHECK(read(quad + "#percale is a cloth engine\n").triangles.size() == 2);
    CHECK_THROWS_WITH(read(quad + "#percale corners 0 1 2\n"),
                      Catch::Contains("text:6: a face of 4 corners is cut into 2 triangles, not 1"));
    CHECK_THROWS_WITH(read(quad + "#percale corners 0 1 2 0 2 4\n"), Catch::Contains("text:6: corner 4 of a face with 4"));
    CHECK_THROWS_WITH(read(quad + "#percale corners 0 1 2 0 2\n"), Catch::Contains("corner is missing"));
    CHECK_THROWS_WITH(read("#percale corners 0 1 2\n" + quad), Catch::Contains("text:1: no face stands above it"));
    CHECK_THROWS_WITH(read(quad + "#percale corners 0 1 2 0 2 3 0 1 2 0 1 2 0 1 2 0 1 2\n"), Catch::Contains("triangles, not"));
}

}  // namespace percale::scenes::test::obj_layout_test

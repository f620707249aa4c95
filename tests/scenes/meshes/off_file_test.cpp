#include "scenes/meshes/off_file.h"

#include <sstream>

#include "tests/scenes/message_of.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::off_file_test {
namespace {

TriangleMesh parse(const std::string& text) {
    std::istringstream in(text);
    return read_off(in, "mesh.off");
}

std::string refusal(const std::string& text) {
    return message_of([&] { parse(text); });
}

const std::string corners = "0 0 0\n1 0 0\n0 1 0\n";

}  // namespace

TEST_CASE("an OFF is exactly its vertices and faces, in order, doubles included") {
    const TriangleMesh mesh = parse("OFF\n4 2 0\n\n0.1 0 0\n1 0 0\n0 1 0\n0 1 0\n3 2 0 1\n3 3 1 0\n");
    CHECK(mesh.vertices == std::vector<Vec3>{{0.1, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 1, 0}});
    CHECK(mesh.triangles == std::vector<Triangle>{{2, 0, 1}, {3, 1, 0}});
}

TEST_CASE("every variant of the header leads to the same triangle") {
    for (const std::string header :
         {"OFF\n3 1 0\n", "OFF 3 1 0\n", "OFF 3 1\n", "3 1 0\n", "# made by hand\n\nOFF # this\n# counts\n3 1 0 # end\n",
          "OFF\r\n3 1 0\r\n", "COFF\n3 1 0\n", "NOFF\n3 1 0\n", "STCNOFF\n3 1 0\n"}) {
        INFO(header);
        CHECK(parse(header + corners + "3 0 1 2\n").triangles == std::vector<Triangle>{{0, 1, 2}});
    }
}

TEST_CASE("normals, colours and comments behind the numbers are passed over") {
    const TriangleMesh mesh =
        parse("COFF\n3 1 0\n0 0 0 255 0 0 255\n1 0 0 0 255 0 255 # green\n0 1 0 0 0 1 1\n3 0 1 2 0.5 0.5 0.5");
    CHECK(mesh.vertices == std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    CHECK(mesh.triangles == std::vector<Triangle>{{0, 1, 2}});
}

TEST_CASE("a convex OFF polygon is fanned from its first corner") {
    CHECK(parse("OFF 5 1 0\n0 0 0\n1 0 0\n2 1 0\n1 2 0\n0 1 0\n5 4 3 2 1 0\n").triangles ==
          std::vector<Triangle>{{4, 3, 2}, {4, 2, 1}, {4, 1, 0}});
}

TEST_CASE("a header that claims more than the file holds is refused at once") {
    const std::string text = "OFF\n536870912 6 0\n" + corners + "3 0 1 2\n";
    CHECK(refusal(text) == "mesh.off:2: number of vertices is 536870912, but the file can hold " +
                               std::to_string((text.size() + 1) / 6) + " at most");
    CHECK(refusal("OFF\n3 536870912 0\n" + corners + "3 0 1 2\n").find("mesh.off:2: number of faces is 536870912, but") == 0);
    CHECK(refusal("OFF\n99999999999999999999 1 0\n" + corners).find("mesh.off:2: number of vertices is not a whole number") == 0);
}

TEST_CASE("the shortest possible file passes the bound") {
    CHECK(parse("3 1\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2").triangles.size() == 1);
    std::string many = "OFF\n1000 1\n";
    for (int k = 0; k < 1000; ++k) many += "0 0 " + std::to_string(k % 10) + "\n";
    CHECK(parse(many + "3 0 1 2").vertices.size() == 1000);
}

TEST_CASE("a file that ends early says how far it got") {
    CHECK(refusal("OFF\n3 1 0\n0 0 0\n1 0 0                        \n") == "mesh.off:4: the file ends after 2 of 3 vertices");
    CHECK(refusal("OFF\n3 2 0\n" + corners + "3 0 1 2\n") == "mesh.off:6: the file ends after 1 of 2 faces");
}

TEST_CASE("what is wrong in an OFF is said with its line") {
    CHECK(refusal("OFF\n3 1 0\n" + corners + "3 0 1 3\n") == "mesh.off:6: vertex index 3 is out of range 0 ... 2");
    CHECK(refusal("OFF\n3 1 0\n" + corners + "3 0 1 -1\n") == "mesh.off:6: vertex index -1 is out of range 0 ... 2");
    CHECK(refusal("OFF\n3 1 0\n" + corners + "3 0 1\n") == "mesh.off:6: vertex index is missing");
    CHECK(refusal("OFF\n3 1 0\n" + corners + "2 0 1\n") == "mesh.off:6: a face needs 3 corners or more, this one has 2");
    CHECK(refusal("OFF\n3 1 0\n0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n") == "mesh.off:4: coordinate y is not finite: \"nan\"");
    CHECK(refusal("OFF\n3 1 0\n0 0 0\n1 x 0\n0 1 0\n3 0 1 2\n") == "mesh.off:4: coordinate y is not a number: \"x\"");
    CHECK(refusal("OFF\n0 1 0\n") == "mesh.off:2: number of vertices is 0");
    CHECK(refusal("OFF\n3 0 0\n" + corners) == "mesh.off:2: number of faces is 0");
    CHECK(refusal("OFF\n3\n" + corners) == "mesh.off:2: number of faces is missing");
}

TEST_CASE("other files and other dimensions are refused by name") {
    CHECK(refusal("") == "mesh.off: no vertices: the file is empty");
    CHECK(refusal("# only a comment\n") == "mesh.off: no vertices: the file is empty");
    CHECK(refusal("ply\nformat ascii 1.0\n") == "mesh.off:1: not an OFF file: it starts with \"ply\"");
    CHECK(refusal("4OFF\n3 1 0\n") == "mesh.off:1: \"4OFF\": only three-dimensional OFF files are read");
    CHECK(refusal("nOFF\n4\n3 1 0\n") == "mesh.off:1: \"nOFF\": only three-dimensional OFF files are read");
    CHECK(refusal("OFF BINARY\n") == "mesh.off:1: binary OFF files are not read");
}

}  // namespace percale::scenes::test::off_file_test

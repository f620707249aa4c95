#include "scenes/meshes/mesh_import.h"

#include <cmath>
#include <cstring>

#include "tests/scenes/collada_text.h"
#include "tests/scenes/message_of.h"
#include "tests/scenes/test_folder.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::mesh_import_test {
namespace {

std::string refusal(const TestFolder& folder, const std::string& name, const std::string& content) {
    const std::string file = folder.write(name, content);
    const std::string message = message_of([&] { import_mesh(file); });
    return message.rfind(file, 0) == 0 ? message.substr(file.size()) : message;
}

const std::vector<Vec3> tetra_vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 2}};
const std::vector<Triangle> tetra_triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};

const std::string tetra_points = "0 0 0\n1 0 0\n0 1 0\n0 0 2\n";
const std::string tetra_faces = "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
const std::string ply_header =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 4\n"
    "property list uchar int vertex_indices\nend_header\n";

std::string text_stl(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles) {
    std::string text = "solid test\n";
    for (const Triangle& t : triangles) {
        text += "facet normal 0 0 0\nouter loop\n";
        for (const int v : t)
            text += "vertex " + std::to_string(vertices[v][0]) + " " + std::to_string(vertices[v][1]) + " " +
                    std::to_string(vertices[v][2]) + "\n";
        text += "endloop\nendfacet\n";
    }
    return text + "endsolid test\n";
}

template <typename Number>
void append_bytes(std::string& text, Number number) {
    char bytes[sizeof number];
    std::memcpy(bytes, &number, sizeof number);
    text.append(bytes, sizeof number);
}

std::string binary_stl(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles) {
    std::string text(80, ' ');
    append_bytes(text, static_cast<std::uint32_t>(triangles.size()));
    for (const Triangle& t : triangles) {
        text.append(12, '\0');
        for (const int v : t)
            for (int axis = 0; axis < 3; ++axis) append_bytes(text, static_cast<float>(vertices[v][axis]));
        text.append(2, '\0');
    }
    return text;
}

/// Triangles as points in space, so that two numberings can be compared.
std::vector<std::array<double, 9>> as_points(const TriangleMesh& mesh) {
    std::vector<std::array<double, 9>> result;
    for (const Triangle& t : mesh.triangles) {
        std::array<double, 9> points{};
        for (int k = 0; k < 9; ++k) points[k] = mesh.vertices[t[k / 3]][k % 3];
        result.push_back(points);
    }
    return result;
}

/// A COLLADA scene: one triangle, used by two nodes, the second one inside a moved and scaled node.
const std::string two_nodes = test::collada(R"(<node id="n1"><instance_geometry url="#g"/></node>
<node id="n2"><translate>10 0 0</translate><node id="n3"><scale>2 2 2</scale><instance_geometry url="#g"/></node></node>
)");

}  // namespace

TEST_CASE("OBJ, OFF and PLY give the file's vertices in the file's order") {
    const TestFolder folder;
    std::string obj;
    for (const Vec3& x : tetra_vertices)
        obj += "v " + std::to_string(x[0]) + " " + std::to_string(x[1]) + " " + std::to_string(x[2]) + "\n";
    for (const Triangle& t : tetra_triangles)
        obj += "f " + std::to_string(t[0] + 1) + " " + std::to_string(t[1] + 1) + " " + std::to_string(t[2] + 1) + "\n";
    for (const std::string& file :
         {folder.write("a.obj", obj), folder.write("a.off", "OFF\n4 4 0\n" + tetra_points + tetra_faces),
          folder.write("B.PLY", ply_header + tetra_points + tetra_faces),
          folder.write("no extension", "OFF\n4 4 0\n" + tetra_points + tetra_faces)}) {
        INFO(file);
        const TriangleMesh mesh = import_mesh(file);
        CHECK(mesh.vertices == tetra_vertices);
        CHECK(mesh.triangles == tetra_triangles);
    }
}

TEST_CASE("the triangles of an STL share their vertices again, in the order of first appearance") {
    const TestFolder folder;
    TriangleMesh expected;
    expected.vertices = tetra_vertices;
    expected.triangles = tetra_triangles;
    for (const std::string& file : {folder.write("text.stl", text_stl(tetra_vertices, tetra_triangles)),
                                    folder.write("binary.stl", binary_stl(tetra_vertices, tetra_triangles))}) {
        INFO(file);
        const TriangleMesh mesh = import_mesh(file);
        CHECK(mesh.vertices == std::vector<Vec3>{tetra_vertices[0], tetra_vertices[2], tetra_vertices[1], tetra_vertices[3]});
        CHECK(as_points(mesh) == as_points(expected));
    }
}

TEST_CASE("the unit scales the coordinates and must be positive") {
    const TestFolder folder;
    const std::string file = folder.write("a.off", "OFF\n4 4 0\n" + tetra_points + tetra_faces);
    CHECK(import_mesh(file, 1e-3).vertices[3] == Vec3(0, 0, 2e-3));
    for (const double unit : {0.0, -1.0, std::nan(""), HUGE_VAL})
        CHECK(message_of([&] { import_mesh(file, unit); }).find("unit is") != std::string::npos);
    const std::string large = folder.write("large.off", "OFF\n3 1 0\n1e308 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    CHECK(message_of([&] { import_mesh(large, 1e3); }) == large + ": vertex 0: coordinate x is not finite");
}

TEST_CASE("all parts of an imported scene are joined with their nodes' transforms") {
    const TestFolder folder;
    const TriangleMesh mesh = import_mesh(folder.write("two.dae", two_nodes));
    CHECK(mesh.vertices == std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {10, 0, 0}, {12, 0, 0}, {10, 2, 0}});
    CHECK(mesh.triangles == std::vector<Triangle>{{0, 1, 2}, {3, 4, 5}});
}

TEST_CASE("a part may be copied, but not without end") {
    const TestFolder folder;
    const auto copies = [&](int count) {
        std::string text = two_nodes;
        std::string nodes;
        for (int i = 0; i < count; ++i) nodes += "<node><instance_geometry url=\"#g\"/></node>";
        text.insert(text.find("<node id=\"n1\">"), nodes);
        return text;
    };
    CHECK(import_mesh(folder.write("some.dae", copies(1000))).triangles.size() == 1002);
    CHECK(refusal(folder, "many.dae", copies(33400)) ==
          ": copies of its parts come to more than 100000 vertices; leave some out");
}

TEST_CASE("polygons of an imported scene are cut into triangles, those without area too") {
    const TestFolder folder;
    const auto quad = [&](const std::string& points) {
        std::string text = two_nodes;
        const auto replace = [&](const std::string& from, const std::string& to) {
            text.replace(text.find(from), from.size(), to);
        };
        replace("count=\"9\">0 0 0 1 0 0 0 1 0", "count=\"12\">" + points);
        replace("count=\"3\" stride", "count=\"4\" stride");
        replace("<triangles count=\"1\">", "<polylist count=\"1\">");
        replace("<p>0 1 2</p></triangles>", "<vcount>4</vcount><p>0 1 2 3</p></polylist>");
        replace("<node id=\"n1\"><instance_geometry url=\"#g\"/></node>", "");
        replace("<translate>10 0 0</translate>", "");
        return import_mesh(folder.write("quad.dae", text));
    };
    const TriangleMesh mesh = quad("0 0 0 2 0 0 2 1 0 0 1 0");
    CHECK(mesh.vertices == std::vector<Vec3>{{0, 0, 0}, {4, 0, 0}, {4, 2, 0}, {0, 2, 0}});
    CHECK(mesh.triangles == std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}});
    CHECK(quad("0 0 0 0 0 0 0 0 0 0 0 1e-30").triangles.size() == 2);
    // An arrow's head, whose fan from the first corner would fold.
    CHECK(quad("0 0 0 2 1 0 0 2 0 1 1 0").triangles == std::vector<Triangle>{{3, 0, 1}, {2, 3, 1}});
}

TEST_CASE("a node of an imported scene is taken alone, in its place") {
    const TestFolder folder;
    const std::string file = folder.write("two.dae", two_nodes);
    CHECK(import_mesh(file, 1.0, nullptr, "n3").vertices == std::vector<Vec3>{{10, 0, 0}, {12, 0, 0}, {10, 2, 0}});
    const std::string fault = message_of([&] { import_mesh(file, 1.0, nullptr, "n4"); });
    CHECK(fault.find(file + ": no object or group 'n4' with faces; did you mean 'n1'? valid: n1, ") == 0);
}

TEST_CASE("an animation that is left out is reported") {
    const TestFolder folder;
    const std::string still = R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],
"buffers":[{"byteLength":76,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAABAAIAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAAAAAAAAAAACgQA=="}],
"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":6},
{"buffer":0,"byteOffset":44,"byteLength":8},{"buffer":0,"byteOffset":52,"byteLength":24}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},
{"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"},
{"bufferView":2,"componentType":5126,"count":2,"type":"SCALAR","min":[0],"max":[1]},
{"bufferView":3,"componentType":5126,"count":2,"type":"VEC3"}])";
    const std::string animation = R"(,
"animations":[{"channels":[{"sampler":0,"target":{"node":0,"path":"translation"}}],"samplers":[{"input":2,"output":3}]}])";
    std::vector<Finding> warnings;
    CHECK(import_mesh(folder.write("still.gltf", still + "}"), 1.0, &warnings).triangles.size() == 1);
    CHECK(warnings.empty());
    const std::string file = folder.write("moves.gltf", still + animation + "}");
    CHECK(import_mesh(file, 1.0, &warnings).triangles.size() == 1);
    REQUIRE(warnings.size() == 1);
    CHECK(warnings[0].kind == "left_out");
    CHECK(warnings[0].place == file);
    CHECK(finding_text(warnings[0]).find(file + ": it is animated, which is left out: ") == 0);
    CHECK(import_mesh(file).triangles.size() == 1);  // nobody asks
}

TEST_CASE("files that are missing, empty, folders or of unknown kind are refused by name") {
    const TestFolder folder;
    const std::string missing = folder.path("missing.obj");
    CHECK(message_of([&] { import_mesh(missing); }) == missing + ": no such file");
    CHECK(message_of([&] { import_mesh(folder.path()); }) == folder.path() + ": not a file");
    for (const std::string name : {"e.obj", "e.off", "e.ply", "e.stl", "e.dae", "e"})
        CHECK(refusal(folder, name, "") == ": no vertices: the file is empty");
    for (const std::string name : {"notes.txt", "tubes.nff", "a.raw", "a.blend", "a"})
        CHECK(refusal(folder, name, "not a mesh at all\n").find(": is of no format that is read: .obj, .off, .ply, ") == 0);
    CHECK(refusal(folder, "broken.dae", "<COLLADA").find(": cannot be imported: ") == 0);
}

TEST_CASE("a header that claims 536870912 vertices is one error, whatever the file is called") {
    const TestFolder folder;
    const std::string off = "OFF\n536870912 4 0\n" + tetra_points + tetra_faces;
    for (const std::string name : {"a.off", "a.dat", "a"})
        CHECK(refusal(folder, name, off).find(":2: number of vertices is 536870912, but the file can hold") == 0);
    std::string ply = ply_header + tetra_points + tetra_faces;
    ply.replace(ply.find("vertex 4"), 8, "vertex 536870912");
    for (const std::string name : {"a.ply", "b.dat", "b"})
        CHECK(refusal(folder, name, ply).find(":3: the header claims 536870912 elements \"vertex\", but the file can hold ") ==
              0);
}

TEST_CASE("an index out of range is refused in every format, not repaired") {
    const TestFolder folder;
    CHECK(refusal(folder, "a.off", "OFF\n4 1 0\n" + tetra_points + "3 0 1 7\n") == ":7: vertex index 7 is out of range 0 ... 3");
    std::string ply = ply_header + tetra_points + tetra_faces;
    ply.replace(ply.rfind("1 2 3"), 5, "1 2 9");
    CHECK(refusal(folder, "a.ply", ply) == ":17: vertex index 9 is out of range 0 ... 3");
}

TEST_CASE("a coordinate that is not finite is refused in every format") {
    const TestFolder folder;
    for (const std::string number : {"nan", "inf", "-inf"}) {
        CHECK(refusal(folder, "a.obj", "v 0 0 " + number + "\n").find(":1: coordinate z is not finite") == 0);
        CHECK(refusal(folder, "a.off", "OFF\n3 1\n0 0 " + number + "\n1 0 0\n0 1 0\n3 0 1 2\n").find(":3: coordinate z") == 0);
        std::vector<Vec3> vertices = tetra_vertices;
        vertices[2][1] = std::stod(number);
        CHECK(refusal(folder, "a.stl", binary_stl(vertices, tetra_triangles)) == ": vertex 1: coordinate y is not finite");
    }
}

TEST_CASE("points and lines alone are no mesh") {
    const TestFolder folder;
    const std::string points =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nend_header\n0 0 0\n1 0 "
        "0\n0 1 0\n";
    CHECK(refusal(folder, "points.ply", points).find(": no triangles") == 0);
    CHECK(refusal(folder, "lines.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n") == ": no triangles");
}

TEST_CASE("a mesh with its fields is that without them, and only PLY has any") {
    const TestFolder folder;
    const std::string lines =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty double heat\nproperty uchar red\n"
        "property float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
    const std::string file = folder.write("a.ply", lines + "0 0.5 255 0 0\n1 inf 0 0 0\n0 -nan 7 1 0\n3 0 1 2\n");
    std::vector<MeshField> fields;
    const TriangleMesh mesh = import_mesh_with_fields(file, fields);
    CHECK(mesh.vertices == import_mesh(file).vertices);
    REQUIRE(fields.size() == 1);
    CHECK(fields[0].name == "heat");
    REQUIRE(fields[0].values.size() == 3);
    CHECK(fields[0].values[0] == 0.5);
    CHECK(std::isinf(fields[0].values[1]));
    CHECK(std::isnan(fields[0].values[2]));
    const auto refused = [&](const std::string& path) {
        return message_of([&] { import_mesh_with_fields(path, fields); }).substr(folder.path().size() + 1);
    };
    CHECK(refused(folder.write("b.ply", lines + "0 warm 255 0 0\n1 0 0 0 0\n0 0 7 1 0\n3 0 1 2\n")) ==
          "b.ply:12: the value of a field is not a number: \"warm\"");
    CHECK(refused(folder.write("a.off", "OFF\n" + tetra_points)) == "a.off: is neither PLY nor OBJ");
    CHECK(refused(folder.path("absent.ply")) == "absent.ply: no such file");
    import_mesh_with_fields(folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), fields);
    CHECK(fields.empty());
}

}  // namespace percale::scenes::test::mesh_import_test

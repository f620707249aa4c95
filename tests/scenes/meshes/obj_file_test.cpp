#include "scenes/meshes/obj_file.h"

#include <chrono>
#include <cstring>
#include <limits>
#include <random>
#include <sstream>

#include "tests/scenes/message_of.h"
#include "tests/scenes/test_folder.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::obj_file_test {
namespace {

TriangleMesh parse(const std::string& text) {
    std::istringstream in(text);
    return read_obj(in, "mesh.obj");
}

std::string refusal(const std::string& text) {
    return message_of([&] { parse(text); });
}

const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

bool same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

}  // namespace

TEST_CASE("an OBJ keeps the order of vertices and faces") {
    const TriangleMesh mesh = parse("v 3 1 2\nv -1e-3 +2.5 .5\nv 7 8 9\nf 3 1 2\nf 1 2 3\n");
    REQUIRE(mesh.vertices.size() == 3);
    CHECK(mesh.vertices[0] == Vec3(3, 1, 2));
    CHECK(mesh.vertices[1] == Vec3(-1e-3, 2.5, 0.5));
    CHECK(mesh.triangles == std::vector<Triangle>{{2, 0, 1}, {0, 1, 2}});
    CHECK_FALSE(mesh.is_grid());
}

TEST_CASE("all four forms of a corner name the same triangle") {
    for (const std::string face :
         {"f 1 2 3", "f 1/1 2/2 3/3", "f 1//1 2//2 3//3", "f 1/4/1 2/5/2 3/6/3", "f -4 -3 -2", "f -4/-1 2 -2//1"})
        CHECK(parse(square + face + "\n").triangles == std::vector<Triangle>{{0, 1, 2}});
}

TEST_CASE("negative indices count back from the vertices read so far, positive ones may point ahead") {
    CHECK(parse("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 9 9 9\nf -3 -2 -1\n").triangles ==
          std::vector<Triangle>{{0, 1, 2}, {1, 2, 3}});
    CHECK(parse("f 1 2 3\n" + square).triangles == std::vector<Triangle>{{0, 1, 2}});
}

TEST_CASE("convex polygons are fanned from their first corner") {
    CHECK(parse(square + "v 0 2 0\nf 2 3 4 5 1\n").triangles == std::vector<Triangle>{{1, 2, 3}, {1, 3, 4}, {1, 4, 0}});
}

TEST_CASE("comments, other keywords, CRLF, continued lines and a missing last line end are read") {
    const TriangleMesh mesh = parse(
        "# a comment\r\nmtllib x.mtl\r\no thing\r\nvt 0 0\r\nvn 0 1 0\r\nv 0 0 0 # here\r\n\r\nv 1 \\\r\n 0 0\r\n  v 0 1 0\r\n"
        "s off\r\nusemtl red\r\nl 1 2\r\nf 1 2 \\\r\n3");
    CHECK(mesh.vertices == std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    CHECK(mesh.triangles == std::vector<Triangle>{{0, 1, 2}});
}

TEST_CASE("a vertex may carry a weight of 1 and a colour") {
    const std::string rest = "\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    for (const std::string first : {"v 1 2 3 1.0", "v 1 2 3 0.5 0.5 0.5", "v 1 2 3 1 0.5 0.5 0.5"})
        CHECK(parse(first + rest).vertices[0] == Vec3(1, 2, 3));
    CHECK(refusal("v 1 2 3 0.5" + rest) == "mesh.obj:1: a vertex weight other than 1 is not supported");
    CHECK(refusal("v 1 2 3 4 5 6 7 8" + rest).find("mesh.obj:1: ") == 0);
}

TEST_CASE("what is wrong with a vertex is said with its line") {
    CHECK(refusal("v 0 0 0\nv 1 0\n") == "mesh.obj:2: coordinate z is missing");
    CHECK(refusal("v 0 0 zero\n") == "mesh.obj:1: coordinate z is not a number: \"zero\"");
    CHECK(refusal("v 0 1,5 0\n") == "mesh.obj:1: coordinate y is not a number: \"1,5\"");
    CHECK(refusal("v +-1 0 0\n") == "mesh.obj:1: coordinate x is not a number: \"+-1\"");
    CHECK(refusal("\n\nv nan 0 0\n") == "mesh.obj:3: coordinate x is not finite: \"nan\"");
    CHECK(refusal("v 0 -inf 0\n") == "mesh.obj:1: coordinate y is not finite: \"-inf\"");
    CHECK(refusal("v 0 0 1e999\n") == "mesh.obj:1: coordinate z is beyond a double: \"1e999\"");
}

TEST_CASE("what is wrong with a face is said with its line") {
    CHECK(refusal(square + "f 1 2 0\n") == "mesh.obj:5: vertex index 0: indices start at 1 (or at -1, backwards)");
    CHECK(refusal(square + "f 1 2 3\nf 1 2 5\n") == "mesh.obj:6: vertex index 5 is out of range 1 ... 4");
    CHECK(refusal(square + "f 1 2 -5\n") == "mesh.obj:5: vertex index -5 reaches before the first of 4 vertices read so far");
    CHECK(refusal(square + "f 1 2\n") == "mesh.obj:5: a face needs 3 corners or more, this one has 2");
    CHECK(refusal(square + "f 1 2 3.5\n") == "mesh.obj:5: vertex index is not a whole number: \"3.5\"");
    CHECK(refusal(square + "f 1 2 99999999999999999999\n").find("mesh.obj:5: vertex index is not a whole number") == 0);
    CHECK(refusal(square + "f 1/x 2 3\n") == "mesh.obj:5: texture index is not a whole number: \"x\"");
    CHECK(refusal(square + "f 1//x 2 3\n") == "mesh.obj:5: normal index is not a whole number: \"x\"");
}

TEST_CASE("the line of a continued statement is the one it starts on") {
    CHECK(refusal("v 0 0 0\nv 1 \\\n 0 \\\n bad\n") == "mesh.obj:2: coordinate z is not a number: \"bad\"");
    CHECK(refusal("v 0 \\\n0 0\nv 0 0 bad\n") == "mesh.obj:3: coordinate z is not a number: \"bad\"");
}

TEST_CASE("an OBJ without vertices or triangles is refused") {
    CHECK(refusal("") == "mesh.obj: no vertices");
    CHECK(refusal("# nothing\n") == "mesh.obj: no vertices");
    CHECK(refusal(square) == "mesh.obj: no triangles");
}

TEST_CASE("bytes that are no text do not reach the message") {
    const std::string message = refusal(std::string("v 0 0 \x01\xff") + std::string(100, 'x') + "\n");
    CHECK(message.find_first_of("\x01\xff") == std::string::npos);
    CHECK(message.size() < 120);
}

TEST_CASE("what is written reads back to the same bits") {
    std::mt19937_64 random(7);
    TriangleMesh mesh;
    mesh.vertices = {{0.0, -0.0, 0.1},
                     {1.0 / 3.0, std::numeric_limits<double>::denorm_min(), 5e-324},
                     {std::numeric_limits<double>::max(), std::numeric_limits<double>::min(), -1e-17}};
    while (mesh.vertices.size() < 1000) {
        Vec3 x;
        for (double& coordinate : x)
            coordinate = std::ldexp(static_cast<double>(random()) - 9e18, static_cast<int>(random() % 200) - 100);
        mesh.vertices.push_back(x);
    }
    for (int k = 0; k + 2 < 1000; ++k) mesh.triangles.push_back({k, k + 2, k + 1});
    const TestFolder folder;
    write_obj(folder.path("out.obj"), mesh.vertices, mesh.triangles);
    std::ifstream in(folder.path("out.obj"));
    const TriangleMesh back = read_obj(in, "out.obj");
    REQUIRE(back.vertices.size() == mesh.vertices.size());
    CHECK(back.triangles == mesh.triangles);
    int different = 0;
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
        for (int axis = 0; axis < 3; ++axis) different += same_bits(back.vertices[v][axis], mesh.vertices[v][axis]) ? 0 : 1;
    CHECK(different == 0);
}

TEST_CASE("a written OBJ is plain lines, replaces an earlier file and leaves no other") {
    const TestFolder folder;
    folder.write("out.obj", "old");
    const std::vector<Vec3> vertices = {{0, 0.25, 0}, {1, 0, 0}, {0, 0, -1}};
    const std::vector<Triangle> triangles = {{0, 1, 2}};
    write_obj(folder.path("out.obj"), vertices, triangles);
    CHECK(folder.read("out.obj") == "v 0 0.25 0\nv 1 0 0\nv 0 0 -1\nf 1 2 3\n");
    CHECK(folder.file_count() == 1);
}

TEST_CASE("a file that cannot be written is refused with the system's reason, and nothing is left") {
    const TestFolder folder;
    const std::vector<Vec3> vertices = {{0, 0, 0}};
    const std::string missing = folder.path("no/such/folder.obj");
    CHECK(message_of([&] { write_obj(missing, vertices, {}); }) == missing + ": cannot be written: No such file or directory");
    std::filesystem::create_directory(folder.path("taken.obj"));
    CHECK(message_of([&] { write_obj(folder.path("taken.obj"), vertices, {}); }).find(": cannot be written: Is a directory") !=
          std::string::npos);
    CHECK(folder.file_count() == 0);
}

TEST_CASE("a full disk is reported") {
    if (!std::filesystem::exists("/dev/full")) return;
    const TestFolder folder;
    std::filesystem::create_symlink("/dev/full", folder.path("out.obj.part"));
    const std::vector<Vec3> vertices(10000, Vec3(0.1, 0.2, 0.3));
    CHECK(message_of([&] { write_obj(folder.path("out.obj"), vertices, {}); }).find("No space left on device") !=
          std::string::npos);
    CHECK(folder.file_count() == 0);
}

TEST_CASE("a frame of 4225 vertices is written in milliseconds") {
    const TriangleMesh grid = make_grid(1.0, 1.0, 65, 65);
    const TestFolder folder;
    double best = 1e9;
    for (int run = 0; run < 10; ++run) {
        const auto start = std::chrono::steady_clock::now();
        write_obj(folder.path("frame.obj"), grid.vertices, grid.triangles);
        best = std::min(best, std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
    }
    INFO(best << " ms");
    CHECK(best < 100.0);  // 2 ms unhurried; sanitizers and busy machines are slower
}

}  // namespace percale::scenes::test::obj_file_test

#include "scenes/meshes/ply_output.h"

#include <cmath>
#include <cstring>
#include <fstream>

#include "percale/error.h"
#include "scenes/meshes/ply_file.h"
#include "tests/scenes/test_folder.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::ply_output_test {
namespace {

TriangleMesh odd_sphere() {
    TriangleMesh mesh = make_sphere(1.0 / 3.0, 1);
    for (Vec3& x : mesh.vertices) x /= 7.0;
    mesh.vertices[0].x() = -0.0;
    return mesh;
}

float float_at(const std::string& bytes, std::size_t place) {
    float value = 0.0f;
    std::memcpy(&value, bytes.data() + place, sizeof value);
    return value;
}

}  // namespace

TEST_CASE("a mesh as PLY reads back with the same bits, with and without fields") {
    const TestFolder folder;
    const TriangleMesh mesh = odd_sphere();
    MeshFields fields;
    if (GENERATE(false, true)) {
        fields.vertex = {{"pressure", std::vector<double>(mesh.vertices.size(), 2.5)}};
        fields.triangle = {{"strain_warp", std::vector<double>(mesh.triangles.size(), 0.1)}};
    }
    write_ply(folder.path("a.ply"), mesh, fields);
    std::ifstream in(folder.path("a.ply"), std::ios::binary);
    const TriangleMesh read = read_ply(in, "a.ply");
    CHECK(read.triangles == mesh.triangles);
    REQUIRE(read.vertices.size() == mesh.vertices.size());
    CHECK(std::memcmp(read.vertices.data(), mesh.vertices.data(), mesh.vertices.size() * sizeof(Vec3)) == 0);
}

TEST_CASE("fields stand behind the coordinates of their vertex and the corners of their triangle") {
    const TestFolder folder;
    const TriangleMesh mesh{.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, .triangles = {{0, 1, 2}}};
    write_ply(folder.path("a.ply"), mesh, {.vertex = {{"a", {1, 2, 3}}, {"b", {4, 5, 6}}}, .triangle = {{"c", {0.25}}}});
    const std::string bytes = folder.read("a.ply");
    const std::size_t body = bytes.find("end_header\n") + 11;
    CHECK(bytes.size() == body + 3 * (24 + 8) + 13 + 4);
    for (int v = 0; v < 3; ++v) {
        CHECK(float_at(bytes, body + 32 * v + 24) == static_cast<float>(1 + v));
        CHECK(float_at(bytes, body + 32 * v + 28) == static_cast<float>(4 + v));
    }
    CHECK(float_at(bytes, bytes.size() - 4) == 0.25f);
    CHECK(bytes.find("property float b\nelement face 1\n") != std::string::npos);
}

TEST_CASE("a field of another number of values is refused, and nothing is written") {
    const TestFolder folder;
    const TriangleMesh mesh = odd_sphere();
    CHECK_THROWS_WITH(write_ply(folder.path("a.ply"), mesh, {.vertex = {{"pressure", {1.0}}}}),
                      Catch::Contains("field pressure has 1 values for 42 places"));
    CHECK_THROWS_AS(write_ply(folder.path("a.ply"), mesh, {.vertex = {}, .triangle = {{"x", {}}}}), SceneError);
    CHECK(folder.file_count() == 0);
}

TEST_CASE("fields of vertices read back as the floats that were written, what is infinite included") {
    const TestFolder folder;
    const TriangleMesh mesh = odd_sphere();
    std::vector<double> distance(mesh.vertices.size()), pressure(mesh.vertices.size(), 0.1);
    for (std::size_t v = 0; v < distance.size(); ++v) distance[v] = 1.0 / (static_cast<double>(v) - 3.0);
    write_ply(folder.path("a.ply"), mesh,
              {.vertex = {{"distance", distance}, {"pressure", pressure}},
               .triangle = {{"strain_warp", std::vector<double>(mesh.triangles.size(), 0.1)}}});
    std::ifstream in(folder.path("a.ply"), std::ios::binary);
    std::vector<MeshField> fields{{"left over", {1.0}}};
    CHECK(read_ply(in, "a.ply", &fields).vertices == mesh.vertices);
    REQUIRE(fields.size() == 2);
    CHECK(fields[0].name == "distance");
    CHECK(fields[1].name == "pressure");
    for (std::size_t v = 0; v < distance.size(); ++v) {
        CHECK(fields[0].values[v] == static_cast<double>(static_cast<float>(distance[v])));
        CHECK(fields[1].values[v] == static_cast<double>(0.1f));
    }
    CHECK(std::isinf(fields[0].values[3]));
}

}  // namespace percale::scenes::test::ply_output_test

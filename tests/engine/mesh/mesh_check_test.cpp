#include <limits>

#include "percale/mesh.h"
#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"

namespace percale::test::mesh_check_test {
namespace {

TriangleMesh two_triangles() {
    TriangleMesh mesh;
    mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {1, 0, 1}};
    mesh.triangles = {{0, 2, 1}, {1, 2, 3}};
    return mesh;
}

std::string refusal(const TriangleMesh& mesh, bool for_cloth = true) {
    return scene_error([&] { check_mesh(mesh, "shirt", for_cloth); });
}

}  // namespace

TEST_CASE("Good meshes pass the check") {
    CHECK(refusal(two_triangles()) == "");
    CHECK(refusal(two_triangles(), false) == "");
    CHECK(refusal(make_grid(1.0, 1.0, 4, 9)) == "");
    CHECK(refusal(make_sphere(1.0, 2)) == "");
}

TEST_CASE("A mesh without triangles is refused for cloth and obstacles") {
    TriangleMesh mesh = two_triangles();
    mesh.triangles.clear();
    CHECK(mentions(refusal(mesh), {"shirt", "no triangles"}));
    CHECK(mentions(refusal(mesh, false), {"shirt", "no triangles"}));
}

TEST_CASE("A vertex that is not finite is named") {
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        for (int axis = 0; axis < 3; ++axis) {
            TriangleMesh mesh = two_triangles();
            mesh.vertices[2][axis] = bad;
            CHECK(mentions(refusal(mesh), {"shirt", "vertex 2", "not finite"}));
            CHECK(mentions(refusal(mesh, false), {"vertex 2"}));
        }
    }
}

TEST_CASE("A vertex index out of range is named with its range") {
    for (const int bad : {-1, 4, 1000000}) {
        TriangleMesh mesh = two_triangles();
        mesh.triangles[1][2] = bad;
        CHECK(mentions(refusal(mesh), {"shirt", "triangle 1", std::to_string(bad), "0 ... 3"}));
        CHECK(mentions(refusal(mesh, false), {"triangle 1"}));
    }
}

TEST_CASE("Repeated triangles are refused for cloth, in any order of their vertices") {
    for (const Triangle& repeated : {Triangle{0, 2, 1}, Triangle{2, 1, 0}, Triangle{1, 2, 0}}) {
        TriangleMesh mesh = two_triangles();
        mesh.triangles.push_back(repeated);
        CHECK(mentions(refusal(mesh), {"shirt", "triangle 2", "repeats triangle 0"}));
        CHECK(refusal(mesh, false) == "");
    }
}

TEST_CASE("Triangles without area are refused for cloth at any scale") {
    for (const double scale : {1e-6, 1.0, 1e6}) {
        TriangleMesh mesh = two_triangles();
        mesh.vertices.push_back({0.5, 0, 0});
        mesh.triangles.push_back({0, 1, 4});
        for (Vec3& x : mesh.vertices) x *= scale;
        CHECK(mentions(refusal(mesh), {"shirt", "triangle 2 (0, 1, 4)", "no area"}));
        CHECK(refusal(mesh, false) == "");
        mesh.vertices[4].z() = -1e-6 * scale;  // a sliver of one to a million is still a triangle
        CHECK(refusal(mesh) == "");
    }
}

TEST_CASE("A triangle that uses a vertex twice has no area") {
    TriangleMesh mesh = two_triangles();
    mesh.triangles.push_back({3, 3, 1});
    CHECK(mentions(refusal(mesh), {"triangle 2", "no area"}));
}

TEST_CASE("An edge of three triangles is refused for cloth") {
    TriangleMesh mesh = two_triangles();
    mesh.vertices.push_back({0.5, 1.0, 0.5});
    mesh.triangles.push_back({2, 1, 4});
    CHECK(mentions(refusal(mesh), {"shirt", "edge (1, 2)", "more than two triangles"}));
    CHECK(refusal(mesh, false) == "");
}

TEST_CASE("A vertex without a triangle is refused for cloth") {
    TriangleMesh mesh = two_triangles();
    mesh.vertices.insert(mesh.vertices.begin() + 4, Vec3(5, 5, 5));
    CHECK(mentions(refusal(mesh), {"shirt", "vertex 4", "no triangle"}));
    CHECK(refusal(mesh, false) == "");
}

TEST_CASE("A grid that lost vertices is refused") {
    TriangleMesh mesh = two_triangles();
    mesh.grid_columns = 3;
    mesh.grid_rows = 2;
    CHECK(mentions(refusal(mesh), {"shirt", "6", "4"}));
}

}  // namespace percale::test::mesh_check_test

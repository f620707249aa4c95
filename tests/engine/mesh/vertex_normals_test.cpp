#include "engine/mesh/vertex_normals.h"

#include <cmath>

#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"

namespace percale::test::vertex_normals_test {
namespace {

std::vector<Vec3> normals_of(const TriangleMesh& mesh, const VertexOrder& order = {}) {
    std::vector<Vec3> normals(mesh.vertices.size(), Vec3(7, 7, 7));
    vertex_normals({.triangles = mesh.triangles, .points = mesh.vertices, .first_vertex = 0, .order = order}, normals);
    return normals;
}

}  // namespace

TEST_CASE("Normals of a flat grid are those of its plane, however it lies") {
    TriangleMesh grid = make_grid(1.0, 0.7, 6, 5);
    const Pose pose{.translation = Vec3(3, -2, 5), .rotation = {0.6, 0.48, 0.64, 0.0}};
    grid.vertices = transform(pose, grid.vertices);
    const Vec3 up = transform({.rotation = pose.rotation}, Vec3(0, 1, 0));
    for (const Vec3& n : normals_of(grid)) CHECK((n - up).norm() < 1e-13);
}

TEST_CASE("Triangles are weighted by their area, not by their number or their angles") {
    // At vertex 0 meet one triangle of area 2 across +z and two of area 1/2 across +x.
    const TriangleMesh mesh{
        .vertices = {Vec3(0, 0, 0), Vec3(2, 0, 0), Vec3(0, 2, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(0, -1, 0)},
        .triangles = {{0, 1, 2}, {0, 3, 4}, {0, 4, 5}}};
    const std::vector<Vec3> normals = normals_of(mesh);
    CHECK((normals[0] - Vec3(1.0, 0.0, 2.0).normalized()).norm() < 1e-15);
    CHECK((normals[1] - Vec3::UnitZ()).norm() < 1e-15);
    CHECK((normals[5] - (mesh.vertices[4].cross(mesh.vertices[5])).normalized()).norm() < 1e-15);
}

TEST_CASE("Normals of a sphere mesh point outwards along its radii, better the finer it is") {
    double before = 1.0;
    for (const int level : {2, 3, 4}) {
        const TriangleMesh ball = make_sphere(0.3, level);
        const std::vector<Vec3> normals = normals_of(ball);
        double worst = 0.0;
        for (std::size_t i = 0; i < normals.size(); ++i) {
            CHECK(normals[i].norm() == Approx(1.0).epsilon(1e-14));
            worst = std::max(worst, (normals[i] - ball.vertices[i].normalized()).norm());
        }
        CHECK(worst < 0.6 * before);
        before = worst;
    }
}

TEST_CASE("A vertex has no normal without triangles, without area, or where areas cancel") {
    // 0 ... 2: a triangle; 3: alone; 4 ... 6: on a line, off the axes; 7 ... 9: the same triangle from both sides.
    const Vec3 along(0.3, 0.7, -0.2);
    TriangleMesh mesh{.vertices = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(5, 5, 5), Vec3(1, 1, 1) + along,
                                   Vec3(1, 1, 1) + 2.0 * along, Vec3(1, 1, 1) + 3.1 * along, Vec3(0.1, 0.2, 0.3),
                                   Vec3(0.4, 0.1, 0.7), Vec3(0.3, 0.9, 0.2)},
                      .triangles = {{0, 1, 2}, {4, 5, 6}, {7, 8, 9}, {8, 7, 9}}};
    const std::vector<Vec3> normals = normals_of(mesh);
    for (const int i : {0, 1, 2}) CHECK(normals[i] == Vec3(0, 0, 1));
    for (const int i : {3, 4, 5, 6, 7, 8, 9}) CHECK(normals[i] == Vec3::Zero());
    for (Vec3& x : mesh.vertices) x *= 1e-6;  // a vertex whose triangles have area keeps its normal, however small
    CHECK((normals_of(mesh)[0] - Vec3(0, 0, 1)).norm() < 1e-15);
}

TEST_CASE("Normals are in the user's order, and only of the requested cloth") {
    TriangleMesh mesh = make_sphere(0.2, 2);
    const std::vector<Vec3> expected = normals_of(mesh);
    const int count = static_cast<int>(mesh.vertices.size());
    VertexOrder order{.place = std::vector<int>(count), .vertex = std::vector<int>(count)};
    for (int i = 0; i < count; ++i) {
        order.place[i] = (i * 5 + 3) % count;
        order.vertex[order.place[i]] = i;
    }
    REQUIRE(count % 5 != 0);
    constexpr int first = 4;
    std::vector<Vec3> points(first + count, Vec3(9, 9, 9)), normals(count);
    for (int i = 0; i < count; ++i) points[first + order.place[i]] = mesh.vertices[i];
    for (Triangle& t : mesh.triangles) {
        for (int& vertex : t) vertex = first + order.place[vertex];
    }
    vertex_normals({.triangles = mesh.triangles, .points = points, .first_vertex = first, .order = order}, normals);
    CHECK(normals == expected);
}

}  // namespace percale::test::vertex_normals_test

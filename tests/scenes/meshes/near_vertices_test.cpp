#include "meshes/near_vertices.h"

#include "meshes/mesh_facts.h"
#include "meshes/mesh_import.h"
#include "percale/error.h"
#include "tests/scenes/message_of.h"
#include "tests/scenes/split_corners.h"
#include "tests/scenes/test_folder.h"
#include "tests/support/catch.h"
#include "tests/support/random.h"

namespace percale::scenes::test::near_vertices_test {
using percale::test::Random;

TEST_CASE("a mesh whose corners differ by rounding is one again after a weld, with its places to that") {
    for (unsigned seed = 0; seed < 20; ++seed) {
        Random random(seed);
        const TriangleMesh ball = make_sphere(random.decades(1e-2, 1e3), 1 + random.index(3));
        const double edge = mesh_facts(ball).shortest_edge, by = edge * random.decades(1e-9, 1e-2);
        const WeldedMesh welded = weld_near(split_corners(ball, by, random), 4.0 * by);
        CAPTURE(seed, edge, by);
        REQUIRE(welded.mesh.vertices.size() == ball.vertices.size());
        CHECK(welded.joined_vertices == static_cast<int>(3 * ball.triangles.size() - ball.vertices.size()));
        CHECK(welded.dropped_triangles == 0);
        CHECK(is_watertight(welded.mesh));
        for (std::size_t t = 0; t < ball.triangles.size(); ++t) {
            for (std::size_t k = 0; k < 3; ++k) {
                const Vec3& was = ball.vertices[static_cast<std::size_t>(ball.triangles[t][k])];
                const Vec3& now = welded.mesh.vertices[static_cast<std::size_t>(welded.mesh.triangles[t][k])];
                CHECK((was - now).norm() < 2.0 * by);
            }
        }
    }
}

TEST_CASE("a weld joins what every pair says: vertices in their order to the first that stays and is as near") {
    Random random(1);
    TriangleMesh cloud;
    for (int k = 0; k < 300; ++k) cloud.vertices.push_back(random.point(0.5));
    for (int k = 0; k + 2 < 300; k += 3) cloud.triangles.push_back({k, k + 1, k + 2});
    const double distance = 0.1;
    std::vector<Vec3> kept;
    for (const Vec3& x : cloud.vertices) {
        bool near = false;
        for (const Vec3& other : kept) near = near || (other - x).norm() <= distance;
        if (!near) kept.push_back(x);
    }
    const WeldedMesh welded = weld_near(cloud, distance);
    CHECK(welded.mesh.vertices == kept);
    CHECK(welded.joined_vertices == static_cast<int>(cloud.vertices.size() - kept.size()));
    CHECK(welded.joined_vertices > 50);
    CHECK(welded.dropped_triangles > 0);
    CHECK(welded.mesh.triangles.size() + static_cast<std::size_t>(welded.dropped_triangles) == cloud.triangles.size());
}

TEST_CASE("vertices that are just as far apart as is said become one wherever they lie") {
    for (const double x : {-0.0005, -0.5, 0.0, 0.25, 1.0}) {
        TriangleMesh two{.vertices = {{x, 0, 0}, {x, 0, 1}, {x, 1, 0}, {x + 0.001, 0, 0}, {x, 1, 1}, {x, 0, 2}},
                         .triangles = {{0, 1, 2}, {3, 4, 5}}};
        const double apart = (two.vertices[3] - two.vertices[0]).norm();
        CAPTURE(x);
        CHECK(weld_near(two, apart).joined_vertices == 1);
    }
}

TEST_CASE("a mesh file is welded in m, which is reported where triangles go, and refused where none is left") {
    const TestFolder folder;
    const std::string file = folder.write("two.obj",
                                          "v 0 0 0\nv 100 0 0\nv 0 0 100\nv 100.01 0 0\nv 100 0 100\nv 0 0 100.01\nv 0 0 0.01\n"
                                          "f 1 2 3\nf 4 5 6\nf 1 2 7\n");
    std::vector<Finding> warnings;
    const TriangleMesh mesh = import_mesh(file, 0.01, &warnings, "", 2e-4);
    CHECK(mesh.vertices.size() == 4);
    CHECK(mesh.triangles == std::vector<Triangle>{{0, 1, 2}, {1, 3, 2}});
    REQUIRE(warnings.size() == 1);
    CHECK(warnings[0].kind == "weld_drops_triangles");
    CHECK(warnings[0].place == file);
    CHECK(finding_text(warnings[0]) == file + ": weld = 0.0002 m leaves out 1 triangle of which two corners become one");
    CHECK(message_of([&] { import_mesh(file, 0.01, nullptr, "", 2.0); }) ==
          file + ": weld = 2 m leaves no triangle: all are smaller");
    CHECK(import_mesh(file, 0.01).vertices.size() == 7);
    import_mesh(file, 0.01, &warnings, "", 1e-6);
    CHECK(warnings.back().kind == "weld_joins_nothing");
    CHECK(finding_text(warnings.back()) == file + ": weld = 1e-06 m joins nothing: no two vertices are so near");
}

}  // namespace percale::scenes::test::near_vertices_test

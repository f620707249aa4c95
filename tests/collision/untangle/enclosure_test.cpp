#include "collision/untangle/enclosure.h"

#include "tests/support/catch.h"
#include "tests/support/collision/shapes.h"

namespace percale::test::enclosure_test {
namespace {

std::vector<Vec3> shifted(std::vector<Vec3> x, const Vec3& by) {
    for (Vec3& point : x) point += by;
    return x;
}

}  // namespace

TEST_CASE("A tube has lost the rod that it surrounds once most of it is outside, not before") {
    const TriangleMesh mesh = make_tube({.height = 2.0});
    const SolidObstacle rod(make_box({0.6, 6.0, 0.6}));
    const Enclosure enclosure(mesh.triangles, mesh.vertices, rod);
    CHECK_FALSE(enclosure.lost(mesh.vertices));
    CHECK_FALSE(enclosure.lost(shifted(mesh.vertices, {0.5, 0.8, 0.0})));
    CHECK(enclosure.lost(shifted(mesh.vertices, {0.0, 1.2, 0.0})));
    CHECK(enclosure.lost(shifted(mesh.vertices, {1.5, 0.0, 0.0})));
}

TEST_CASE("A tube about two legs surrounds them") {
    const TriangleMesh mesh = make_tube({.height = 2.0}), leg = make_box({0.3, 6.0, 0.3});
    const SolidObstacle legs(joined(moved(leg, {0.5, 0, 0}), moved(leg, {-0.5, 0, 0})));
    CHECK(Enclosure(mesh.triangles, mesh.vertices, legs).lost(shifted(mesh.vertices, {3.0, 0.0, 0.0})));
}

TEST_CASE("What does not pass through two rims is not surrounded") {
    const TriangleMesh mesh = make_tube({.height = 2.0}), sheet = make_grid(3.0, 3.0, 8, 8), ball = make_sphere(1.0, 2);
    const SolidObstacle rod(make_box({0.6, 6.0, 0.6})), floor(moved(make_box({9.0, 4.0, 9.0}), {0, -2.3, 0})),
        beside(moved(make_box({0.6, 6.0, 0.6}), {2.0, 0, 0})), around(make_box({9.0, 9.0, 9.0})),
        open(TriangleMesh{.vertices = make_box({0.6, 6.0, 0.6}).vertices, .triangles = {{0, 1, 2}}});
    // A flat ring whose hole and rim both go around the rod.
    TriangleMesh ring = mesh;
    for (Vec3& x : ring.vertices) x = Vec3((2.0 + x.y()) * x.x(), 0.0, (2.0 + x.y()) * x.z());
    const auto loses = [](const TriangleMesh& cloth, const SolidObstacle& obstacle) {
        return Enclosure(cloth.triangles, cloth.vertices, obstacle).lost(shifted(cloth.vertices, {20.0, 0.0, 0.0}));
    };
    CHECK(loses(mesh, rod));
    CHECK_FALSE(loses(mesh, floor));
    CHECK_FALSE(loses(mesh, beside));
    CHECK_FALSE(loses(mesh, around));
    CHECK_FALSE(loses(mesh, open));
    CHECK_FALSE(loses(sheet, rod));
    CHECK_FALSE(loses(ball, rod));
    CHECK_FALSE(loses(ring, rod));
}

}  // namespace percale::test::enclosure_test

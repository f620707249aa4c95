#include "collision/untangle/enclosure.h"

#include <cmath>
#include <numbers>

#include "tests/support/catch.h"
#include "tests/support/collision/shapes.h"
#include "tests/support/random.h"

using namespace percale;
using namespace percale::test;

namespace {

/// An open tube of radius 1 and height 2 about the y axis.
TriangleMesh tube(int around, int rows) {
    TriangleMesh mesh;
    for (int i = 0; i < rows; ++i) {
        for (int k = 0; k < around; ++k) {
            const double angle = 2.0 * std::numbers::pi * k / around;
            mesh.vertices.emplace_back(std::cos(angle), 2.0 * i / (rows - 1) - 1.0, std::sin(angle));
        }
    }
    for (int i = 0; i + 1 < rows; ++i) {
        for (int k = 0; k < around; ++k) {
            const int a = i * around + k, b = i * around + (k + 1) % around;
            mesh.triangles.push_back({a, b, a + around});
            mesh.triangles.push_back({b, b + around, a + around});
        }
    }
    return mesh;
}

std::vector<Vec3> shifted(std::vector<Vec3> x, const Vec3& by) {
    for (Vec3& point : x) point += by;
    return x;
}

}  // namespace

TEST_CASE("A tube has lost what it surrounds once fewer than half of the points are within") {
    const TriangleMesh mesh = tube(24, 7);
    std::vector<Vec3> axis;
    for (int i = 0; i < 40; ++i) axis.emplace_back(0.0, -1.475 + 0.075 * i, 0.0);  // 27 of them within
    const Enclosure enclosure(mesh.triangles, mesh.vertices, axis);
    CHECK_FALSE(enclosure.lost(mesh.vertices));
    CHECK_FALSE(enclosure.lost(shifted(mesh.vertices, {0.5, 0.9, 0.0})));
    CHECK(enclosure.lost(shifted(mesh.vertices, {0.0, 1.1, 0.0})));
    CHECK(enclosure.lost(shifted(mesh.vertices, {1.1, 0.0, 0.0})));
}

TEST_CASE("Neither a sheet, a tube beside the points nor a ball surrounds any, so nothing is lost") {
    Random random(5);
    std::vector<Vec3> points;
    for (int i = 0; i < 100; ++i) points.push_back(random.point(0.2));
    const TriangleMesh sheet = make_grid(1.0, 1.0, 8, 8), beside = moved(tube(24, 7), {2.0, 0.0, 0.0}),
                       ball = make_sphere(1.0, 2);
    for (const TriangleMesh& mesh : {sheet, beside, ball}) {
        const Enclosure enclosure(mesh.triangles, mesh.vertices, points);
        CHECK_FALSE(enclosure.lost(shifted(mesh.vertices, {5.0, 0.0, 0.0})));
    }
}

#include "percale/surface_point.h"

#include <cmath>
#include <limits>

#include "percale/error.h"
#include "percale/percale.h"
#include "tests/support/catch.h"
#include "tests/support/random.h"

namespace percale::test::surface_point_test {

TEST_CASE("Points attached to a surface are where they were, and go along with it as it moves as a whole") {
    const TriangleMesh ball = make_sphere(0.3, 2);
    test::Random random(7);
    std::vector<Vec3> points;
    for (int k = 0; k < 200; ++k) points.push_back(random.point(0.5));
    const std::vector<SurfacePoint> attached = attach(ball, points);
    const Pose pose{.translation = {1.0, -2.0, 0.5}, .rotation = {0.6, 0.0, 0.8, 0.0}};
    const std::vector<Vec3> moved = transform(pose, ball.vertices), expected = transform(pose, points);
    for (std::size_t k = 0; k < points.size(); ++k) {
        CHECK((place_of(attached[k], ball.vertices) - points[k]).norm() < 1e-14);
        CHECK((place_of(attached[k], moved) - expected[k]).norm() < 1e-14);
        CHECK(attached[k].weights[0] + attached[k].weights[1] + attached[k].weights[2] == Approx(1.0));
    }
}

namespace {

/// The distance of a point from a triangle over a net of points on it: at most 0.02 m too large for edges of 0.2 m.
double distance_over_net(const Vec3& point, const Vec3& a, const Vec3& b, const Vec3& c) {
    double nearest = std::numeric_limits<double>::infinity();
    for (int i = 0; i <= 20; ++i) {
        for (int j = 0; i + j <= 20; ++j) nearest = std::min(nearest, (point - (i * a + j * b + (20 - i - j) * c) / 20.0).norm());
    }
    return nearest;
}

}  // namespace

TEST_CASE("The foot of an attached point is the nearest of all triangles") {
    const TriangleMesh ball = make_sphere(0.3, 1);
    test::Random random(11);
    for (int k = 0; k < 50; ++k) {
        const Vec3 point = random.point(0.5);
        double nearest = std::numeric_limits<double>::infinity();
        for (const auto& [a, b, c] : ball.triangles)
            nearest = std::min(nearest, distance_over_net(point, ball.vertices[a], ball.vertices[b], ball.vertices[c]));
        const double distance = attach(ball, std::span(&point, 1))[0].offset.norm();
        CHECK(distance <= nearest + 1e-12);
        CHECK(distance > nearest - 0.02);
    }
}

TEST_CASE("A point above a ball that swells keeps its height above it, and its place among the vertices") {
    const TriangleMesh ball = make_sphere(0.3, 3);
    const auto [a, b, c] = ball.triangles[5];
    const Vec3 foot = (ball.vertices[a] + ball.vertices[b] + ball.vertices[c]) / 3.0;
    const Vec3 normal = (ball.vertices[b] - ball.vertices[a]).cross(ball.vertices[c] - ball.vertices[a]).normalized();
    const Vec3 point = foot + 0.02 * normal;
    const SurfacePoint attached = attach(ball, std::span(&point, 1))[0];
    std::vector<Vec3> swollen = ball.vertices;
    for (Vec3& x : swollen) x *= 1.5;
    CHECK((place_of(attached, swollen) - (1.5 * foot + 0.02 * normal)).norm() < 1e-14);
}

TEST_CASE("A surface without an area, a triangle that loses it and points without a number are refused") {
    TriangleMesh one{.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, .triangles = {{0, 1, 2}}};
    const Vec3 point(0.2, 0.2, 0.1), lost(0.0, std::numeric_limits<double>::quiet_NaN(), 0.0);
    const SurfacePoint attached = attach(one, std::span(&point, 1))[0];
    CHECK_THROWS_AS(attach(one, std::span(&lost, 1)), SceneError);
    one.vertices[2] = {0.5, 0.0, 0.0};
    CHECK_THROWS_AS(place_of(attached, one.vertices), SceneError);
    CHECK_THROWS_AS(attach(one, std::span(&point, 1)), SceneError);
}

}  // namespace percale::test::surface_point_test

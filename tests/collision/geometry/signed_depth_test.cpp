#include "percale/signed_depth.h"

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "collision/certificate/box_tree.h"
#include "collision/certificate/inside_test.h"
#include "tests/support/catch.h"
#include "tests/support/collision/truth.h"
#include "tests/support/random.h"

namespace percale::test::signed_depth_test {
namespace {

/// Distance to a mesh by trying every triangle; negative where it winds around the point.
double mesh_distance(const Vec3& x, const TriangleMesh& mesh) {
    double least = std::numeric_limits<double>::infinity();
    for (const Triangle& t : mesh.triangles) {
        const auto c = corners_of(mesh, t);
        least = std::min(least, true_point_triangle(x, c[0], c[1], c[2]));
    }
    const std::vector<certificate::Corners> corners = certificate::corners_of(mesh);
    const certificate::BoxTree tree{std::span<const certificate::Corners>(corners)};
    return certificate::winding_number(x, corners, tree) != 0 ? -least : least;
}

struct Shape {
    const char* name;
    TriangleMesh mesh;
    std::function<double(const Vec3&)> distance;
    double chord_error;  // m, farthest that a triangle lies below the surface
};

/// What a chord of a circle of the radius leaves, with this many around.
double sagitta(double radius, int segments) { return radius * (1.0 - std::cos(std::numbers::pi / segments)); }

/// Of a mesh about the origin with its vertices on a sphere: how far below the sphere the lowest point of its triangles lies.
double lowest_below(const TriangleMesh& mesh, double radius) {
    double lowest = 0.0;
    for (const Triangle& t : mesh.triangles) {
        const auto c = corners_of(mesh, t);
        lowest = std::max(lowest, radius - std::abs((c[1] - c[0]).cross(c[2] - c[0]).normalized().dot(c[0])));
    }
    return lowest;
}

std::vector<Shape> shapes() {
    const Vec3 size(0.4, 0.7, 0.3);
    const TriangleMesh ball = make_sphere(0.3, 4);
    return {
        {"sphere", ball, [](const Vec3& x) { return sphere_distance(x, 0.3); }, lowest_below(ball, 0.3)},
        {"box", make_box(size), [size](const Vec3& x) { return box_distance(x, size); }, 1e-15},
        {"cylinder", make_cylinder(0.2, 0.6, 48), [](const Vec3& x) { return cylinder_distance(x, 0.2, 0.6); }, sagitta(0.2, 48)},
        {"capsule", make_capsule(0.2, 0.5, 48), [](const Vec3& x) { return capsule_distance(x, 0.2, 0.5); },
         2.0 * sagitta(0.2, 48)}};
}

}  // namespace

TEST_CASE("closed forms agree with the meshes of the generators within their chord error", "[slow]") {
    Random random(11);
    for (const Shape& shape : shapes()) {
        CAPTURE(shape.name);
        double above = 0.0, below = 0.0;
        int inside = 0;
        for (int i = 0; i < 300; ++i) {
            const Vec3 x = random.point(0.5);
            const double closed = shape.distance(x);
            // The mesh lies inside the shape, so it is never nearer from outside.
            const double difference = mesh_distance(x, shape.mesh) - closed;
            above = std::max(above, difference);
            below = std::max(below, -difference);
            inside += closed < 0.0;
        }
        CHECK(inside > 10);
        CHECK(above <= shape.chord_error + 1e-14);
        CHECK(below <= 1e-14);
    }
}

TEST_CASE("a plane's distance is the height over its mesh") {
    Random random(12);
    const TriangleMesh plane = make_plane(10.0);
    for (int i = 0; i < 50; ++i) {
        const Vec3 x = random.point(1.0);
        CHECK(std::abs(plane_distance(x)) == Approx(std::abs(mesh_distance(x, plane))).margin(1e-15));
        CHECK((plane_distance(x) > 0.0) == (x.y() > 0.0));
    }
}

TEST_CASE("signed distances grow by one metre a metre away from the shape") {
    Random random(13);
    constexpr double step = 1e-6;
    for (const Shape& shape : shapes()) {
        CAPTURE(shape.name);
        for (int i = 0; i < 100; ++i) {
            const Vec3 x = random.point(0.5);
            Vec3 slope;
            for (int axis = 0; axis < 3; ++axis) {
                const Vec3 by = step * Vec3::Unit(axis);
                slope[axis] = (shape.distance(x + by) - shape.distance(x - by)) / (2.0 * step);
            }
            CHECK(slope.norm() == Approx(1.0).margin(1e-3));
        }
    }
}

TEST_CASE("depth in the middle") {
    CHECK(sphere_distance(Vec3::Zero(), 0.3) == -0.3);
    CHECK(box_distance(Vec3::Zero(), {0.4, 0.7, 0.3}) == -0.15);
    CHECK(cylinder_distance(Vec3::Zero(), 0.2, 0.3) == -0.15);
    CHECK(capsule_distance(Vec3(0, 0.25, 0), 0.2, 0.5) == -0.2);
    CHECK(capsule_distance(Vec3::Zero(), 0.2, 0.0) == -0.2);
}

}  // namespace percale::test::signed_depth_test

#include "picture/ray_tree.h"

#include <cmath>

#include "tests/scenes/message_of.h"
#include "tests/scenes/picture/png_reader.h"
#include "tests/scenes/picture/shown_shapes.h"

namespace percale::scenes::test::ray_tree_test {
namespace {

/// Distance along a ray to a triangle by Cramer's rule; infinite where it passes by.
double ray_distance(const TriangleMesh& mesh, const Triangle& t, const Vec3& origin, const Vec3& direction) {
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    Eigen::Matrix3d columns;
    columns << b - a, c - a, -direction;
    const Vec3 solved = columns.inverse() * (origin - a);
    const bool hit = solved.x() >= 0 && solved.y() >= 0 && solved.x() + solved.y() <= 1 && solved.z() > 0;
    return hit ? solved.z() : std::numeric_limits<double>::infinity();
}

/// The shape that a ray meets first, -1: none, and how far off.
std::pair<int, double> nearest_shape(const std::vector<ShownShape>& shapes, const Vec3& origin, const Vec3& direction) {
    std::pair<int, double> found{-1, std::numeric_limits<double>::infinity()};
    for (int s = 0; s < static_cast<int>(shapes.size()); ++s) {
        const TriangleMesh& mesh = shapes[static_cast<std::size_t>(s)].mesh;
        for (const Triangle& t : mesh.triangles) {
            const double distance = ray_distance(mesh, t, origin, direction);
            if (distance < found.second) found = {s, distance};
        }
    }
    return found;
}

}  // namespace

TEST_CASE("rays meet what a search of all triangles finds, far from the origin, too") {
    if (!draws()) return;
    const Vec3 far(300.0, -40.0, 1000.0);
    const std::vector<ShownShape> shapes = {shown(moved(make_sphere(0.3, 2), far), true),
                                            shown(moved(make_box(Vec3(0.4, 0.2, 0.3)), far + Vec3(0.3, 0.2, 0)), false)};
    const RayTree tree(shapes);
    int hits = 0, odd = 0;
    for (int k = 0; k < 400; ++k) {
        const Vec3 origin = far + Vec3(2.0, 0.1, -1.5);
        const Vec3 direction = (far + Vec3(0, 0.05 * (k / 20 - 10), 0.05 * (k % 20 - 10)) - origin).normalized();
        const auto [owner, nearest] = nearest_shape(shapes, origin, direction);
        const RayHit hit = tree.first_hit(origin, direction);
        CHECK(tree.blocked(origin, direction, 100.0) == (hit.shape >= 0));
        if (hit.shape != owner) ++odd;
        if (hit.shape != owner || owner < 0) continue;
        ++hits;
        CHECK(hit.distance == Approx(nearest).margin(1e-5));
        CHECK_FALSE(tree.blocked(origin, direction, nearest - 1e-4));
        const TriangleMesh& mesh = shapes[static_cast<std::size_t>(owner)].mesh;
        const Triangle& t = mesh.triangles[static_cast<std::size_t>(hit.triangle)];
        const double u = hit.u, v = hit.v;
        const Vec3 place = (1 - u - v) * mesh.vertices[t[0]] + u * mesh.vertices[t[1]] + v * mesh.vertices[t[2]];
        CHECK((place - origin - hit.distance * direction).norm() < 1e-4);
    }
    CHECK(hits > 50);
    CHECK(odd <= 2);  // rays that touch an outline, in single precision
}

TEST_CASE("nothing is met where there is nothing") {
    if (!draws()) return;
    const RayTree tree({});
    CHECK(tree.first_hit(Vec3::Zero(), Vec3::UnitX()).shape == -1);
    CHECK_FALSE(tree.blocked(Vec3::Zero(), Vec3::UnitX(), 10.0));
}

TEST_CASE("a build without Embree says what it lacks") {
    if (pictures_missing().empty()) return;
    CHECK(percale::scenes::test::message_of([] { RayTree({}); }).find("libembree-dev") != std::string::npos);
}

}  // namespace percale::scenes::test::ray_tree_test

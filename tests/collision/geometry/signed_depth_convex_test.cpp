#include "collision/geometry/signed_depth_convex.h"

#include <algorithm>
#include <limits>

#include "percale/signed_depth.h"
#include "tests/support/catch.h"
#include "tests/support/collision/shapes.h"
#include "tests/support/random.h"

namespace percale::test::signed_depth_convex_test {
namespace {

double reach(std::span<const Vec3> points, const Vec3& way) {
    double most = -std::numeric_limits<double>::infinity();
    for (const Vec3& x : points) most = std::max(most, x.dot(way));
    return most;
}

/// How far the first set has to go to be beyond the second along a direction.
double way_out(std::span<const Vec3> first, std::span<const Vec3> second, const Vec3& way) {
    return reach(second, way) + reach(first, -way);
}

/// Depth of a triangle in a convex mesh: the shortest exit is perpendicular to a face of one or to an edge of each.
double true_depth(std::span<const Vec3> triangle, const TriangleMesh& hull) {
    double least = std::numeric_limits<double>::infinity();
    const auto try_both = [&](const Vec3& way) {
        if (way.norm() < 1e-12) return;
        least = std::min(
            {least, way_out(triangle, hull.vertices, way.normalized()), way_out(triangle, hull.vertices, -way.normalized())});
    };
    try_both((triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]));
    for (const Triangle& t : hull.triangles) {
        const Vec3 &a = hull.vertices[t[0]], &b = hull.vertices[t[1]], &c = hull.vertices[t[2]];
        try_both((b - a).cross(c - a));
        for (const Vec3& edge : {Vec3(b - a), Vec3(c - b), Vec3(a - c)}) {
            for (int k = 0; k < 3; ++k) try_both(edge.cross(triangle[(k + 1) % 3] - triangle[k]));
        }
    }
    return least;
}

TriangleMesh hull(int which, Random& random) {
    TriangleMesh mesh = which == 0 ? make_box({0.4, 0.3, 0.5}) : which == 1 ? make_sphere(0.25, 1) : make_cylinder(0.2, 0.4, 9);
    return placed(std::move(mesh), random.pose(0.1));
}

}  // namespace

TEST_CASE("depths of random points in convex hulls are those of the deepest face plane") {
    Random random(21);
    for (int i = 0; i < 300; ++i) {
        const TriangleMesh mesh = hull(i % 3, random);
        const Vec3 x = random.point(0.3);
        double inner = std::numeric_limits<double>::infinity();
        for (const Triangle& t : mesh.triangles) {
            const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
            inner = std::min(inner, (b - a).cross(c - a).normalized().dot(a - x));
        }
        const auto overlap = hull_overlap(std::span(&x, 1), mesh.vertices);
        if (std::abs(inner) > 1e-6) CHECK(overlap.has_value() == (inner > 0.0));
        if (overlap && inner > 1e-6) CHECK(overlap->depth == Approx(inner).margin(1e-4));
        if (overlap) CHECK(overlap->depth >= inner - 1e-12);
    }
}

TEST_CASE("depths of random triangles in convex hulls agree with brute force") {
    Random random(22);
    int overlapping = 0;
    double worst = 0.0;
    for (int i = 0; i < 300; ++i) {
        const TriangleMesh mesh = hull(i % 3, random);
        std::vector<Vec3> triangle;
        for (int k = 0; k < 3; ++k) triangle.push_back(random.point(0.35));
        const double depth = true_depth(triangle, mesh);
        const auto overlap = hull_overlap(triangle, mesh.vertices);
        if (std::abs(depth) > 1e-6) CHECK(overlap.has_value() == (depth > 0.0));
        if (!overlap || depth <= 1e-6) continue;
        ++overlapping;
        worst = std::max(worst, std::abs(overlap->depth - depth));
        CHECK(way_out(triangle, mesh.vertices, overlap->direction) == Approx(overlap->depth).margin(1e-12));
    }
    CHECK(overlapping > 100);
    CHECK(worst < 1e-4);
}

TEST_CASE("a disc in the middle of a sphere leaves across, not along") {
    const TriangleMesh sphere = make_sphere(0.25, 4);
    std::vector<Vec3> disc;
    for (const Vec3& x : make_grid(0.5, 0.5, 21, 21).vertices) {
        if (x.norm() < 0.25) disc.push_back(x);
    }
    const auto overlap = hull_overlap(disc, sphere.vertices);
    REQUIRE(overlap);
    CHECK(std::abs(overlap->direction.y()) > 0.98);
    CHECK(overlap->depth == Approx(0.25).margin(2e-3));
    CHECK_FALSE(hull_overlap(disc, moved(sphere, {0, 0.3, 0}).vertices));
}

}  // namespace percale::test::signed_depth_convex_test

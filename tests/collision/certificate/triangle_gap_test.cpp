#include "certificate/triangle_gap.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "tests/support/catch.h"

namespace percale::test::triangle_gap_test {
using namespace percale::certificate;

namespace {

class Random {
public:
    double number(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
    Vec3 point() { return {number(-1, 1), number(-1, 1), number(-1, 1)}; }
    Corners triangle() { return {point(), point(), point()}; }

    /// Slivers, needles, points: what a careless mesh holds.
    Corners bad_triangle(int kind) {
        const Vec3 a = point(), b = point();
        if (kind % 3 == 0) return {a, b, a + number(-1, 2) * (b - a)};
        if (kind % 3 == 1) return {a, a, b};
        return {a, a, a};
    }

private:
    std::mt19937 random_{17};
};

Vec3 nearest_on_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
    const double length2 = (b - a).squaredNorm();
    return length2 == 0.0 ? a : Vec3(a + std::clamp((p - a).dot(b - a) / length2, 0.0, 1.0) * (b - a));
}

Vec3 nearest_on_triangle(const Vec3& p, const Corners& t) {
    Vec3 best = nearest_on_segment(p, t[0], t[1]);
    for (int i = 1; i < 3; ++i) {
        const Vec3 candidate = nearest_on_segment(p, t[i], t[(i + 1) % 3]);
        if ((candidate - p).norm() < (best - p).norm()) best = candidate;
    }
    const Eigen::Matrix<double, 3, 2> edges = (Eigen::Matrix<double, 3, 2>() << t[1] - t[0], t[2] - t[0]).finished();
    const Eigen::Vector2d weights = (edges.transpose() * edges).inverse() * (edges.transpose() * (p - t[0]));
    const bool inside = weights.minCoeff() >= 0.0 && weights.sum() <= 1.0;
    return inside ? Vec3(t[0] + edges * weights) : best;
}

/// Alternating projections between two convex sets converge to their distance, from above.
double distance_by_alternation(const Corners& a, const Corners& b) {
    Vec3 on_a = (a[0] + a[1] + a[2]) / 3.0, on_b = b[0];
    for (int i = 0; i < 4000; ++i) {
        on_b = nearest_on_triangle(on_a, b);
        const Vec3 next = nearest_on_triangle(on_b, a);
        if (next == on_a) break;
        on_a = next;
    }
    return (on_a - on_b).norm();
}

Corners moved(const Corners& t, const Vec3& by) { return {t[0] + by, t[1] + by, t[2] + by}; }

double separation(const Corners& a, const Corners& b) {
    return triangle_separation(a, slab_of(a), b, std::numeric_limits<double>::infinity());
}

}  // namespace

TEST_CASE("point-triangle distance is right in each of the seven regions") {
    const Corners t = {Vec3{0, 0, 0}, Vec3{4, 0, 0}, Vec3{0, 4, 0}};
    CHECK(point_triangle_distance({1, 1, 3}, t) == Approx(3));
    CHECK(point_triangle_distance({1, 1, -3}, t) == Approx(3));
    CHECK(point_triangle_distance({2, -3, 4}, t) == Approx(5));
    CHECK(point_triangle_distance({-3, 2, 4}, t) == Approx(5));
    CHECK(point_triangle_distance({4, 4, 0}, t) == Approx(std::sqrt(8.0)));
    CHECK(point_triangle_distance({-2, -2, 1}, t) == Approx(3));
    CHECK(point_triangle_distance({6, -2, 1}, t) == Approx(3));
    CHECK(point_triangle_distance({-2, 6, 1}, t) == Approx(3));
    CHECK(point_triangle_distance({1, 1, 0}, t) == 0.0);
}

TEST_CASE("the distance of random triangles is the limit of alternating projections") {
    Random random;
    int by_faces = 0;
    for (int trial = 0; trial < 400; ++trial) {
        const Corners a = random.triangle(), b = moved(random.triangle(), Vec3{2.2, 0, 0});
        const double expected = distance_by_alternation(a, b), found = triangle_distance(a, b);
        if (std::abs(found - expected) > 1e-6) FAIL("trial " << trial << ": " << found << " against " << expected);
        if (found > expected + 1e-12) FAIL("trial " << trial << " is above the length between two of its points");
        by_faces += found < expected + 1e-12;
    }
    CHECK(by_faces > 200);
}

TEST_CASE("distance is bitwise independent of the order of arguments and corners") {
    Random random;
    for (int trial = 0; trial < 2000; ++trial) {
        const Corners a = trial % 3 ? random.triangle() : random.bad_triangle(trial / 3), b = random.triangle();
        const double expected = triangle_distance(a, b);
        const bool same = triangle_distance(b, a) == expected && triangle_distance({a[1], a[2], a[0]}, b) == expected &&
                          triangle_distance({b[2], b[0], b[1]}, {a[2], a[1], a[0]}) == expected;
        if (!same) FAIL("trial " << trial);
    }
    SUCCEED();
}

TEST_CASE("crossed edges are as far apart as their common perpendicular is long") {
    const double height = GENERATE(1e-9, 1e-3, 0.5);
    const Corners below = {Vec3{-1, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 0, -3}};
    const Corners above = {Vec3{0.2, -1, height}, Vec3{0.2, 1, height}, Vec3{0.2, 0, 3}};
    CHECK(triangle_distance(below, above) == Approx(height).epsilon(1e-12));
    CHECK(separation(below, above) <= height * (1 + 1e-12));
}

TEST_CASE("parallel faces are as far apart as their planes, coplanar ones as their edges") {
    const Corners t = {Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}};
    CHECK(triangle_distance(t, moved(t, {0.1, 0.2, 0.25})) == Approx(0.25));
    CHECK(separation(t, moved(t, {0.1, 0.2, 0.25})) == Approx(0.25));
    CHECK(triangle_distance(t, moved(t, {1.5, 0, 0})) == Approx(0.5));
    CHECK(triangle_distance(t, moved(t, {0, 0, 7})) == Approx(7));
}

TEST_CASE("triangles without area are measured as the segments and points they are") {
    Random random;
    for (int trial = 0; trial < 500; ++trial) {
        const Corners bad = random.bad_triangle(trial);
        const Vec3 p = random.point();
        double expected =
            std::min((p - nearest_on_segment(p, bad[0], bad[1])).norm(), (p - nearest_on_segment(p, bad[1], bad[2])).norm());
        expected = std::min(expected, (p - nearest_on_segment(p, bad[2], bad[0])).norm());
        if (std::abs(point_triangle_distance(p, bad) - expected) > 1e-12) FAIL("trial " << trial);
        if (std::abs(triangle_distance(bad, {p, p, p}) - expected) > 1e-12) FAIL("pair of trial " << trial);
    }
    CHECK(point_segment_distance({3, 4, 0}, Vec3::Zero(), Vec3::Zero()) == 5.0);
}

TEST_CASE("the distance is never below that of the planes for slivers of aspect 1e9") {
    Random random;
    for (int trial = 0; trial < 500; ++trial) {
        const double x = random.number(0, 1), thin = 1e-9 * random.number(0.1, 1);
        const Corners sliver = {Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{x, thin, 0}};
        const Vec3 p{random.number(0.1, 0.9), thin * random.number(-1, 1), random.number(0.001, 1)};
        const double found = point_triangle_distance(p, sliver);
        if (found < p.z() * (1 - 1e-12) || found > p.z() + 3e-9) FAIL("trial " << trial << ": " << found << " over " << p.z());
    }
    SUCCEED();
}

TEST_CASE("the separation never exceeds the distance and equals it for faces that look at each other") {
    Random random;
    int positive = 0;
    for (int trial = 0; trial < 3000; ++trial) {
        const Corners a = trial % 4 ? random.triangle() : random.bad_triangle(trial / 4),
                      b = moved(random.triangle(), {1.0, 0, 0});
        const double bound = separation(a, b);
        positive += bound > 0.0;
        if (bound > triangle_distance(a, b) * (1 + 1e-12)) FAIL("trial " << trial);
    }
    CHECK(positive > 1000);
}

TEST_CASE("a separation above what is enough is still a lower bound") {
    Random random;
    int stopped = 0;
    for (int trial = 0; trial < 2000; ++trial) {
        const Corners a = random.triangle(), b = moved(random.triangle(), {1.5, 0, 0});
        const double bound = triangle_separation(a, slab_of(a), b, 0.1), full = separation(a, b);
        stopped += bound < full;
        if (bound > full || (bound <= 0.1 && bound != full)) FAIL("trial " << trial);
    }
    CHECK(stopped > 100);
}

}  // namespace percale::test::triangle_gap_test

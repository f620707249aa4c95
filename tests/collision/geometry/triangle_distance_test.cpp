#include "collision/geometry/triangle_distance.h"

#include <algorithm>
#include <cmath>

#include "tests/support/catch.h"
#include "tests/support/collision/truth.h"
#include "tests/support/random.h"

namespace percale::test::triangle_distance_test {
namespace {

struct PointCase {
    Vec3 p, a, b, c;
};

PointTriangle closest(const PointCase& x) { return closest_on_triangle(x.p, x.a, x.b, x.c); }
double error(const PointCase& x) {
    return std::abs(std::sqrt(closest(x).distance_squared) - true_point_triangle(x.p, x.a, x.b, x.c));
}

/// Whether weights, region and point agree.
bool consistent(const PointCase& x, const PointTriangle& found) {
    const auto& w = found.weight;
    const int next = (found.corner + 1) % 3, last = (found.corner + 2) % 3;
    const bool convex = *std::min_element(w.begin(), w.end()) >= 0.0 && std::abs(w[0] + w[1] + w[2] - 1.0) <= 1e-15;
    const bool same_point = (w[0] * x.a + w[1] * x.b + w[2] * x.c - found.point).norm() <= 1e-14 * (1.0 + found.point.norm());
    const bool same_distance = found.distance_squared == (x.p - found.point).squaredNorm();
    bool region = true;
    if (found.region == TriangleRegion::vertex) region = w[found.corner] == 1.0 && w[next] == 0.0 && w[last] == 0.0;
    if (found.region == TriangleRegion::edge) region = w[last] == 0.0;
    return convex && same_point && same_distance && region;
}

struct EdgeCase {
    Vec3 p, q, a, b;
};

EdgeEdge closest(const EdgeCase& x) { return closest_on_edges(x.p, x.q, x.a, x.b); }
double error(const EdgeCase& x) { return std::abs(std::sqrt(closest(x).distance_squared) - true_edge_edge(x.p, x.q, x.a, x.b)); }

bool consistent(const EdgeCase& x, const EdgeEdge& found) {
    const bool inside = found.s >= 0.0 && found.s <= 1.0 && found.t >= 0.0 && found.t <= 1.0;
    const double apart = (x.p + found.s * (x.q - x.p) - x.a - found.t * (x.b - x.a)).norm();
    return inside && std::abs(apart - std::sqrt(found.distance_squared)) <= 1e-14 * (1.0 + x.p.norm() + x.a.norm());
}

/// Two edges whose closest points are their middles, `gap` apart, at an angle.
EdgeCase crossing_edges(double angle, double gap, double half_length, Random& random) {
    Rotation turn = random.rotation();
    const Pose pose{.translation = random.point(0.1), .rotation = turn, .scale = 1.0};
    const Vec3 along = half_length * Vec3(std::cos(angle), std::sin(angle), 0.0), up(0.0, 0.0, gap);
    const Vec3 first = half_length * Vec3(1.0, 0.0, 0.0);
    return {transform(pose, Vec3(-first)), transform(pose, first), transform(pose, Vec3(up - along)),
            transform(pose, Vec3(up + along))};
}

}  // namespace

TEST_CASE("the closest point of a random triangle is as far as by trying every case") {
    Random random(1);
    double worst = 0.0;
    int faces = 0, edges = 0, vertices = 0, inconsistent = 0;
    for (int i = 0; i < 30000; ++i) {
        const PointCase x{random.point(2.0), random.point(1.0), random.point(1.0), random.point(1.0)};
        const PointTriangle found = closest(x);
        worst = std::max(worst, error(x));
        inconsistent += consistent(x, found) ? 0 : 1;
        (found.region == TriangleRegion::face ? faces : found.region == TriangleRegion::edge ? edges : vertices) += 1;
    }
    CHECK(worst < 1e-13);
    CHECK(inconsistent == 0);
    CHECK(std::min({faces, edges, vertices}) > 1000);
}

TEST_CASE("no sample of a triangle is closer than its closest point") {
    Random random(2);
    constexpr int steps = 40;
    int closer = 0;
    double worst = 0.0;
    for (int i = 0; i < 300; ++i) {
        const PointCase x{random.point(1.0), random.point(1.0), random.point(1.0), random.point(1.0)};
        const double found = std::sqrt(closest(x).distance_squared);
        double sampled = 1e300;
        for (int u = 0; u <= steps; ++u) {
            for (int v = 0; u + v <= steps; ++v) {
                const Vec3 at = x.a + (x.b - x.a) * u / steps + (x.c - x.a) * v / steps;
                sampled = std::min(sampled, (x.p - at).norm());
            }
        }
        closer += sampled < found - 1e-14 ? 1 : 0;
        worst = std::max(worst, sampled - found);
    }
    CHECK(closer == 0);
    CHECK(worst < 0.06);  // a sample is within the mesh of the samples
}

TEST_CASE("each region of a right triangle is found where it is") {
    const Vec3 a(0, 0, 0), b(1, 0, 0), c(0, 1, 0);
    const auto region = [&](double x, double y) {
        const PointTriangle found = closest_on_triangle({x, y, 0.3}, a, b, c);
        return std::pair(found.region, found.corner);
    };
    using R = TriangleRegion;
    CHECK(region(0.2, 0.2).first == R::face);
    CHECK(region(-1, -1) == std::pair(R::vertex, 0));
    CHECK(region(3, 0) == std::pair(R::vertex, 1));
    CHECK(region(0, 3) == std::pair(R::vertex, 2));
    CHECK(region(0.4, -1) == std::pair(R::edge, 0));
    CHECK(region(1, 1) == std::pair(R::edge, 1));
    CHECK(region(-1, 0.4) == std::pair(R::edge, 2));
    const PointTriangle on_last = closest_on_triangle({-1, 0.25, 0}, a, b, c);
    CHECK(on_last.weight == std::array<double, 3>{0.75, 0.0, 0.25});
    CHECK(on_last.distance_squared == 1.0);
}

TEST_CASE("a point of the triangle itself is at distance 0, corners exactly") {
    Random random(3);
    double worst = 0.0;
    for (int i = 0; i < 3000; ++i) {
        PointCase x{Vec3::Zero(), random.point(1.0), random.point(1.0), random.point(1.0)};
        const double u = random.number(0.0, 1.0), v = random.number(0.0, 1.0 - u);
        for (const Vec3& p :
             {Vec3(x.a + u * (x.b - x.a) + v * (x.c - x.a)), Vec3(x.b + u * (x.c - x.b)), Vec3(x.a + u * (x.c - x.a))}) {
            x.p = p;
            worst = std::max(worst, std::sqrt(closest(x).distance_squared));
        }
        for (const Vec3& corner : {x.a, x.b, x.c}) {
            x.p = corner;
            CHECK(closest(x).distance_squared == 0.0);
        }
    }
    CHECK(worst < 1e-12);
}

TEST_CASE("needles and caps down to a height of 1e-12 of their length keep the distance, above them and beside them") {
    Random random(4);
    double worst = 0.0;
    int inconsistent = 0;
    for (int i = 0; i < 40000; ++i) {
        const double height = random.decades(1e-12, 1e-2), along = random.number(-0.5, 1.5);
        const Vec3 a = random.point(1.0), u = random.unit(), side = u.cross(random.unit()).normalized(), up = u.cross(side);
        const Vec3 off = i % 2 == 0 ? random.unit() : Vec3(up + random.number(0.0, height) * side);
        const PointCase x{a + along * u + random.decades(1e-8, 1.0) * off, a, a + u,
                          a + random.number(-1.0, 2.0) * u + height * side};
        worst = std::max(worst, error(x));
        inconsistent += consistent(x, closest(x)) ? 0 : 1;
    }
    CHECK(inconsistent == 0);
    CHECK(worst < 1e-8);
}

TEST_CASE("a triangle squeezed to a segment or a point is one") {
    Random random(5);
    double worst = 0.0;
    int inconsistent = 0;
    for (int i = 0; i < 20000; ++i) {
        const Vec3 a = random.point(1.0), b = i % 3 == 0 ? a : random.point(1.0);
        const Vec3 c = i % 3 == 1 ? Vec3(a + random.number(-1.0, 2.0) * (b - a)) : i % 2 == 0 ? a : b;
        const PointCase x{random.point(1.5), a, b, c};
        worst = std::max(worst, error(x));
        inconsistent += consistent(x, closest(x)) ? 0 : 1;
    }
    CHECK(inconsistent == 0);
    CHECK(worst < 1e-9);
}

TEST_CASE("a triangle two corners of which are one is a segment, straight above its end, too") {
    Random random(6);
    double worst = 0.0;
    int inconsistent = 0;
    for (int i = 0; i < 3000; ++i) {
        const Vec3 twice = random.point(1.0), once = i % 2 == 0 ? random.point(1.0) : twice + Vec3(0.0, 1e-17, 0.0);
        std::array<Vec3, 3> corner = {twice, twice, twice};
        corner[static_cast<std::size_t>(i % 3)] = once;
        const Vec3 p = i % 5 == 0 ? Vec3(0.5 * (twice + once)) : i % 7 == 0 ? twice : random.point(1.5);
        const PointCase x{p, corner[0], corner[1], corner[2]};
        worst = std::max(worst, error(x));
        inconsistent += consistent(x, closest(x)) ? 0 : 1;
    }
    CHECK(inconsistent == 0);
    CHECK(worst < 1e-9);
}

TEST_CASE("closest points of random segments are as far as by trying every case") {
    Random random(6);
    double worst = 0.0;
    int inside = 0, ends = 0, inconsistent = 0;
    for (int i = 0; i < 40000; ++i) {
        const EdgeCase x{random.point(1.0), random.point(1.0), random.point(1.0), random.point(1.0)};
        const EdgeEdge found = closest(x);
        worst = std::max(worst, error(x));
        inconsistent += consistent(x, found) ? 0 : 1;
        const bool both_inside = found.s > 0.0 && found.s < 1.0 && found.t > 0.0 && found.t < 1.0;
        (both_inside ? inside : ends) += 1;
    }
    CHECK(worst < 1e-13);
    CHECK(inconsistent == 0);
    CHECK(std::min(inside, ends) > 5000);
}

TEST_CASE("no pair of samples of two segments is closer than their closest points") {
    Random random(7);
    int closer = 0;
    for (int i = 0; i < 300; ++i) {
        const EdgeCase x{random.point(1.0), random.point(1.0), random.point(1.0), random.point(1.0)};
        const double found = std::sqrt(closest(x).distance_squared);
        for (int s = 0; s <= 40; ++s) {
            for (int t = 0; t <= 40; ++t) {
                closer += (x.p + (x.q - x.p) * s / 40 - x.a - (x.b - x.a) * t / 40).norm() < found - 1e-14 ? 1 : 0;
            }
        }
    }
    CHECK(closer == 0);
}

TEST_CASE("parallel segments: side by side, in line, apart along their line, either way round") {
    Random random(8);
    double worst = 0.0;
    int inconsistent = 0;
    for (int i = 0; i < 20000; ++i) {
        const Vec3 p = random.point(1.0), u = random.point(1.0);
        const Vec3 shift = i % 3 == 0 ? Vec3(Vec3::Zero()) : Vec3(random.decades(1e-6, 1.0) * random.unit());
        const double first = random.number(-2.0, 2.0), second = random.number(-2.0, 2.0);
        const EdgeCase x{p, p + u, p + shift + first * u, p + shift + second * u};
        worst = std::max(worst, error(x));
        inconsistent += consistent(x, closest(x)) ? 0 : 1;
    }
    CHECK(worst < 1e-13);
    CHECK(inconsistent == 0);
}

TEST_CASE("segments that cross or share an end are at distance 0") {
    Random random(9);
    double worst = 0.0;
    for (int i = 0; i < 5000; ++i) {
        const Vec3 meet = random.point(1.0), u = random.unit(), v = random.unit();
        const double s = random.number(0.0, 1.0), t = random.number(0.0, 1.0);
        worst = std::max(
            worst,
            std::sqrt(closest(EdgeCase{meet - s * u, meet + (1 - s) * u, meet - t * v, meet + (1 - t) * v}).distance_squared));
        CHECK(closest(EdgeCase{meet, u, v, meet}).distance_squared == 0.0);
    }
    CHECK(worst < 1e-12);
}

TEST_CASE("point-like segments are points") {
    Random random(10);
    double worst = 0.0;
    for (int i = 0; i < 5000; ++i) {
        const Vec3 p = random.point(1.0), a = random.point(1.0), b = random.point(1.0);
        for (const EdgeCase& x : {EdgeCase{p, p, a, b}, EdgeCase{a, b, p, p}, EdgeCase{p, p, a, a}}) {
            worst = std::max(worst, error(x));
            CHECK(consistent(x, closest(x)));
        }
    }
    CHECK(worst < 1e-13);
}

TEST_CASE("segments that cross above each other at any angle keep the digits of their gap") {
    Random random(11);
    double worst = 0.0, worst_digits = 0.0;
    for (int i = 0; i < 40000; ++i) {
        const double angle = random.decades(1e-9, 1.5), gap = random.decades(1e-9, 1e-1);
        const EdgeCase x = crossing_edges(angle, gap, random.decades(1e-3, 1.0), random);
        worst = std::max(worst, error(x));
        if (angle > 1e-3) worst_digits = std::max(worst_digits, error(x) / gap);
    }
    CHECK(worst < 1e-12);
    CHECK(worst_digits < 1e-5);
}

}  // namespace percale::test::triangle_distance_test

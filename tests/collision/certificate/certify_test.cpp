#include "percale/certify.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <random>

#include "certificate/triangle_gap.h"
#include "certificate/triangle_overlap.h"
#include "percale/error.h"
#include "tests/support/catch.h"

namespace percale::test::certificate_certify_test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

TriangleMesh moved(TriangleMesh mesh, const Vec3& by) {
    for (Vec3& x : mesh.vertices) x += by;
    return mesh;
}

certificate::Corners corners(const TriangleMesh& mesh, int i) {
    const Triangle& t = mesh.triangles[i];
    return {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
}

struct BruteForce {
    std::vector<IntersectingPair> pairs;
    int touching = 0;
    double distance = infinity;
};

BruteForce all_pairs(const TriangleMesh& cloth, const TriangleMesh& obstacle) {
    BruteForce result;
    for (int i = 0; i < int(cloth.triangles.size()); ++i) {
        for (int j = 0; j < int(obstacle.triangles.size()); ++j) {
            const auto a = corners(cloth, i), b = corners(obstacle, j);
            const auto overlap = certificate::classify(a, b);
            if (overlap == certificate::Overlap::crossing) result.pairs.push_back({i, j});
            result.touching += overlap == certificate::Overlap::touching;
            result.distance =
                overlap == certificate::Overlap::disjoint ? std::min(result.distance, certificate::triangle_distance(a, b)) : 0.0;
        }
    }
    if (!result.pairs.empty() || result.touching > 0) result.distance = 0.0;
    return result;
}

/// Below the plane of every face.
bool inside_convex(const Vec3& x, const TriangleMesh& body) {
    for (int j = 0; j < int(body.triangles.size()); ++j) {
        const auto t = corners(body, j);
        if ((t[1] - t[0]).cross(t[2] - t[0]).dot(x - t[0]) >= 0.0) return false;
    }
    return true;
}

bool same(const std::vector<IntersectingPair>& a, const std::vector<IntersectingPair>& b) {
    const auto equal = [](const IntersectingPair& x, const IntersectingPair& y) {
        return x.first == y.first && x.second == y.second;
    };
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), equal);
}

bool share_a_vertex(const Triangle& a, const Triangle& b) {
    return std::any_of(a.begin(), a.end(), [&](int v) { return v == b[0] || v == b[1] || v == b[2]; });
}

TriangleMesh crumpled(double size, int count, double amplitude, unsigned seed) {
    TriangleMesh sheet = make_grid(size, size, count, count);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> number(-amplitude, amplitude);
    for (Vec3& x : sheet.vertices) x += Vec3{number(random), number(random), number(random)};
    return sheet;
}

}  // namespace

TEST_CASE("a sheet through a ball: pairs, depth and count of inside vertices are those of geometry") {
    const double height = GENERATE(0.0, 0.1234, -0.2);
    const TriangleMesh ball = make_sphere(0.3, 2);
    const TriangleMesh sheet = moved(make_grid(1.0, 1.0, 13, 13), {0.003, height, 0.001});
    const Certificate found = certify(sheet, ball);
    const BruteForce expected = all_pairs(sheet, ball);
    CHECK(found.watertight);
    CHECK_FALSE(found.clean());
    CHECK(found.pairs.size() > 20);
    CHECK(same(found.pairs, expected.pairs));
    CHECK(found.touching_pairs == expected.touching);
    CHECK(found.smallest_distance == 0.0);

    int inside = 0;
    double deepest = 0.0;
    for (const Vec3& x : sheet.vertices) {
        if (!inside_convex(x, ball)) continue;
        double depth = infinity;
        for (int j = 0; j < int(ball.triangles.size()); ++j) {
            depth = std::min(depth, certificate::point_triangle_distance(x, corners(ball, j)));
        }
        deepest = std::max(deepest, depth);
        ++inside;
    }
    CHECK(inside > 15);
    CHECK(found.vertices_inside == inside);
    CHECK(found.deepest_penetration == deepest);
    REQUIRE(found.deepest_vertex >= 0);
    const double from_centre = sheet.vertices[found.deepest_vertex].norm();
    CHECK(found.deepest_penetration == Approx(0.3 - from_centre).margin(0.014));
}

TEST_CASE("a sheet above a ball is clean and as far from it as by brute force, for any limit") {
    const TriangleMesh ball = make_sphere(0.3, 2);
    const TriangleMesh sheet = moved(crumpled(1.0, 13, 0.01, 5), {0, 0.33, 0});
    const BruteForce expected = all_pairs(sheet, ball);
    REQUIRE(expected.pairs.empty());
    const Certificate found = certify(sheet, ball);
    CHECK(found.clean());
    CHECK(found.touching_pairs == 0);
    CHECK(found.vertices_inside == 0);
    CHECK(found.deepest_vertex == -1);
    CHECK(found.deepest_penetration == 0.0);
    CHECK(found.smallest_distance == expected.distance);
    CHECK(certify(ball, sheet).smallest_distance == expected.distance);
    CHECK(certify(sheet, ball, expected.distance).smallest_distance == expected.distance);
    CHECK(certify(sheet, ball, 0.999 * expected.distance).smallest_distance == infinity);
    CHECK(certify(sheet, ball, 0.0).smallest_distance == infinity);
}

TEST_CASE("crumpled sheets against a ball give the pairs of brute force, in either order") {
    const unsigned seed = GENERATE(1u, 2u, 3u, 4u);
    const TriangleMesh ball = make_sphere(0.3, 2);
    const TriangleMesh sheet = moved(crumpled(0.7, 9, 0.03, seed), {0, 0.05 * seed, 0});
    const Certificate found = certify(sheet, ball);
    CHECK(same(found.pairs, all_pairs(sheet, ball).pairs));
    CHECK_FALSE(found.pairs.empty());
    const Certificate swapped = certify(ball, sheet);
    CHECK_FALSE(swapped.watertight);
    CHECK(swapped.vertices_inside == 0);
    CHECK(swapped.pairs.size() == found.pairs.size());
    CHECK(swapped.touching_pairs == found.touching_pairs);
    CHECK(same(swapped.pairs, all_pairs(ball, sheet).pairs));
}

TEST_CASE("a certificate that is cancelled is none") {
    const TriangleMesh ball = make_sphere(0.5, 2), sheet = moved(make_grid(1.0, 1.0, 9, 9), {0.0, 0.1, 0.0});
    std::atomic<bool> cancel = false;
    CHECK(certify(sheet, ball, infinity, &cancel).pairs.size() == certify(sheet, ball).pairs.size());
    CHECK(certify_cloth(sheet, {}, {}, &cancel).crossing.empty());
    cancel = true;
    CHECK_THROWS_AS(certify(sheet, ball, infinity, &cancel), CertificateCancelled);
    CHECK_THROWS_AS(certify(sheet, moved(ball, {0.0, 3.0, 0.0}), infinity, &cancel), CertificateCancelled);
    CHECK_THROWS_AS(certify_cloth(sheet, {}, {}, &cancel), CertificateCancelled);
}

TEST_CASE("cloth wholly inside a ball crosses nothing and is still not clean") {
    const TriangleMesh sheet = make_grid(0.2, 0.2, 9, 9);
    const Certificate found = certify(sheet, make_sphere(0.3, 3));
    CHECK(found.pairs.empty());
    CHECK(found.vertices_inside == 81);
    CHECK_FALSE(found.clean());
    CHECK(found.deepest_vertex == 40);  // the centre
    CHECK(found.deepest_penetration == Approx(0.3).epsilon(0.01));
    CHECK(found.smallest_distance == Approx(0.3 - 0.1 * std::sqrt(2.0)).epsilon(0.05));
}

TEST_CASE("cloth that lies on a box touches it: no pair, no depth, distance 0") {
    const TriangleMesh box = make_box({1, 1, 1});
    const TriangleMesh corner_down = {{{0.1, 0.5, 0.2}, {0.2, 0.9, 0.2}, {0.1, 0.9, 0.3}}, {{0, 1, 2}}};
    const Certificate found = certify(corner_down, box);
    CHECK(found.pairs.empty());
    CHECK(found.touching_pairs >= 1);
    CHECK(found.vertices_inside == 0);
    CHECK(found.smallest_distance == 0.0);
    CHECK(found.clean());

    const Certificate sunk = certify(moved(corner_down, {0, -1e-15, 0}), box);
    CHECK(sunk.pairs.size() >= 1);
    CHECK(sunk.vertices_inside == 1);
    CHECK(sunk.deepest_vertex == 0);
    CHECK(sunk.deepest_penetration == Approx(1e-15).epsilon(0.2));

    const Certificate raised = certify(moved(corner_down, {0, 1e-15, 0}), box);
    CHECK(raised.clean());
    CHECK(raised.touching_pairs == 0);
    CHECK(raised.smallest_distance == Approx(1e-15).epsilon(0.2));
}

TEST_CASE("each piece of a cloth cut by the surface is put on its own side") {
    const TriangleMesh box = make_box({1, 1, 1});
    // A strip that goes through the box from left to right: its ends are outside, its middle inside.
    const TriangleMesh strip = moved(make_grid(3.0, 0.2, 31, 3), {0.013, 0.1, 0});
    const Certificate found = certify(strip, box);
    int inside = 0;
    for (const Vec3& x : strip.vertices) inside += std::abs(x.x()) < 0.5;
    CHECK(found.vertices_inside == inside);
    CHECK(found.deepest_penetration == Approx(0.4));
}

TEST_CASE("an open obstacle has no inside but its pairs count") {
    TriangleMesh bowl = make_sphere(0.3, 2);
    bowl.triangles.resize(bowl.triangles.size() - 5);
    const TriangleMesh sheet = moved(make_grid(1.0, 1.0, 11, 11), {0.01, 0.02, 0.01});
    const Certificate found = certify(sheet, bowl);
    CHECK_FALSE(found.watertight);
    CHECK(found.vertices_inside == 0);
    CHECK(found.deepest_penetration == 0.0);
    CHECK_FALSE(found.pairs.empty());
    CHECK(same(found.pairs, all_pairs(sheet, bowl).pairs));
}

TEST_CASE("triangles without area in the obstacle change nothing that is found") {
    TriangleMesh ball = make_sphere(0.3, 2);
    const TriangleMesh sheet = moved(make_grid(0.6, 0.6, 11, 11), {0.01, 0.12, 0.013});
    const Certificate plain = certify(sheet, ball);
    ball.triangles.push_back({0, 0, 1});
    ball.triangles.push_back({2, 2, 2});
    const Certificate found = certify(sheet, ball);
    CHECK(same(found.pairs, plain.pairs));
    CHECK(found.watertight);
    CHECK(found.vertices_inside == plain.vertices_inside);
    CHECK(found.deepest_penetration == plain.deepest_penetration);
}

TEST_CASE("errors of the input are reported by name") {
    const TriangleMesh ball = make_sphere(0.3, 1), sheet = make_grid(1, 1, 3, 3);
    TriangleMesh broken = ball;
    broken.vertices[7].y() = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_AS(certify(sheet, broken), SceneError);
    CHECK_THROWS_WITH(certify(broken, ball), Catch::Contains("cloth") && Catch::Contains("7"));
    broken.vertices[7].y() = 1e80;
    CHECK_THROWS_WITH(certify(sheet, broken), Catch::Contains("obstacle") && Catch::Contains("vertex 7"));
    broken = ball;
    broken.triangles[3][1] = 4242;
    CHECK_THROWS_WITH(self_intersections(broken), Catch::Contains("4242"));
    CHECK_THROWS_WITH(certify(sheet, ball, -1.0), Catch::Contains("distance_limit"));
    CHECK_THROWS_AS(certify(sheet, ball, std::numeric_limits<double>::quiet_NaN()), SceneError);
}

TEST_CASE("a mesh that does not meet itself has no self-intersections though neighbours share vertices") {
    CHECK(self_intersections(make_sphere(1.0, 3)).empty());
    CHECK(self_intersections(make_grid(1, 1, 12, 9)).empty());
    CHECK(self_intersections(make_box({1, 1, 1})).empty());
}

TEST_CASE("self-intersections of a crumpled sheet are those of all pairs without a common vertex") {
    const TriangleMesh sheet = crumpled(1.0, 15, 0.08, 9);
    std::vector<IntersectingPair> expected;
    for (int i = 0; i < int(sheet.triangles.size()); ++i) {
        for (int j = i + 1; j < int(sheet.triangles.size()); ++j) {
            const bool crossing = certificate::classify(corners(sheet, i), corners(sheet, j)) == certificate::Overlap::crossing;
            if (crossing && !share_a_vertex(sheet.triangles[i], sheet.triangles[j])) expected.push_back({i, j});
        }
    }
    CHECK(expected.size() > 20);
    CHECK(same(self_intersections(sheet), expected));
}

TEST_CASE("cloth that lies beside, above or along itself has no crossings") {
    for (const TriangleMesh& mesh : {make_sphere(1.0, 3), make_grid(1, 1, 12, 9), make_box({1, 1, 1})}) {
        const ClothCertificate found = certify_cloth(mesh);
        CHECK(found.crossing.empty());
        CHECK(found.touching.empty());
    }
}

TEST_CASE("crossings of a crumpled sheet are those of all pairs, neighbours at one vertex included") {
    const TriangleMesh sheet = crumpled(1.0, 15, 0.08, 9);
    std::vector<IntersectingPair> expected;
    int neighbours = 0;
    for (int i = 0; i < int(sheet.triangles.size()); ++i) {
        for (int j = i + 1; j < int(sheet.triangles.size()); ++j) {
            if (certificate::classify(corners(sheet, i), corners(sheet, j)) != certificate::Overlap::crossing) continue;
            expected.push_back({i, j});
            neighbours += share_a_vertex(sheet.triangles[i], sheet.triangles[j]);
        }
    }
    CHECK(neighbours > 5);
    CHECK(same(certify_cloth(sheet).crossing, expected));
}

TEST_CASE("a search for crossings finds all of them, or as many as were requested, and reports which") {
    const TriangleMesh sheet = crumpled(1.0, 15, 0.08, 9);
    const std::vector<IntersectingPair> all = certify_cloth(sheet).crossing;
    const CrossingSearch whole = find_crossings(sheet, 100000, 1000000);
    CHECK(whole.complete);
    CHECK(same(whole.pairs, all));
    const CrossingSearch exact = find_crossings(sheet, static_cast<long>(all.size()) + 1, 1000000);
    CHECK(exact.complete);
    const CrossingSearch few = find_crossings(sheet, 3, 1000000);
    CHECK_FALSE(few.complete);
    REQUIRE(few.pairs.size() == 3);
    for (const IntersectingPair& pair : few.pairs)
        CHECK(std::count_if(all.begin(), all.end(), [&](const IntersectingPair& one) {
                  return one.first == pair.first && one.second == pair.second;
              }) == 1);
    CHECK_FALSE(find_crossings(sheet, 100000, 10).complete);
}

TEST_CASE("a fan of many triangles around one vertex is searched no longer than allowed") {
    TriangleMesh fan{.vertices = {{0, 0, 0}}, .triangles = {}};
    constexpr int count = 20000;
    for (int i = 0; i < count; ++i) {
        const double angle = 2.0 * 3.14159265358979 * i / count;
        fan.vertices.push_back({std::cos(angle), 0.1, std::sin(angle)});
        fan.triangles.push_back({0, i + 1, i + 2 > count ? 1 : i + 2});
    }
    const CrossingSearch search = find_crossings(fan, 10, 100000);
    CHECK_FALSE(search.complete);
    CHECK(search.pairs.empty());
}

TEST_CASE(
    "a triangle pushed through its neighbour at a vertex crosses it, one folded against its neighbour at an edge does not") {
    // Two triangles that share vertex 0 alone.
    TriangleMesh wings{.vertices = {{0, 0, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 0, -1}, {-1, 0, 1}},
                       .triangles = {{0, 1, 2}, {0, 3, 4}}};
    CHECK(certify_cloth(wings).crossing.empty());
    wings.vertices[3] = {1, 0, -1};
    wings.vertices[4] = {1, 0, 1};
    CHECK(certify_cloth(wings).crossing.size() == 1);
    TriangleMesh fold{.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {0, 1e-9, 0.9}}, .triangles = {{0, 1, 2}, {0, 3, 1}}};
    CHECK(certify_cloth(fold).crossing.empty());
    fold.vertices[3].y() = 0.0;  // exactly onto each other
    CHECK(certify_cloth(fold).crossing.size() == 1);
}

TEST_CASE("Distances of points to a surface are the smallest to its triangles, below 0 inside a closed one") {
    TriangleMesh ball = make_sphere(0.3, 2);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> place(-0.6, 0.6);
    std::vector<Vec3> points;
    for (int n = 0; n < 200; ++n) points.emplace_back(place(random), place(random), place(random));
    const auto nearest = [&](const TriangleMesh& mesh, const Vec3& x) {
        double distance = infinity;
        for (int i = 0; i < int(mesh.triangles.size()); ++i)
            distance = std::min(distance, certificate::point_triangle_distance(x, corners(mesh, i)));
        return distance;
    };
    const std::vector<double> closed = surface_distances(ball, points);
    int inside = 0;
    for (std::size_t n = 0; n < points.size(); ++n) {
        CHECK(std::abs(closed[n]) == nearest(ball, points[n]));
        if (std::abs(points[n].norm() - 0.3) < 0.02) continue;
        CHECK((closed[n] < 0.0) == (points[n].norm() < 0.3));
        inside += closed[n] < 0.0;
    }
    CHECK(inside > 5);
    ball.triangles.pop_back();
    for (const double distance : surface_distances(ball, points)) CHECK(distance >= 0.0);
    CHECK_THROWS_AS(surface_distances(ball, std::vector<Vec3>{Vec3(0, infinity, 0)}), SceneError);
}

TEST_CASE("cloth that only touches itself away from its neighbours is distinguished from cloth that crosses itself") {
    TriangleMesh mesh = make_grid(1, 1, 3, 3);
    const TriangleMesh upper = moved(make_grid(1, 1, 3, 3), {0.01, 0.1, 0.02});
    for (const Triangle& t : upper.triangles) mesh.triangles.push_back({t[0] + 9, t[1] + 9, t[2] + 9});
    mesh.vertices.insert(mesh.vertices.end(), upper.vertices.begin(), upper.vertices.end());
    CHECK(certify_cloth(mesh).touching.empty());
    mesh.vertices[9 + 4].y() = 0.0;
    const ClothCertificate touching = certify_cloth(mesh);
    CHECK(touching.crossing.empty());
    REQUIRE_FALSE(touching.touching.empty());
    CHECK(touching.touching[0].first < 8);
    CHECK(touching.touching[0].second >= 8);
    mesh.vertices[9 + 4].y() = -0.01;
    CHECK_FALSE(certify_cloth(mesh).crossing.empty());
    mesh.triangles[0][1] = 4242;
    CHECK_THROWS_WITH(certify_cloth(mesh), Catch::Contains("4242"));
}

}  // namespace percale::test::certificate_certify_test

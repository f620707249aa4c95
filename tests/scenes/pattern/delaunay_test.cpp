#include "scenes/pattern/delaunay.h"

#include <map>

#include "percale/error.h"
#include "tests/scenes/pattern/garments.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::delaunay_test {
namespace {

/// Opposite corners of every inner side.
std::map<std::array<int, 2>, std::vector<int>> sides_of(const std::vector<Triangle>& triangles) {
    std::map<std::array<int, 2>, std::vector<int>> sides;
    for (const Triangle& t : triangles) {
        for (int k = 0; k < 3; ++k) {
            const int a = t[k], b = t[(k + 1) % 3];
            sides[{std::min(a, b), std::max(a, b)}].push_back(t[(k + 2) % 3]);
        }
    }
    return sides;
}

/// The angle at c over the side from a to b.
double angle_over(const Point2& a, const Point2& b, const Point2& c) {
    return std::atan2(std::abs(turn_left(c, a, b)), (a - c).dot(b - c));
}

}  // namespace

TEST_CASE("inner sides see their two opposite corners under no more than 180 degrees, which is Delaunay's law") {
    Random random(3);
    for (int round = 0; round < 30; ++round) {
        const std::vector<Point2> outline = bumpy_outline(random, 0.3, 0.03);
        Delaunay triangulation(outline);
        for (int k = 0; k < 100; ++k) {
            triangulation.insert({random.number(-0.3, 0.3), random.number(-0.4, 0.4)});
        }
        if (round % 2 == 0) triangulation.smooth();
        const auto& x = triangulation.points();
        int inner = 0, outer = 0;
        const auto triangles = triangulation.triangles();
        for (const auto& [ends, opposite] : sides_of(triangles)) {
            outer += opposite.size() == 1 ? 1 : 0;
            if (opposite.size() != 2) continue;
            ++inner;
            const Point2 &a = x[ends[0]], &b = x[ends[1]];
            CHECK(angle_over(a, b, x[opposite[0]]) + angle_over(a, b, x[opposite[1]]) < std::numbers::pi + 1e-7);
        }
        CHECK(outer == static_cast<int>(outline.size()));
        CHECK(static_cast<int>(x.size()) - inner - outer + static_cast<int>(triangles.size()) == 1);
    }
}

TEST_CASE("points outside, on a side or on a corner are not taken") {
    Delaunay square(std::vector<Point2>{{0, 0}, {1, 0}, {1, 1}, {0, 1}});
    CHECK_FALSE(square.insert({1.5, 0.5}));
    CHECK_FALSE(square.insert({0.5, 0.0}));
    CHECK_FALSE(square.insert({1.0, 1.0}));
    CHECK(square.insert({0.4, 0.3}));
    CHECK_FALSE(square.insert({0.4, 0.3}));
    CHECK(square.triangles().size() == 4);
}

TEST_CASE("polygons with many points on one line are triangulated without flat triangles, crossing ones are refused") {
    const std::vector<Point2> comb = divided({{0, 0}, {9, 0}, {9, 4}, {6, 4}, {6, 1}, {3, 1}, {3, 4}, {0, 4}}, 0.5);
    const Delaunay triangulation(comb);
    double twice = 0.0;
    for (const auto& [a, b, c] : triangulation.triangles()) {
        const double turn = turn_left(comb[a], comb[b], comb[c]);
        CHECK(turn > 1e-9);
        twice += turn;
    }
    CHECK(0.5 * twice == Approx(area_of(comb)).epsilon(1e-13));
    CHECK_THROWS_AS(Delaunay(std::vector<Point2>{{0, 0}, {1, 1}, {1, 0}, {0, 1}}), SceneError);
    CHECK_THROWS_AS(Delaunay(std::vector<Point2>{{0, 0}, {1, 1}}), SceneError);
}

}  // namespace percale::scenes::test::delaunay_test

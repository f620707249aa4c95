#include "scenes/pattern/pattern_parts.h"

#include "tests/scenes/pattern/garments.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::pattern_parts_test {

TEST_CASE("turns go about x first, then y, then z") {
    const auto turn = [](double x, double y, double z, const Vec3& point) {
        return transform({.rotation = turned({x, y, z})}, point);
    };
    CHECK((turn(90, 0, 0, {0, 1, 0}) - Vec3(0, 0, 1)).norm() < 1e-15);
    CHECK((turn(0, 90, 0, {0, 0, 1}) - Vec3(1, 0, 0)).norm() < 1e-15);
    CHECK((turn(0, 0, 90, {1, 0, 0}) - Vec3(0, 1, 0)).norm() < 1e-15);
    CHECK((turn(90, 90, 0, {0, 1, 0}) - Vec3(1, 0, 0)).norm() < 1e-15);
    CHECK((turn(90, 0, 90, {0, 1, 0}) - Vec3(0, 0, 1)).norm() < 1e-15);
}

TEST_CASE("a bulge lies to the right of the way along an edge") {
    CHECK((arc_middle({0, 0}, {2, 0}, 0.5) - Point2(1, -0.5)).norm() < 1e-15);
    CHECK((arc_middle({2, 0}, {0, 0}, 0.5) - Point2(1, 0.5)).norm() < 1e-15);
}

TEST_CASE("a wrapped panel keeps its lengths around and along its cylinder") {
    Panel panel;
    panel.wrap = 0.2;
    const double quarter = 0.5 * std::numbers::pi * 0.2;
    CHECK(placed_point(panel, {0, 0.3}) == Vec3(0, 0.3, 0));
    CHECK((placed_point(panel, {quarter, 0.3}) - Vec3(0.2, 0.3, -0.2)).norm() < 1e-15);
    CHECK((placed_point(panel, {-quarter, 0.1}) - Vec3(-0.2, 0.1, -0.2)).norm() < 1e-15);
}

TEST_CASE("every point of a mirrored panel lies in the mirror of its own") {
    Random random(5);
    for (int n = 0; n < 20; ++n) {
        Panel panel;
        panel.pose = {.translation = random.point(1.0),
                      .rotation = turned({random.number(-180, 180), random.number(-90, 90), 30.0})};
        panel.wrap = n % 2 == 0 ? 0.0 : 0.3;
        const Panel image = mirrored(panel, "image");
        const Point2 point(random.number(-0.2, 0.2), random.number(-0.2, 0.2));
        const Vec3 x = placed_point(panel, point), there = placed_point(image, {-point.x(), point.y()});
        CHECK((there - Vec3(-x.x(), x.y(), x.z())).norm() < 1e-14);
        CHECK(image.flipped != panel.flipped);
    }
}

TEST_CASE("the second side of a seam is turned around where its ends lie nearer then") {
    Pattern pattern = parse_pattern_toml(skirt_text, "t");
    for (PatternSeam seam : pattern.seams) {
        const std::array<Vec3, 2> first = side_ends(pattern, seam.sides[0]), second = side_ends(pattern, seam.sides[1]);
        CHECK((first[0] - second[0]).norm() < (first[0] - second[1]).norm());
        const bool reversed = seam.sides[1][0].reversed;
        reverse_side(seam.sides[1]);
        CHECK(seam.sides[1][0].reversed != reversed);
        match_ends(pattern, seam);
        CHECK(seam.sides[1][0].reversed == reversed);
    }
}

TEST_CASE("panels move apart along their normals, to the outside whichever way they face") {
    for (const bool turned_over : {false, true}) {
        Pattern pattern;
        for (const double z : {0.1, -0.1}) {
            Panel& panel = pattern.panels.emplace_back();
            panel.corners = {{0, 0}, {1, 0}, {0, 1}};
            panel.pose.translation = Vec3(0, 0, z);
            if ((z < 0.0) == turned_over) panel.pose.rotation = turned({0, 180, 0});
        }
        move_apart(pattern, 0.05);
        CHECK((pattern.panels[0].pose.translation - Vec3(0, 0, 0.15)).norm() < 1e-15);
        CHECK((pattern.panels[1].pose.translation - Vec3(0, 0, -0.15)).norm() < 1e-15);
    }
}

TEST_CASE("panels in one plane move apart to the side that they face, a wrapped one around its axis") {
    Pattern pattern;
    for (const double x : {0.0, 1.0, 2.5}) {
        Panel& panel = pattern.panels.emplace_back();
        panel.corners = {{x, 0}, {x + 1, 0.3}, {x, 1}};
        panel.pose = {.translation = Vec3(0.1, 0.2, 0.3), .rotation = turned({17, 31, 5})};
    }
    const Vec3 normal = transform({.rotation = turned({17, 31, 5})}, Vec3(Vec3::UnitZ()));
    move_apart(pattern, 0.05);
    for (const Panel& panel : pattern.panels)
        CHECK((panel.pose.translation - Vec3(0.1, 0.2, 0.3) - 0.05 * normal).norm() < 1e-15);

    Pattern tube;
    Panel& panel = tube.panels.emplace_back();
    panel.corners = {{-0.3, 0}, {0.3, 0}, {0.3, 1}, {-0.3, 1}};
    panel.wrap = 0.1;
    const Vec3 axis(0.0, 0.5, -0.1);
    move_apart(tube, 0.02);
    for (const double x : {-0.3, -0.1, 0.2}) CHECK((placed_point(tube.panels[0], {x, 0.5}) - axis).norm() == Approx(0.12));
}

}  // namespace percale::scenes::test::pattern_parts_test

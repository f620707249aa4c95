#include "scenes/pattern/panel_curve.h"

#include "tests/scenes/pattern/garments.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::panel_curve_test {
namespace {

Panel one_edge(EdgeCurve curve, std::vector<Point2> control) {
    Panel panel;
    panel.corners = {{0, 0}, {2, 0}};
    panel.edges = {{.from = 0, .to = 1, .curve = curve, .control = std::move(control), .label = {}}};
    return panel;
}

/// Sum over many short chords.
double chord_length(const Panel& panel) {
    double sum = 0.0;
    constexpr int count = 20000;
    for (int k = 0; k < count; ++k) {
        sum += (point_on(panel, panel.edges[0], (k + 1.0) / count) - point_on(panel, panel.edges[0], 1.0 * k / count)).norm();
    }
    return sum;
}

}  // namespace

TEST_CASE("arcs go through their middle, on either side, and are as long as circles are") {
    for (const double side : {1.0, -1.0}) {
        const Panel half = one_edge(EdgeCurve::arc, {{1, side}});
        CHECK(edge_length(half, half.edges[0]) == Approx(std::numbers::pi).epsilon(1e-14));
        CHECK((point_on(half, half.edges[0], 0.5) - Point2(1, side)).norm() < 1e-14);
        CHECK((point_on(half, half.edges[0], 1.0) - Point2(2, 0)).norm() < 1e-14);
        // Three quarters of a circle: more than half of one.
        const Panel large = one_edge(EdgeCurve::arc, {{1, side * (1.0 + std::numbers::sqrt2)}});
        CHECK(edge_length(large, large.edges[0]) == Approx(1.5 * std::numbers::pi * std::numbers::sqrt2).epsilon(1e-12));
    }
    const Panel straight = one_edge(EdgeCurve::arc, {{1, 0}});
    CHECK(edge_length(straight, straight.edges[0]) == 2.0);
}

TEST_CASE("Bezier curves are their polynomials and as long as their chords") {
    const Panel quadratic = one_edge(EdgeCurve::quadratic, {{0.5, 1.5}});
    const Panel cubic = one_edge(EdgeCurve::cubic, {{0.0, 1.0}, {2.5, -1.0}});
    for (const double t : {0.0, 0.2, 0.7, 1.0}) {
        const double s = 1.0 - t;
        const Point2 two = 2.0 * s * t * Point2(0.5, 1.5) + t * t * Point2(2, 0);
        const Point2 three = 3.0 * s * s * t * Point2(0.0, 1.0) + 3.0 * s * t * t * Point2(2.5, -1.0) + t * t * t * Point2(2, 0);
        CHECK((point_on(quadratic, quadratic.edges[0], t) - two).norm() < 1e-15);
        CHECK((point_on(cubic, cubic.edges[0], t) - three).norm() < 1e-15);
    }
    for (const Panel& panel : {quadratic, cubic}) {
        CHECK(edge_length(panel, panel.edges[0]) == Approx(chord_length(panel)).epsilon(1e-7));
    }
}

TEST_CASE("points at equal fractions are equally far apart along the curve, and the ends are the corners") {
    for (const Panel& panel :
         {one_edge(EdgeCurve::line, {}), one_edge(EdgeCurve::arc, {{1, 0.7}}), one_edge(EdgeCurve::quadratic, {{0.1, 1.5}}),
          one_edge(EdgeCurve::cubic, {{0.0, 1.0}, {2.5, -1.0}})}) {
        std::vector<double> shares;
        for (int k = 0; k <= 400; ++k) shares.push_back(k / 400.0);
        const std::vector<Point2> points = points_at(panel, panel.edges[0], shares);
        const double step = edge_length(panel, panel.edges[0]) / 400.0;
        CHECK(points.front() == panel.corners[0]);
        CHECK(points.back() == panel.corners[1]);
        for (std::size_t k = 0; k + 1 < points.size(); ++k)
            CHECK((points[k + 1] - points[k]).norm() == Approx(step).epsilon(2e-3));
    }
}

}  // namespace percale::scenes::test::panel_curve_test

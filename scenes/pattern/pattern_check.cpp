#include "pattern/pattern_check.h"

#include <algorithm>
#include <cmath>

#include "common/scene_file_error.h"
#include "common/text.h"
#include "pattern/delaunay.h"
#include "pattern/panel_curve.h"
#include "pattern/pattern_parts.h"

namespace percale::scenes {
namespace {

constexpr double largest_panel = 5.0, smallest_panel = 0.01;  // m
/// Maximum excess of one side of a seam over the shorter one, relative to that.
constexpr double max_ease = 0.25;
/// m. Corners of two panels that lie nearer are in one place.
constexpr double same_place = 1e-3;
/// Pieces of each edge, as which outlines are tested for crossings.
constexpr int tested_pieces = 24;

std::string panel_name(const Panel& panel) { return "panel '" + panel.name + "'"; }

void check_closed(const Panel& panel) {
    const std::size_t count = panel.edges.size();
    if (count < 2 || (count == 2 && panel.edges[0].curve == EdgeCurve::line && panel.edges[1].curve == EdgeCurve::line)) {
        fail_at(panel.place,
                panel_name(panel) + " has " + counted(static_cast<long>(count), "edge") + "; an outline has three or more");
    }
    for (std::size_t k = 0; k < count; ++k) {
        const PanelEdge &edge = panel.edges[k], &next = panel.edges[(k + 1) % count];
        if (edge.to == next.from) continue;
        fail_at(panel.place, panel_name(panel) + " is open: edge " + std::to_string(k) + " ends at corner " +
                                 std::to_string(edge.to) + ", edge " + std::to_string((k + 1) % count) + " begins at corner " +
                                 std::to_string(next.from));
    }
}

/// The outline in short pieces, and of which edge each is.
struct TestedOutline {
    std::vector<Point2> points;
    std::vector<std::size_t> edge;
};

TestedOutline tested_outline(const Panel& panel) {
    TestedOutline outline;
    for (std::size_t e = 0; e < panel.edges.size(); ++e) {
        const int pieces = panel.edges[e].curve == EdgeCurve::line ? 1 : tested_pieces;
        for (int k = 0; k < pieces; ++k) {
            outline.points.push_back(point_on(panel, panel.edges[e], 1.0 * k / pieces));
            outline.edge.push_back(e);
        }
    }
    return outline;
}

bool on_both_sides(const Point2& a, const Point2& b, const Point2& c, const Point2& d) {
    return (turn_left(a, b, c) > 0.0) != (turn_left(a, b, d) > 0.0);
}

void check_crossings(const Panel& panel) {
    const auto [points, edge] = tested_outline(panel);
    const std::size_t count = points.size();
    for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t j = i + 2; j < count; ++j) {
            if (i == 0 && j + 1 == count) continue;
            const Point2 &a = points[i], &b = points[i + 1], &c = points[j], &d = points[(j + 1) % count];
            if (!on_both_sides(a, b, c, d) || !on_both_sides(c, d, a, b)) continue;
            fail_at(panel.place, panel_name(panel) + ": its outline crosses itself, edge " + std::to_string(edge[i]) +
                                     " and edge " + std::to_string(edge[j]));
        }
    }
}

void check_size(const Panel& panel) {
    const std::vector<Point2> points = tested_outline(panel).points;
    Point2 lowest = points[0], highest = points[0];
    double twice_area = 0.0;
    for (std::size_t k = 0; k < points.size(); ++k) {
        lowest = lowest.cwiseMin(points[k]);
        highest = highest.cwiseMax(points[k]);
        twice_area += turn_left(points[0], points[k], points[(k + 1) % points.size()]);
    }
    const double size = (highest - lowest).maxCoeff();
    const std::string shown = panel_name(panel) + " is " + short_number(size) + " m long";
    if (!(size <= largest_panel)) fail_at(panel.place, shown + ", more than 5 m; is its unit right? (an inch is 2.54 cm)");
    if (!(size >= smallest_panel)) fail_at(panel.place, shown + ", less than 1 cm; is its unit right? (an inch is 2.54 cm)");
    if (std::abs(twice_area) <= 1e-6 * size * size) fail_at(panel.place, panel_name(panel) + " has no area");
}

/// Two panels whose corners all lie in the same places.
void check_places(const Pattern& pattern) {
    const auto one_place = [](const Panel& a, const Panel& b) {
        if (a.corners.size() != b.corners.size()) return false;
        return std::ranges::all_of(a.corners, [&](const Point2& corner) {
            const Vec3 x = placed_point(a, corner);
            return std::ranges::any_of(b.corners,
                                       [&](const Point2& other) { return (placed_point(b, other) - x).norm() < same_place; });
        });
    };
    for (std::size_t i = 0; i < pattern.panels.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            const Panel &first = pattern.panels[j], &second = pattern.panels[i];
            if (one_place(first, second))
                fail_at(second.place, panel_name(second) + " lies where " + panel_name(first) + " lies");
        }
    }
}

double side_length(const Pattern& pattern, const std::vector<EdgeUse>& side) {
    double length = 0.0;
    for (const EdgeUse& use : side) length += edge_length(pattern.panels[use.panel], pattern.panels[use.panel].edges[use.edge]);
    return length;
}

void check_seam(const Pattern& pattern, const PatternSeam& seam) {
    const double first = side_length(pattern, seam.sides[0]), second = side_length(pattern, seam.sides[1]);
    if (seam.gather || std::max(first, second) <= (1.0 + max_ease) * std::min(first, second)) return;
    fail_at(seam.place, "seam '" + seam.name + "': its sides are " + short_number(first) + " m and " + short_number(second) +
                            " m long, more than 25 % apart; gather = true sews them all the same");
}

}  // namespace

void check_pattern(const Pattern& pattern) {
    if (pattern.panels.empty()) throw SceneError(pattern.file, "no panels");
    for (const Panel& panel : pattern.panels) {
        check_closed(panel);
        check_size(panel);
        check_crossings(panel);
    }
    check_places(pattern);
    for (const PatternSeam& seam : pattern.seams) check_seam(pattern, seam);
}

}  // namespace percale::scenes

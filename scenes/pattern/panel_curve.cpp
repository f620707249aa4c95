#include "pattern/panel_curve.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace percale::scenes {
namespace {

/// Pieces of a Bezier curve whose lengths are added up, and the nodes of Gauss in each: exact to about 1e-12 for curves of a
/// garment.
constexpr int curve_pieces = 64;
constexpr std::array<double, 3> gauss_node = {-0.7745966692414834, 0.0, 0.7745966692414834};
constexpr std::array<double, 3> gauss_weight = {5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};

/// An arc through three points as centre, radius, first angle and angle run through, rad; a straight one has no radius.
struct ArcForm {
    Point2 centre = Point2::Zero();
    double radius = 0.0, start = 0.0, angle = 0.0;

    ArcForm(const Point2& a, const Point2& through, const Point2& b) {
        const Point2 u = through - a, v = b - a;
        const double twice = 2.0 * (u.x() * v.y() - u.y() * v.x());
        if (std::abs(twice) <= 1e-14 * v.squaredNorm()) return;
        const Point2 offset(v.y() * u.squaredNorm() - u.y() * v.squaredNorm(), u.x() * v.squaredNorm() - v.x() * u.squaredNorm());
        centre = a + offset / twice;
        radius = (offset / twice).norm();
        const auto angle_of = [&](const Point2& x) { return std::atan2(x.y() - centre.y(), x.x() - centre.x()); };
        const auto turned = [](double by) { return by < 0.0 ? by + 2.0 * std::numbers::pi : by; };
        start = angle_of(a);
        const double to_end = turned(angle_of(b) - start), to_middle = turned(angle_of(through) - start);
        angle = to_middle < to_end ? to_end : to_end - 2.0 * std::numbers::pi;
    }
};

Point2 bezier(std::span<const Point2> points, double t) {
    std::array<Point2, 4> level;
    std::copy(points.begin(), points.end(), level.begin());
    for (std::size_t count = points.size(); count > 1; --count) {
        for (std::size_t k = 0; k + 1 < count; ++k) level[k] = (1.0 - t) * level[k] + t * level[k + 1];
    }
    return level[0];
}

std::vector<Point2> bezier_points(const Panel& panel, const PanelEdge& edge) {
    std::vector<Point2> points = {panel.corners[edge.from]};
    points.insert(points.end(), edge.control.begin(), edge.control.end());
    points.push_back(panel.corners[edge.to]);
    return points;
}

/// |dx/dt|
double speed(std::span<const Point2> points, double t) {
    std::vector<Point2> differences;
    for (std::size_t k = 0; k + 1 < points.size(); ++k) differences.push_back(points[k + 1] - points[k]);
    return static_cast<double>(differences.size()) * bezier(differences, t).norm();
}

/// Length of the curve from t = from to t = to.
double length_between(std::span<const Point2> points, double from, double to) {
    double sum = 0.0;
    for (int g = 0; g < 3; ++g) {
        sum += gauss_weight[g] * speed(points, 0.5 * (from + to) + 0.5 * (to - from) * gauss_node[g]);
    }
    return sum * (to - from);
}

/// Arc length up to the end of each piece.
std::vector<double> lengths_along(std::span<const Point2> points) {
    std::vector<double> length = {0.0};
    for (int k = 0; k < curve_pieces; ++k) {
        length.push_back(length.back() + length_between(points, 1.0 * k / curve_pieces, (k + 1.0) / curve_pieces));
    }
    return length;
}

/// The parameter at which the curve has run through this length, by Newton inside its piece.
double parameter_at(std::span<const Point2> points, const std::vector<double>& lengths, double wanted) {
    const auto next = std::upper_bound(lengths.begin() + 1, lengths.end() - 1, wanted);
    const double start = static_cast<double>(next - lengths.begin() - 1) / curve_pieces;
    const double end = start + 1.0 / curve_pieces, before = *(next - 1);
    double t = std::lerp(start, end, (wanted - before) / (*next - before));
    for (int round = 0; round < 20; ++round) {
        const double change = (wanted - before - length_between(points, start, t)) / speed(points, t);
        t = std::clamp(t + change, start, end);
        if (std::abs(change) < 1e-14) break;
    }
    return t;
}

bool is_bezier(const PanelEdge& edge) { return edge.curve == EdgeCurve::quadratic || edge.curve == EdgeCurve::cubic; }

}  // namespace

Point2 point_on(const Panel& panel, const PanelEdge& edge, double t) {
    const Point2 &a = panel.corners[edge.from], &b = panel.corners[edge.to];
    if (is_bezier(edge)) return bezier(bezier_points(panel, edge), t);
    if (edge.curve == EdgeCurve::arc) {
        const ArcForm arc(a, edge.control[0], b);
        const double angle = arc.start + t * arc.angle;
        if (arc.radius > 0.0) return arc.centre + arc.radius * Point2(std::cos(angle), std::sin(angle));
    }
    return (1.0 - t) * a + t * b;
}

double edge_length(const Panel& panel, const PanelEdge& edge) {
    const Point2 &a = panel.corners[edge.from], &b = panel.corners[edge.to];
    if (is_bezier(edge)) return lengths_along(bezier_points(panel, edge)).back();
    if (edge.curve == EdgeCurve::arc) {
        const ArcForm arc(a, edge.control[0], b);
        if (arc.radius > 0.0) return arc.radius * std::abs(arc.angle);
    }
    return (b - a).norm();
}

std::vector<Point2> points_at(const Panel& panel, const PanelEdge& edge, std::span<const double> shares) {
    const bool curved = is_bezier(edge);
    const std::vector<Point2> control = curved ? bezier_points(panel, edge) : std::vector<Point2>{};
    const std::vector<double> lengths = curved ? lengths_along(control) : std::vector<double>{};
    std::vector<Point2> points;
    for (const double share : shares) {
        if (share <= 0.0 || share >= 1.0) {
            points.push_back(panel.corners[share <= 0.0 ? edge.from : edge.to]);
        } else {
            points.push_back(point_on(panel, edge, curved ? parameter_at(control, lengths, share * lengths.back()) : share));
        }
    }
    return points;
}

}  // namespace percale::scenes

#include "pattern/pattern_parts.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace percale::scenes {
namespace {

/// m. Panels that lie nearer to one plane lie in it. 0: rounding decides to which side they move apart.
constexpr double same_plane = 1e-6;

Point2 mirror_point(const Point2& point) { return {-point.x(), point.y()}; }

}  // namespace

Rotation turned(const std::array<double, 3>& degrees) {
    Rotation rotation{1.0, 0.0, 0.0, 0.0};
    for (int axis = 0; axis < 3; ++axis) {
        const double half = 0.5 * degrees[axis] * std::numbers::pi / 180.0, s = std::sin(half);
        rotation = product({std::cos(half), axis == 0 ? s : 0.0, axis == 1 ? s : 0.0, axis == 2 ? s : 0.0}, rotation);
    }
    return rotation;
}

Point2 arc_middle(const Point2& a, const Point2& b, double bulge) {
    const Point2 along = b - a;
    return 0.5 * (a + b) + bulge / along.norm() * Point2(along.y(), -along.x());
}

Vec3 placed_point(const Panel& panel, const Point2& point) {
    Vec3 x(point.x(), point.y(), 0.0);
    if (panel.wrap > 0.0) {
        const double angle = point.x() / panel.wrap;
        x = {panel.wrap * std::sin(angle), point.y(), panel.wrap * (std::cos(angle) - 1.0)};
    }
    return transform(panel.pose, x);
}

void move_apart(Pattern& pattern, double distance) {
    std::vector<Vec3> middles;
    Vec3 middle = Vec3::Zero();
    for (const Panel& panel : pattern.panels) {
        Vec3& own = middles.emplace_back(Vec3::Zero());
        for (const Point2& corner : panel.corners) own += placed_point(panel, corner) / static_cast<double>(panel.corners.size());
        middle += own / static_cast<double>(pattern.panels.size());
    }
    for (std::size_t k = 0; k < middles.size(); ++k) {
        Panel& panel = pattern.panels[k];
        Pose& pose = panel.pose;
        const Vec3 normal = transform({.rotation = pose.rotation}, Vec3(Vec3::UnitZ()));
        // Panels in one plane keep to the side that they face; a wrapped one keeps its axis.
        const bool inward = panel.wrap == 0.0 && normal.dot(middles[k] - middle) < -same_plane;
        pose.translation += (inward ? -distance : distance) * normal;
        if (panel.wrap > 0.0) panel.wrap += distance;
    }
}

Panel mirrored(const Panel& panel, const std::string& name) {
    Panel image = panel;
    image.name = name;
    image.flipped = !panel.flipped;
    std::ranges::transform(panel.corners, image.corners.begin(), mirror_point);
    for (PanelEdge& edge : image.edges) {
        std::ranges::transform(edge.control, edge.control.begin(), mirror_point);
    }
    // In the mirror turns about x stay, those about y and z change their sense.
    image.pose.translation.x() *= -1.0;
    image.pose.rotation.y *= -1.0;
    image.pose.rotation.z *= -1.0;
    return image;
}

std::array<Vec3, 2> side_ends(const Pattern& pattern, const std::vector<EdgeUse>& side) {
    const auto end = [&](const EdgeUse& use, bool last) {
        const Panel& panel = pattern.panels[use.panel];
        const PanelEdge& edge = panel.edges[use.edge];
        return placed_point(panel, panel.corners[use.reversed == last ? edge.from : edge.to]);
    };
    return {end(side.front(), false), end(side.back(), true)};
}

void reverse_side(std::vector<EdgeUse>& side) {
    std::reverse(side.begin(), side.end());
    for (EdgeUse& use : side) use.reversed = !use.reversed;
}

void match_ends(const Pattern& pattern, PatternSeam& seam) {
    const auto [a, b] = side_ends(pattern, seam.sides[0]);
    const auto [c, d] = side_ends(pattern, seam.sides[1]);
    if ((a - d).norm() + (b - c).norm() < (a - c).norm() + (b - d).norm()) reverse_side(seam.sides[1]);
}

}  // namespace percale::scenes
